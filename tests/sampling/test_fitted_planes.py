# SPDX-License-Identifier: GPL-3.0-or-later
"""Splats of curved and rough surfaces fit the samples around them, and those of flat ones stay as they are."""

import numpy as np
import pytest

from splat_addon.clip_lines import CLIP_FIELDS
from splat_addon.reference.bare import uncovered_points
from splat_addon.sampling import Tolerance, TriangleMesh
from tests.plain import deforming_surfels, sample_mesh, sample_surface

EDGES = {"crease_angle": np.radians(20), "fits_blending": True}
FITTED = EDGES | {"fits_planes": True}


def rims(surfels):
    """(N, 16, 3) points on the rims of splats, object units."""
    angles = np.arange(16) * np.pi / 8
    x, y = surfels.half_axes()
    around = np.cos(angles)[:, None] * x[:, None] + np.sin(angles)[:, None] * y[:, None]
    return surfels.origin + surfels.positions[:, None] + around.astype(np.float64)


@pytest.mark.parametrize("resolution", [12, 40, 160])
def test_splats_of_a_ball_stick_out_less(sphere, resolution):
    """The rim of a disc of radius r that touches the ball is sqrt(1 + r^2) - 1 outside of it."""
    touching, fitted = (
        np.linalg.norm(rims(sample_mesh(sphere, resolution=resolution, **options)), axis=2).mean() - 1
        for options in (EDGES, FITTED)
    )
    assert touching > 0
    assert fitted < 0.75 * touching


def test_neighbours_in_another_image_count_too(sphere):
    """Where the ball turns from one image into another, splats are moved inwards as far as elsewhere."""
    surfels = sample_mesh(sphere, resolution=40, **FITTED)
    places = surfels.positions + surfels.origin
    inside = 1 - np.linalg.norm(places, axis=1)
    least, most = np.sort(np.abs(places), axis=1)[:, 1:].T
    # Within a column of the border, and where the third image is far.
    beside = (most - least < 0.03) & (np.abs(places).min(axis=1) < 0.3)
    assert beside.sum() > 60
    assert inside[beside].mean() > 0.85 * inside[most > 0.9].mean()


def test_rough_surfaces_stick_out_less_and_stay_covered(armadillo):
    """Half of what splats stick out of the hull of a scan, whose triangles are smaller than they are, is gone."""
    from scipy.spatial import cKDTree

    fine = sample_mesh(armadillo, resolution=256)
    tree, normals = cKDTree(fine.positions + fine.origin), fine.geometric_normals()
    outside = []
    for options in (EDGES, FITTED):
        surfels = sample_mesh(armadillo, resolution=96, **options)
        shown = rims(surfels)[(surfels.clip_line[:, 1] == 0) & (surfels.clip_line_2[:, 1] == 0)].reshape(-1, 3)
        near = tree.query(shown)[1]
        height = ((shown - fine.positions[near] - fine.origin) * normals[near]).sum(axis=1)
        outside.append(np.maximum(height, 0).mean())
        spacing = float(np.ptp(armadillo.positions, axis=0).max()) / 96
        assert len(uncovered_points(armadillo, surfels, spacing)) < 0.001 * 40_000
    assert outside[1] < 0.75 * outside[0]


def test_flat_surfaces_stay_as_they_are(cube):
    plain, fitted = (sample_mesh(cube(), resolution=20, **options).arrays() for options in (EDGES, FITTED))
    for name, values in plain.items():
        assert fitted[name].tobytes() == values.tobytes(), name


def test_samples_with_all_neighbours_in_their_triangle_keep_its_plane_exactly():
    """The faces of a coarse ball are far larger than splats, so only those near edges move."""
    import trimesh

    ball = trimesh.creation.icosphere(subdivisions=1)
    mesh = TriangleMesh(ball.vertices, ball.faces)
    options = {"spacing": 0.02, "crease_angle": np.pi, "fits_blending": True}
    plain, fitted = (sample_mesh(mesh, **options, fits_planes=fits) for fits in (False, True))
    assert (plain.blend_depth > 0.02).all()
    heights = (plain.positions + plain.origin) @ ball.face_normals.T - (ball.triangles[:, 0] * ball.face_normals).sum(1)
    # How far below the plane of another face: three spacings from the edge or farther.
    is_inside = np.sort(heights, axis=1)[:, -2] < -0.02
    assert 0.2 < is_inside.mean() < 0.8
    for one, other in ((plain.positions, fitted.positions), (plain.rotations, fitted.rotations)):
        assert one[is_inside].tobytes() == other[is_inside].tobytes()
        assert one[~is_inside].tobytes() != other[~is_inside].tobytes()


