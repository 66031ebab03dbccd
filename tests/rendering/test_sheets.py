# SPDX-License-Identifier: GPL-3.0-or-later
"""Where thin sheets end in front of others, with one sample per pixel, the picture is that of the mesh's triangles."""

import numpy as np
import pytest

from splat_addon.reference.triangles import render_triangles
from splat_addon.rendering import Camera, Scene, Settings, look_at
from splat_addon.sampling import DEFAULT_CREASE_ANGLE, Channel, Surface, TriangleMesh, VertexColors
from tests.plain import sample_mesh

ONE_SAMPLE = Settings(method="mip", shading="flat", transparent_film=True, supersampling=1, detail_tolerance=0)


def sheets(*quads):
    """A mesh of separate quads. quads: (colour, its 4 corners)."""
    corners = np.concatenate([places for _, places in quads]).astype(float)
    triangles = np.concatenate(
        [[(4 * k, 4 * k + 1, 4 * k + 2), (4 * k, 4 * k + 2, 4 * k + 3)] for k in range(len(quads))]
    )
    colors = np.repeat([(*color, 1.0) for color, _ in quads], 2, axis=0)[:, None].repeat(3, axis=1)
    surface = Surface(Channel((1, 1, 1, 1), VertexColors()))
    return TriangleMesh(corners, triangles, corner_colors=colors.astype(np.float32), surfaces=(surface,))


def apart(mesh, camera, spacing, render):
    """(h, w) largest difference of a colour over grey from that of the triangles."""
    surfels = sample_mesh(mesh, spacing=spacing, crease_angle=DEFAULT_CREASE_ANGLE, fits_blending=True)
    frame = render(Scene((surfels,)), camera, ONE_SAMPLE)
    truth = render_triangles(mesh.positions[mesh.triangles], mesh.corner_colors[..., :3], camera)
    shown, true = (
        color[..., :3] + 0.2 * (1 - alpha[..., None])
        for color, alpha in ((frame.color, frame.color[..., 3]), (truth.color, truth.coverage))
    )
    return np.abs(shown - true).max(axis=2)


@pytest.mark.parametrize("is_parallel", [False, True])
def test_a_step_of_a_few_radii_is_filtered_on_slanting_sheets(is_parallel, render):
    """A door ends over a sill, and both slant away, so that depth changes more from pixel to pixel than at the step.

    Measured: an error of 0.07; it was 0.31 when the slope was a tolerance in every direction.
    """
    door = [(-2, -2, 0), (2, -2, 0), (2, 0, 0), (-2, 0.3, 0)]
    sill = [(-2, -1, -0.05), (2, -1, -0.05), (2, 2, -0.05), (-2, 2, -0.05)]
    mesh = sheets(((1, 0.2, 0.2), door), ((0.1, 0.2, 1), sill))
    pose, size = look_at((1.5, -5, 2.6), (0, 0, 0)), (64, 64)
    cameras = Camera.perspective(pose, 0.4, size, 0.1, 100), Camera.orthographic(pose, 2.4, size, 0.1, 100)
    assert apart(mesh, cameras[is_parallel], 0.025, render).max() < 0.12


def test_past_a_silhouette_a_lining_does_not_show(render):
    """A green lining meets the red sheet before it at their silhouette, and is hidden by it.

    Measured: 3 pixels are wrong; it was 24 when whole splats of the lining reached over the silhouette.
    """
    sheet = [(-1, -1, 0), (1, -1, 0), (1, 0.9, 0), (-1, 1.1, 0)]
    lining = [(-1, 1.1, 0), (1, 0.9, 0), (1, -1, -0.6), (-1, -1, -0.6)]
    mesh = sheets(((1, 0.1, 0.1), sheet), ((0.1, 1, 0.1), lining))
    camera = Camera.perspective(look_at((0.3, 1.5, 6), (0, 0, 0)), 0.5, (64, 64), 0.1, 100)
    assert np.count_nonzero(apart(mesh, camera, 0.02, render) > 0.1) <= 6


