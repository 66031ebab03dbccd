# SPDX-License-Identifier: GPL-3.0-or-later
"""The spacing for a camera: a surfel covers the given number of pixels where the surface is closest."""

import numpy as np
import pytest

from splat_addon.rendering import Camera, look_at
from splat_addon.sampling import NotSeenError, TriangleMesh, camera_spacing, least_camera_spacings, outline

#: The outline is within 1.5 / 96 of the box's longest edge from the surface.
REACH = 1.5 / 96


def spacing(mesh, camera, pixels=1.0, scale=(1, 1, 1)):
    return camera_spacing(
        outline(mesh),
        pixels,
        object_to_view=camera.world_to_view() @ np.diag([*scale, 1.0]),
        window=camera.window,
        size=camera.size,
        near=camera.near,
        is_orthographic=camera.is_orthographic,
    )


def pinhole(eye, target=(0, 0, 0), size=(200, 100)):
    """A camera with a field of view of 90 degrees whose pixels are 0.01 wide at distance 1."""
    return Camera.perspective(look_at(eye, target), 2 * np.arctan(0.5), size)


@pytest.fixture
def ball(cube):
    """A cube of edge 1 around the origin."""
    return TriangleMesh(cube().positions - 0.5, cube().triangles)


def test_a_surfel_covers_the_pixels_at_the_nearest_point(ball):
    """The nearest face is at distance 3.5."""
    for pixels in (1.0, 2.5):
        near, far = (0.01 * pixels * d for d in (3.5 - 2 * REACH, 3.5))
        assert near <= spacing(ball, pinhole((4, 0, 0)), pixels) <= far


def test_a_parallel_camera_sees_the_same_at_any_distance(ball):
    for distance in (2.0, 50.0):
        camera = Camera.orthographic(look_at((distance, 0, 0), (0, 0, 0)), 4.0, (200, 100))
        assert spacing(ball, camera) == pytest.approx(4.0 / 100)


def test_only_the_part_in_view_counts(cube):
    """The camera is above a long floor; the visible part begins where the picture's lower edge meets it."""
    floor = TriangleMesh(cube().positions * (40, 40, 0.001) - (20, 20, 0), cube().triangles)
    camera = pinhole((0, 0, 10), target=(10, 0, 10))
    assert spacing(floor, camera) == pytest.approx(0.01 * 20, rel=0.1)


@pytest.mark.parametrize("is_orthographic", [False, True])
@pytest.mark.parametrize("target", [(9, 0, 0), (4, 4, 0), (4, 0, 9)])
def test_a_surface_behind_or_beside_the_camera_is_refused_in_a_sentence(ball, target, is_orthographic):
    camera = pinhole((4, 0, 0), target)
    if is_orthographic:
        camera = Camera.orthographic(camera.matrix_world, 2.0, (200, 100))
    with pytest.raises(ValueError, match="does not see the object"):
        spacing(ball, camera)


def test_a_camera_inside_sees_the_wall_before_it_and_not_the_one_behind(ball):
    room = TriangleMesh(ball.positions * 10, ball.triangles)
    assert spacing(room, pinhole((-4.5, 0, 0))) == pytest.approx(0.01 * 5, rel=0.2)


def test_a_surface_through_the_camera_counts_from_the_near_clip_distance(ball):
    camera = pinhole((0, 0, 0.5), target=(1, 0, 0.5))
    assert spacing(ball, camera) == pytest.approx(0.01 * camera.near)


def test_the_longest_stretch_of_the_object_decides(ball):
    plain, stretched = (spacing(ball, pinhole((9, 0, 0)), scale=s) for s in ((1, 1, 1), (1, 2, 0.5)))
    assert stretched == pytest.approx(plain / 2, rel=0.01)


def test_an_oblong_pixel_counts_with_its_shorter_side(ball):
    square, oblong = (spacing(ball, pinhole((4, 0, 0), size=s)) for s in ((200, 100), (200, 400)))
    assert oblong == pytest.approx(square / 4)


@pytest.mark.parametrize("pixels", [0, -1, float("nan"), float("inf")])
def test_pixels_that_make_no_sense_are_refused_in_a_sentence(ball, pixels):
    with pytest.raises(ValueError, match="must be a finite number above 0"):
        spacing(ball, pinhole((4, 0, 0)), pixels)


def test_a_mesh_without_a_usable_triangle_has_an_empty_outline(triangle):
    assert len(outline(triangle((0, 0, 0), (1, 1, 1), (2, 2, 2))).points) == 0


def test_the_whole_surface_is_within_reach_of_its_outline(armadillo):
    from scipy.spatial import cKDTree

    surface = outline(armadillo)
    assert cKDTree(surface.points).query(armadillo.positions)[0].max() <= surface.reach


@pytest.mark.parametrize("is_orthographic", [False, True])
def test_the_least_spacings_of_many_places_are_never_above_what_is_found_of_each(ball, is_orthographic):
    """And what is certainly not seen is not seen."""
    camera = pinhole((4, 0, 0))
    if is_orthographic:
        camera = Camera.orthographic(camera.matrix_world, 4.0, (200, 100))
    random, shape = np.random.default_rng(3), outline(ball)
    places = np.tile(np.eye(4), (200, 1, 1))
    places[:, :3, :3] = random.normal(size=(200, 3, 3)) * 0.3
    places[:, :3, 3] = random.uniform(-8, 8, (200, 3))
    picture = {name: getattr(camera, name) for name in ("window", "size", "near", "is_orthographic")}
    to_view = camera.world_to_view() @ places
    least, unseen = least_camera_spacings(shape, 2.0, objects_to_view=to_view, **picture), 0
    for bound, matrix in zip(least, to_view, strict=True):
        try:
            assert bound <= camera_spacing(shape, 2.0, object_to_view=matrix, **picture)
        except NotSeenError:
            unseen += 1
        else:
            assert np.isfinite(bound)
    assert 0 < np.isinf(least).sum() <= unseen < 200