def folded(angle: float) -> TriangleMesh:
    """Two rectangles of 2 x 1 that meet along the y axis and turn by an angle, in radians."""
    half = angle / 2
    across, down = np.cos(half), -np.sin(half)
    positions = np.array(
        [(-across, -1, down), (0, -1, 0), (across, -1, down), (-across, 1, down), (0, 1, 0), (across, 1, down)]
    )
    return TriangleMesh(positions, np.array([(0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4)]))


def ridge(steep=0.35, bent=0.5, strips=40) -> TriangleMesh:
    """Two curved faces z = -steep |x| - bent x^2 over -1 to 1, which meet in a crease along the y axis."""
    x = np.linspace(-1, 1, 2 * strips + 1)
    z = -steep * np.abs(x) - bent * x * x
    positions = np.concatenate([np.stack([x, np.full_like(x, y), z], axis=1) for y in (-1, 1)])
    first, above = np.arange(2 * strips), np.arange(2 * strips) + len(x)
    quads = np.stack([first, first + 1, above + 1, above], axis=1)
    return TriangleMesh(positions, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]))


def test_what_lies_beyond_a_clip_line_does_not_count():
    """Splats along a crease of 39 degrees keep the slope of their own face, though both faces are curved."""
    surfels = sample_mesh(ridge(), resolution=48, **FITTED)
    x, y, _ = (surfels.positions + surfels.origin).T
    slope = 0.35 + 2 * 0.5 * np.abs(x)
    beside = (np.abs(x) < 1.5 / 24) & (np.abs(y) < 0.9)
    assert (surfels.clip_line[beside, 1] > 0).sum() > 50
    normals = surfels.geometric_normals()[beside]
    found = np.sign(x[beside]) * normals[:, 0] / normals[:, 2]
    assert np.abs(found - slope[beside]).max() < 0.05


def test_splats_over_a_shallow_fold_turn_towards_it_and_others_stay():
    angle = np.radians(2)
    surfels = sample_mesh(folded(angle), resolution=32, **FITTED)
    tilt, away = np.abs(surfels.geometric_normals()[:, 0]), np.abs(surfels.positions[:, 0] + surfels.origin[0]) * 16
    assert np.allclose(tilt[away > 1.5], np.sin(angle / 2), atol=1e-5)
    # At the ends of the fold are samples of triangles without an edge there.
    is_over = (away < 0.6) & (np.abs(surfels.positions[:, 1] + surfels.origin[1]) < 0.9)
    assert is_over.sum() > 50 and tilt[is_over].max() < 0.9 * np.sin(angle / 2)


def test_lines_of_splats_that_moved_keep_more_of_them_and_none_goes(armadillo):
    plain, fitted = (sample_mesh(armadillo, resolution=64, **options) for options in (EDGES, FITTED))
    for name in CLIP_FIELDS:
        before, after = getattr(plain, name), getattr(fitted, name)
        assert np.array_equal(before[:, 0], after[:, 0])
        assert np.array_equal(before[:, 1] > 0, after[:, 1] > 0)
        assert np.all(after[:, 1] <= before[:, 1])
        assert (after[:, 1] < before[:, 1]).sum() > 500


@pytest.mark.parametrize("reduction", ["none", "grazing", "surfel_normal", "three_to_one"])
def test_every_reduction_stays_valid(sphere, reduction):
    spacing = 2 / 12
    surfels = sample_mesh(sphere, spacing=spacing, reduction=reduction, **FITTED)
    assert np.allclose(np.linalg.norm(surfels.rotations, axis=1), 1, atol=1e-5)
    assert np.abs(np.linalg.norm(surfels.positions + surfels.origin, axis=1) - 1).max() < spacing / 2


def test_merged_samples_were_fitted_before(sphere):
    sampling = sample_surface(sphere, resolution=96, tolerance=Tolerance(2e-3), **FITTED)
    assert sampling.saved > 0 and sampling.error <= 2e-3


def test_fitted_splats_follow_a_mesh_that_deforms(sphere):
    deforming = deforming_surfels(sphere, resolution=12, **FITTED)
    rest, moved = sample_mesh(sphere, resolution=12, **FITTED), np.array((5.0, 0, 0))
    surfels, _ = deforming.at(TriangleMesh(sphere.positions + moved, sphere.triangles, sphere.corner_normals))
    assert np.allclose(surfels.positions + surfels.origin - moved, rest.positions + rest.origin, atol=1e-5)
    assert np.abs((surfels.geometric_normals() * rest.geometric_normals()).sum(axis=1) - 1).max() < 1e-5


def test_planes_cannot_be_fitted_without_blend_depths(cube):
    with pytest.raises(ValueError, match="fit blending too"):
        sample_mesh(cube(), resolution=4, fits_planes=True)
