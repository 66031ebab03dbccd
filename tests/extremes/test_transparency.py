# SPDX-License-Identifier: GPL-3.0-or-later
"""Transparent layers may have extreme scales, distances, opacities, numbers and gaps, or contain the eye."""

import math
from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.rendering import Camera, Instance, Scene, Settings, look_at
from splat_addon.surfels import Surfels

WORLD = (0.1, 0.2, 0.3)
METHODS = ["quad", "mip"]


def sheets(depths, opacity, scale=1.0, origin=(0.0, 0, 0)) -> tuple[Scene, Camera]:
    """White squares across the view at these depths, and a camera at the origin."""
    axis = (np.arange(16) + 0.5) / 8 - 1
    x, y = (a.ravel() * 3 for a in np.meshgrid(axis, axis))
    up = np.tile((0.0, 0, 1), (256, 1))
    instances = []
    for depth in depths:
        places = np.stack([x, y, np.full(256, -depth)], axis=1) * scale
        turns = np.tile((1.0, 0, 0, 0), (256, 1))
        colors = np.tile((1.0, 1, 1, opacity), (256, 1))
        surfels = Surfels(places, turns, np.full((256, 2), 0.6 * scale), up, colors, np.zeros(256, int), origin=origin)
        instances.append(Instance(surfels))
    matrix = np.eye(4)
    matrix[:3, 3] = origin
    return Scene(instances, world=WORLD), Camera.perspective(matrix, 0.5, (16, 16), 0.1 * scale, 1e3 * scale)


def through(opacity: float, count: int) -> np.ndarray:
    """The value of a pixel that shows the white sheets and the world behind them."""
    left = (1 - opacity) ** count
    return np.array([1 - left + left * c for c in WORLD])


def peeled(**choices) -> Settings:
    return Settings(shading="flat", layers=64, blends_rest=False, **choices)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("scale", [1e-6, 1e-3, 1.0, 1e3, 1e6])
def test_scale_changes_nothing(method, scale, render):
    frame = render(*sheets((4, 5, 6), 0.4, scale), peeled(method=method))
    assert np.abs(frame.color[..., :3] - through(0.4, 3)).max() < 1e-5


@pytest.mark.parametrize("method", METHODS)
def test_a_hundred_million_from_the_origin_nothing_changes(method, render):
    frame = render(*sheets((4, 5, 6), 0.4, origin=(1e8, -1e8, 1e8)), peeled(method=method))
    assert np.abs(frame.color[..., :3] - through(0.4, 3)).max() < 1e-5


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("opacity", [0.0, 5e-4, 2e-3, 0.5, 0.998, 1.0, 7.0])
def test_any_opacity_is_one_from_0_to_1(method, opacity, render):
    frame = render(*sheets((4, 5, 6), opacity), peeled(method=method))
    shown = 0.0 if opacity < 1e-3 else min(opacity, 1.0)
    assert np.abs(frame.color[..., :3] - through(shown, 3)).max() < 1e-5


@pytest.mark.parametrize("method", METHODS)
def test_sixty_layers(method, render):
    """The farthest sheets only cover the middle of the picture."""
    frame = render(*sheets(4 + np.arange(60) / 2, 0.05), peeled(method=method))
    assert frame.stats["layers"] == 60
    assert np.abs(frame.color[7:9, 7:9, :3] - through(0.05, 60)).max() < 1e-4


@pytest.mark.parametrize("method", METHODS)
def test_sheets_closer_than_epsilon_are_one(method, render):
    """Splats of radius 0.6 are moved back by 0.3: closer sheets are one surface, sheets farther apart are two."""
    for gap, count in ((0.2, 1), (0.45, 2)):
        frame = render(*sheets((4, 4 + gap), 0.4), peeled(method=method))
        assert frame.stats["layers"] == count
        assert np.abs(frame.color[..., :3] - through(0.4, count)).max() < 1e-4


@pytest.mark.parametrize("blends_rest", [False, True])
@pytest.mark.parametrize("method", METHODS)
def test_an_eye_inside_glass_sees_one_surface(method, blends_rest, render):
    """The eye sees the inside of a ball all around, with splats that reach the near plane."""
    scene, _ = scenes.transparent_spheres(count=4000)
    ball = replace(scene.surfels[0], matrix_world=np.eye(4))
    camera = Camera.perspective(look_at((0.9, 0, 0), (-1, 0.2, 0)), math.radians(70), (48, 48), near=0.02, far=10)
    settings = Settings(method=method, shading="flat", blends_rest=blends_rest, transparent_film=True)
    frame = render(Scene([ball]), camera, settings)
    assert np.isfinite(frame.color).all()
    assert np.abs(frame.color[..., 3] - 0.35).max() < 1e-3