def test_a_steep_face_is_filtered_over_its_crease(render):
    """Measured: 3 pixels are wrong; it was 10 when splats ended where the plane of the other face was far off."""
    face = [(-1, -1, 0), (0, -1, 0), (0.1, 1, 0), (-1, 1, 0)]
    steep = [(0, -1, 0), (0.6, -1, -3.2), (0.7, 1, -3.2), (0.1, 1, 0)]
    mesh = sheets(((1, 0.2, 0.2), face), ((0.1, 0.2, 1), steep))
    camera = Camera.perspective(look_at((0.6, -0.3, 6), (0, 0, 0)), 0.5, (64, 64), 0.1, 100)
    assert np.count_nonzero(apart(mesh, camera, 0.02, render) > 0.1) <= 6


@pytest.mark.parametrize("spacing, measured, before", [(0.02, 24, 51), (0.01, 57, 75)])
def test_a_wall_is_filtered_over_the_steep_floor_before_it(spacing, measured, before, render):
    """Measured: pixels that are wrong. The floor's depth hid the filtered end of the wall: by the hardware's test where
    splats are as wide as pixels, and by that of the shader where the floor comes many of their radii nearer."""
    floor = [(-1, -1.2, 3.24), (1, -1.2, 3.24), (1, 0, 0), (-1, 0.1, 0)]
    wall = [(-1, 0.1, 0), (1, 0, 0), (1, 1, -0.1), (-1, 1, -0.1)]
    mesh = sheets(((1, 0.2, 0.2), floor), ((0.1, 0.2, 1), wall))
    camera = Camera.perspective(look_at((0.1, 0.2, 6), (0, 0, 0), (0, 1, 0)), 0.3, (64, 64), 0.1, 100)
    wrong = np.count_nonzero(apart(mesh, camera, spacing, render) > 0.1)
    assert wrong <= (measured + before) // 2, wrong


@pytest.mark.parametrize("slope", [0.2, 0.6, 2.0])
def test_past_the_edge_at_which_it_joins_a_sheet_a_lining_does_not_show(slope, render):
    """A red lining is hidden by the sheet that it is joined to in the middle, beyond which its plane would be nearer.

    Measured: at most 0.001 of its red; it was 0.05 to 0.13 when splats behind the first row reached past the edge.
    """
    halves = [[(x, 0, -1), (x + 1, 0, -1), (x + 1, 0, 1), (x, 0, 1)] for x in (-1, 0)]
    lining = [(0, 0, -1), (1, slope, -1), (1, slope, 1), (0, 0, 1)]
    mesh = sheets(((0, 0.8, 0), halves[0]), ((0, 0.8, 0), halves[1]), ((0.9, 0, 0), lining))
    for eye in ((-0.6, -3, 0.4), (0.3, -3, 0.4), (-2, -2.5, 0.3)):
        camera = Camera.perspective(look_at(eye, (0, 0, 0), (0, 0, 1)), 0.5, (96, 96), 0.1, 100)
        surfels = sample_mesh(mesh, spacing=0.0125, crease_angle=DEFAULT_CREASE_ANGLE, fits_blending=True)
        shown = render(Scene((surfels,)), camera, ONE_SAMPLE).color
        assert shown[..., 1].max() > 0.7 and shown[..., 0].max() < 0.02


@pytest.mark.parametrize("from_behind", [False, True])
def test_a_card_shows_the_side_that_faces_the_viewer(from_behind, render):
    """A red sheet and a green one in the same place face opposite ways.

    Measured: an error of 0.09, as of one sheet alone; it is 0.45 if their backs are drawn.
    """
    front = np.array([(-1, -0.7, 0), (1, -0.6, 0), (0.9, 0.8, 0), (-1, 0.9, 0)])
    mesh = sheets(((1, 0.1, 0.1), front), ((0.1, 1, 0.1), front[[1, 0, 3, 2]]))
    eye = np.array((0.6, 1.5, -6 if from_behind else 6))
    camera = Camera.perspective(look_at(eye, (0, 0, 0)), 0.5, (64, 64), 0.1, 100)
    assert apart(mesh, camera, 0.02, render).max() < 0.12


