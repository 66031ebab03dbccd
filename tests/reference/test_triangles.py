# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of a mesh agrees with closed forms and with trimesh's rays, which share no code with it."""

import numpy as np
import pytest
import trimesh

from splat_addon.reference.triangles import render_triangles
from splat_addon.rendering import Camera, look_at

ONES = np.ones((1, 3, 3))


def front(corners):
    """The (1, 3, 3) corners of a triangle at z = -2, from x and y."""
    return np.array([[(x, y, -2.0) for x, y in corners]])


@pytest.fixture
def camera():
    return Camera(np.eye(4), (-1, 1, -1, 1), (32, 32), 0.1, 100.0)


def test_a_triangle_covers_its_area(camera):
    picture = render_triangles(front([(-1.3, -1.1), (1.2, -0.9), (0.3, 1.4)]), ONES, camera, pixel_filter="box")
    area = 0.5 * abs(2.5 * 2.5 - 1.6 * 0.2) / 4  # over depth squared
    assert picture.coverage.sum() * (2 / 32) ** 2 == pytest.approx(area, rel=2e-3)
    assert np.array_equal(picture.coverage, picture.share)


def test_triangles_that_share_an_edge_cover_every_sample_once(camera):
    random = np.random.default_rng(2)
    inner = np.append(random.uniform(-0.9, 0.9, (60, 2)), [(-3, -3), (3, -3), (3, 3), (-3, 3)], axis=0)
    from scipy.spatial import Delaunay

    corners = np.array([[(2 * x, 2 * y, -2.0) for x, y in inner[t]] for t in Delaunay(inner).simplices])
    picture = render_triangles(corners, np.ones((len(corners), 3, 3)), camera, samples=3)
    assert np.allclose(picture.coverage, 1) and np.allclose(picture.color, 1)


def test_colours_are_linear_on_the_surface_and_not_in_the_picture(camera):
    corners = np.array([[(-50.0, -1, -2), (50, -1, -2), (0, -1, -80)]])
    colors = -np.repeat(corners[..., 2:], 3, axis=2)
    picture = render_triangles(corners, colors, camera, samples=1, pixel_filter="box")
    y = (np.arange(32) + 0.5) / 16 - 1
    rows = np.flatnonzero((picture.coverage[:, 16] == 1) & (y < -0.02))
    assert len(rows) > 5 and np.allclose(picture.color[rows, 16, 0], -1 / y[rows])


def test_the_nearest_is_seen_through_perspective_and_parallel_cameras(camera):
    parallel = Camera(np.eye(4), (-1, 1, -1, 1), (32, 32), 0.1, 100.0, is_orthographic=True)
    both = np.concatenate([front([(-9, -9), (9, -9), (0, 9)]), front([(-9, -9), (9, -9), (0, 9)]) * (1, 1, 2)])
    colors = np.stack([np.tile((1.0, 0, 0), (3, 1)), np.tile((0, 1.0, 0), (3, 1))])
    for view in (camera, parallel):
        for order in ((0, 1), (1, 0)):
            color = render_triangles(both[list(order)], colors[list(order)], view, samples=1).color
            assert np.allclose(color[16, 16], (1, 0, 0))


def test_it_agrees_with_rays():
    ball = trimesh.creation.torus(1.0, 0.4, major_sections=24, minor_sections=12)
    camera = Camera.perspective(look_at((2, -3, 1.5), (0, 0, 0)), 0.8, (24, 24), 0.1, 100)
    colors = ball.vertex_normals[ball.faces] * 0.5 + 0.5
    picture = render_triangles(ball.vertices[ball.faces], colors, camera, samples=1, pixel_filter="box")
    left, right, bottom, top = camera.window
    x, y = left + (np.arange(24) + 0.5) * (right - left) / 24, bottom + (np.arange(24) + 0.5) * (top - bottom) / 24
    ways = (
        np.stack([*np.meshgrid(x, y), np.full((24, 24), -1.0)], axis=2).reshape(-1, 3) @ camera.matrix_world[:3, :3].T
    )
    eyes = np.tile(camera.matrix_world[:3, 3], (len(ways), 1))
    places, rays, faces = ball.ray.intersects_location(eyes, ways, multiple_hits=False)
    seen = np.zeros((24 * 24, 3))
    shares = trimesh.triangles.points_to_barycentric(ball.triangles[faces], places)
    seen[rays] = np.einsum("nk,nkc->nc", shares, colors[faces])
    assert (np.abs(picture.color.reshape(-1, 3) - seen).max(axis=1) < 1e-6).mean() > 0.995
    assert 0.2 < picture.coverage.mean() < 0.8


def test_the_gaussian_blurs_a_straight_edge_as_its_integral_says(camera):
    from math import erf

    # The edge runs through the middle of the picture.
    corners = front([(0, -99), (0, 99), (-99, 0)])
    row = render_triangles(corners, ONES, camera).coverage[16]
    expected = [0.5 - 0.5 * erf((k + 0.5 - 16) / (0.7071 * 2**0.5)) for k in range(32)]
    assert np.abs(row - expected).max() < 1e-3


def test_what_reaches_before_the_near_plane_is_refused(camera):
    with pytest.raises(ValueError, match=r"near plane at 0\.1; step back"):
        render_triangles(np.array([[(0, 0, 0.0), (1, 0, -2), (0, 1, -2)]]), ONES, camera)
