# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes that the engine is compared on are reproducible and have no holes."""

import numpy as np
import pytest

from splat_addon.reference import render_exact, scenes
from splat_addon.reference.lettering import page
from splat_addon.rendering.scene.camera import Camera, look_at
from splat_addon.rendering.settings import Settings
from splat_addon.surfels import LAYOUT

BUILDERS = {
    "sphere": scenes.sphere,
    "checker_plane": scenes.checker_plane,
    "text_board": scenes.text_board,
    "torus": scenes.torus,
}
every_scene = pytest.mark.parametrize("name", BUILDERS)


@every_scene
def test_a_scene_is_the_same_every_time(name):
    first, second = (BUILDERS[name](count=400)[0] for _ in range(2))
    for a, b in zip(first.surfels, second.surfels, strict=True):
        for column in LAYOUT:
            np.testing.assert_array_equal(getattr(a.surfels, column), getattr(b.surfels, column))


@every_scene
def test_a_scene_has_the_surfels_asked_for(name):
    assert sum(len(i.surfels) for i in BUILDERS[name](count=2500)[0].surfels) == 2500


@every_scene
def test_a_scene_has_no_holes(name):
    """If the eight neighbours of a pixel are covered, so is the pixel."""
    scene, camera = BUILDERS[name](count=4000, size=(48, 48))
    coverage = render_exact(scene, camera, Settings(shading="flat"), samples=2).coverage
    windows = np.lib.stride_tricks.sliding_window_view(coverage == 1, (3, 3)).reshape(46, 46, 9)
    surrounded = np.delete(windows, 4, axis=2).all(axis=2)
    assert surrounded.sum() > 200
    assert coverage[1:-1, 1:-1][surrounded].min() == 1


def test_the_inner_torus_shows_only_through_the_cut():
    scene, camera = scenes.torus(8000, (48, 48))
    frame = render_exact(scene, camera, Settings(shading="flat"), samples=1)
    gold = (frame.color[..., 0] > 0.9) & (frame.color[..., 2] < 0.3)
    assert 0.05 < gold.sum() / (frame.coverage > 0).sum() < 0.35
    assert not gold[30:].any()


def test_the_text_board_can_be_read():
    """Seen from straight above at 4 pixels per dot, the ink is where the text's dots are."""
    columns = 4
    scene, _ = scenes.text_board(count=40_000, columns=columns)
    ink = page(columns, 2)
    above = look_at((0, 0, 5), (0, 0, 0), (0, 1, 0))
    camera = Camera(above, window=(-1, 1, -1, 1), size=(96, 72), is_orthographic=True)
    frame = render_exact(scene, camera, Settings(shading="flat"), samples=2)
    middles = frame.color[2::4, 2::4, 0]
    assert middles.shape == ink.shape
    np.testing.assert_array_equal(middles > 0.44, ink)