@pytest.mark.parametrize("turn", [0.0, 0.4, 2.0])
def test_of_a_ridge_lower_than_a_pixel_one_wall_shows(turn, render):
    """A ridge has a red wall and a green one. Of one, half a pixel is seen; the other one is hidden by the ridge.

    Measured: 0, 4 and 0 pixels are off by more than 0.05. They were 122, 78 and 17 when the hidden wall was taken to be
    visible, because no sample lies within it.
    """
    high, wide, long = 0.06, 0.12, 3
    grey, red, green = (0.5, 0.5, 0.0), (1.0, 0.5, 0.5), (0.0, 0.5, 0.5)

    def across(*points):
        (x, z), (u, v) = points
        return [(x, -long, z), (u, -long, v), (u, long, v), (x, long, z)]

    top, floors = across((-wide, high), (wide, high)), [across((s * long, 0), (s * wide, 0)) for s in (-1, 1)]
    left, right = (across((s * wide, 0), (s * wide, high)) for s in (-1, 1))
    mesh = sheets((grey, top), (red, left), (green, right), *((grey, floor) for floor in floors))
    camera = Camera.perspective(look_at((4 * np.cos(turn), 4 * np.sin(turn), 5), (0, 0, 0)), 0.9, (64, 64), 0.1, 100)
    assert np.count_nonzero(apart(mesh, camera, 0.1, render) > 0.05) <= 6


def light_of_a_face(floor, face, render, turn, tilt=0.0):
    """The light of a blue face between two halves of a yellow floor, over the same light of the triangles."""
    left, right = floor
    mesh = sheets(((0.5, 0.5, 0), left), ((0.5, 0.1, 0.6), face), ((0.5, 0.5, 0), right))
    eye = np.array((np.sin(tilt), 0, np.cos(tilt))) * 5
    up = np.cos(turn) * np.array((0, 1, 0)) + np.sin(turn) * np.cross((0, 1, 0), eye / 5)
    camera = Camera.orthographic(look_at(eye, (0, 0, 0), up), 1.92, (96, 96), 0.1, 20)
    surfels = sample_mesh(mesh, spacing=0.015, crease_angle=DEFAULT_CREASE_ANGLE, fits_blending=True, fits_planes=True)
    frame = render(Scene((surfels,)), camera, ONE_SAMPLE)
    truth = render_triangles(mesh.positions[mesh.triangles], mesh.corner_colors[..., :3], camera)
    return frame.color[10:-10, 10:-10, 2].sum() / truth.color[10:-10, 10:-10, 2].sum()


@pytest.mark.parametrize("turn", [0.1, 0.5, 1.1])
def test_a_steep_face_narrower_than_a_pixel_keeps_its_light(turn, render):
    """A step as high as the spacing of samples is seen 0.3 pixels wide.

    Measured: 0.93 to 0.98 of the light; it was 0.77 to 0.83 when the face before it hid it at its splats' centres, and
    0.6 when the rows of samples did not count either."""
    high = 0.015
    floor = (
        [(-2, -2, 0), (0, -2, 0), (0, 2, 0), (-2, 2, 0)],
        [(0, -2, -high), (2, -2, -high), (2, 2, -high), (0, 2, -high)],
    )
    face = [(0, -2, 0), (0, -2, -high), (0, 2, -high), (0, 2, 0)]
    assert 0.88 < light_of_a_face(floor, face, render, turn, np.arcsin(0.3 * 0.02 / high)) < 1.08


@pytest.mark.parametrize("widths", [1, 1.44, 2])
def test_a_strip_of_few_samples_has_the_light_of_its_area(widths, render):
    """Measured: 0.99, 1.13 and 0.99; it was 0.82, 1.20 and 0.98 when the strip's rows did not count."""
    wide = 0.015 * widths
    floor = [(-2, -2, 0), (0, -2, 0), (0, 2, 0), (-2, 2, 0)], [(wide, -2, 0), (2, -2, 0), (2, 2, 0), (wide, 2, 0)]
    face = [(0, -2, 0), (wide, -2, 0), (wide, 2, 0), (0, 2, 0)]
    assert 0.95 < light_of_a_face(floor, face, render, 0.5) < 1.16
