# SPDX-License-Identifier: GPL-3.0-or-later
"""Whole pictures are right: background, crops, filter margins, and an analytic sphere."""

import math

import numpy as np
import pytest

from splat_addon.reference import exact, render_exact, scenes
from splat_addon.reference.filters import PIXEL_FILTERS
from splat_addon.rendering.scene import Instance, Scene
from splat_addon.rendering.settings import Settings

FLAT = Settings(shading="flat")
ARRAYS = ("color", "depth", "normal", "coverage")


def test_the_world_fills_the_background(perspective):
    frame = render_exact(Scene(world=(0.1, 0.2, 3.0)), perspective(), samples=2)
    np.testing.assert_allclose(frame.color, np.broadcast_to((0.1, 0.2, 3.0, 1.0), (32, 32, 4)), rtol=1e-6)


def test_a_transparent_film_keeps_only_what_is_covered(ellipses, perspective):
    scene = Scene([ellipses((0, 0, -2), colors=(0.5, 0.25, 1))], world=(9, 9, 9))
    frame = render_exact(scene, perspective(), Settings(shading="flat", transparent_film=True))
    expected = frame.coverage[..., None] * np.array((0.5, 0.25, 1, 1))
    np.testing.assert_allclose(frame.color, expected, atol=1e-6)
    assert ((frame.coverage > 0) & (frame.coverage < 1)).any()


@pytest.mark.parametrize("pixel_filter", PIXEL_FILTERS)
def test_a_cropped_camera_gives_the_crop_of_the_picture(pixel_filter):
    scene, camera = scenes.torus(1500, (40, 30))
    whole = render_exact(scene, camera, samples=3, pixel_filter=pixel_filter)
    part = render_exact(scene, camera.cropped(5, 8, 23, 17), samples=3, pixel_filter=pixel_filter)
    for name in ARRAYS:
        np.testing.assert_allclose(getattr(part, name), getattr(whole, name)[8:25, 5:28], rtol=1e-5, atol=1e-6)


@pytest.mark.parametrize("pixel_filter", PIXEL_FILTERS)
def test_tiles_leave_no_trace(monkeypatch, pixel_filter):
    scene, camera = scenes.torus(1500, (40, 30))
    one_tile = render_exact(scene, camera, samples=2, pixel_filter=pixel_filter)
    monkeypatch.setattr(exact, "TILE_RAYS", 500)
    tiles = render_exact(scene, camera, samples=2, pixel_filter=pixel_filter)
    for name in ARRAYS:
        np.testing.assert_allclose(getattr(tiles, name), getattr(one_tile, name), rtol=1e-6, atol=1e-7)


def test_a_sphere_of_surfels_has_the_analytic_silhouette_and_depth():
    size, radius, focal = 64, math.asin(1 / math.hypot(3.2, 1.2)), 32 / math.tan(math.radians(21))
    scene, camera = scenes.sphere(20_000, (size, size))
    frame = render_exact(scene, camera, FLAT, samples=4)
    x, y = np.meshgrid(*[(np.arange(size) + 0.5 - size / 2) / focal] * 2)
    inside = np.hypot(x, y) < math.tan(radius)
    assert np.abs((frame.coverage >= 0.5) != inside).sum() < 0.02 * inside.sum()
    assert frame.coverage.sum() == pytest.approx(math.pi * (focal * math.tan(radius)) ** 2, rel=0.01)
    inner = np.hypot(x, y) < 0.9 * math.tan(radius)
    distance, square = math.hypot(3.2, 1.2), 1 + x * x + y * y
    depth = (distance - np.sqrt(np.maximum(distance**2 - square * (distance**2 - 1), 0))) / square
    assert np.abs(render_exact(scene, camera, FLAT, samples=1).depth - depth)[inner].max() < 2e-3


def test_a_scene_far_from_the_origin_looks_the_same():
    scene, camera = scenes.torus(1500, (32, 24))
    offset = np.array((2.0**26, -(2.0**25), 2.0**24))
    matrix, eye = np.eye(4), camera.matrix_world.copy()
    matrix[:3, 3] = offset
    eye[:3, 3] += offset
    moved = Scene([Instance(i.surfels, matrix, i.materials) for i in scene.surfels], (), scene.world)
    moved_camera = type(camera)(eye, camera.window, camera.size, camera.near, camera.far)
    there = render_exact(moved, moved_camera, FLAT, samples=2)
    here = render_exact(scene, camera, FLAT, samples=2)
    assert (there.coverage != here.coverage).sum() <= 2
    np.testing.assert_allclose(there.color[there.coverage == 1], here.color[there.coverage == 1], atol=1e-3)


def test_an_empty_scene_gives_an_empty_frame(orthographic):
    frame = render_exact(Scene(), orthographic(), Settings(transparent_film=True), samples=1)
    assert not frame.color.any() and not frame.coverage.any() and not frame.normal.any()


def test_a_frame_is_float32_with_row_0_at_the_bottom(ellipses, orthographic):
    frame = render_exact(Scene([ellipses((0.3, -0.6, -2), (0.2, 0, 0), (0, 0.2, 0))]), orthographic(), FLAT)
    assert all(getattr(frame, name).dtype == np.float32 for name in ARRAYS)
    row, column = np.unravel_index(frame.coverage.argmax(), frame.coverage.shape)
    assert row < 12 and column > 16
