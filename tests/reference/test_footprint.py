# SPDX-License-Identifier: GPL-3.0-or-later
"""The position and depth of a single splat in the picture agree with closed forms."""

import math

import numpy as np
import pytest

from splat_addon.reference import render_exact
from splat_addon.rendering.frame import EMPTY_DEPTH
from splat_addon.rendering.scene import Scene
from splat_addon.rendering.settings import Settings

FLAT = Settings(shading="flat")


def tilted(angle, radius):
    """The half-axes of a disc that faces the camera, turned by `angle` radians about x."""
    return (radius, 0, 0), (0, radius * math.cos(angle), radius * math.sin(angle))


def test_a_disc_facing_a_perspective_camera_covers_pi_r_squared(ellipses, perspective):
    frame = render_exact(Scene([ellipses((0.2, 0.1, -2), *tilted(0, 1.2))]), perspective(), FLAT)
    assert frame.coverage.sum() == pytest.approx(math.pi * (1.2 * 16 / 2) ** 2, rel=1e-3)


@pytest.mark.parametrize("angle", [0.5, 1.2, -1.4])
def test_a_tilted_disc_covers_the_area_of_its_projected_conic(ellipses, perspective, angle):
    r, d = 1.2, 2.5
    frame = render_exact(Scene([ellipses((0, 0, -d), *tilted(angle, r))]), perspective(), FLAT)
    foreshortening = r * math.sin(angle) / d
    area = math.pi * (r / d) ** 2 * math.cos(angle) / (1 - foreshortening**2) ** 1.5
    assert frame.coverage.sum() == pytest.approx(area * 16**2, rel=3e-3)


def test_a_tilted_ellipse_in_an_orthographic_camera_covers_its_area_times_the_cosine(ellipses, orthographic):
    u, v = (0.8, 0, 0), (0, 0.5 * math.cos(1), 0.5 * math.sin(1))
    frame = render_exact(Scene([ellipses((0.1, -0.1, -3), u, v)]), orthographic(), FLAT)
    assert frame.coverage.sum() == pytest.approx(math.pi * 0.8 * 0.5 * math.cos(1) * 16**2, rel=3e-3)


def test_the_depth_of_a_tilted_splat_is_that_of_its_plane_along_each_ray(ellipses, perspective):
    center, (u, v) = np.array((0.1, -0.2, -3)), tilted(0.9, 1.5)
    frame = render_exact(Scene([ellipses(center, u, v)]), perspective(), FLAT, samples=1)
    x, y = np.meshgrid(*[(np.arange(32) + 0.5) / 16 - 1] * 2)
    normal = np.cross(u, v)
    plane = normal @ center / (normal[0] * x + normal[1] * y - normal[2])
    hit = frame.coverage > 0
    assert hit.sum() > 50
    np.testing.assert_allclose(frame.depth[hit], plane[hit], rtol=1e-6)


def test_the_depth_of_an_orthographic_picture_is_that_of_the_plane(ellipses, orthographic):
    u, v = tilted(0.9, 1.5)
    frame = render_exact(Scene([ellipses((0, 0, -3), u, v)]), orthographic(), FLAT, samples=1)
    y = (np.arange(32) + 0.5) / 16 - 1
    np.testing.assert_allclose(frame.depth[6:26, 16], (3 - y * math.tan(0.9))[6:26], rtol=1e-6)


def test_a_pixels_depth_is_that_of_its_nearest_ray(ellipses, orthographic):
    u, v = tilted(0.9, 1.5)
    frame = render_exact(Scene([ellipses((0, 0, -3), u, v)]), orthographic(), FLAT, samples=4)
    highest = (np.arange(32) + 7 / 8) / 16 - 1
    np.testing.assert_allclose(frame.depth[6:26, 16], (3 - highest * math.tan(0.9))[6:26], rtol=1e-6)


def test_depth_is_empty_where_no_ray_hits(ellipses, perspective):
    frame = render_exact(Scene([ellipses((0, 0, -2), *tilted(0, 0.5))]), perspective(), FLAT)
    np.testing.assert_array_equal(frame.depth == np.float32(EMPTY_DEPTH), frame.coverage == 0)
    assert 0 < (frame.coverage == 0).mean() < 1


def test_a_splat_seen_edge_on_covers_nothing(ellipses, perspective):
    frame = render_exact(Scene([ellipses((0, 0, -2), (1, 0, 0), (0, 0, 1))]), perspective(), FLAT)
    assert frame.coverage.max() == 0


@pytest.mark.parametrize("near", [0.01, 1.5])
def test_ground_that_runs_behind_the_eye_is_seen_from_the_near_plane_on(ellipses, perspective, near):
    camera = perspective(near=near, far=20.0)
    frame = render_exact(Scene([ellipses((0, -1, 0), (0, 0, 200), (200, 0, 0))]), camera, FLAT, samples=1)
    rows = (np.arange(32) + 0.5) / 16 - 1
    depth = np.full(32, np.inf)
    depth[rows < 0] = -1 / rows[rows < 0]
    seen = (depth >= near) & (depth <= 20)
    np.testing.assert_array_equal(frame.coverage, np.broadcast_to(seen[:, None], (32, 32)))
    np.testing.assert_allclose(frame.depth[seen, 0], depth[seen], rtol=1e-6)


def test_a_splat_behind_the_camera_is_not_seen(ellipses, perspective):
    frame = render_exact(Scene([ellipses((0, 0, 2), *tilted(0, 1))]), perspective(), FLAT)
    assert frame.coverage.max() == 0
