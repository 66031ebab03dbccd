# SPDX-License-Identifier: GPL-3.0-or-later
"""What is a pixel wide, before or between other surfaces: silhouettes on both of its sides, filtered by mip as any."""

import math
from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import render_exact
from splat_addon.reference.extremes import discs
from splat_addon.rendering import Camera, Scene, Settings, look_at

SIDE = 24  # pixels; one is as wide as 1 at a depth of 100
BLACK, WHITE = (0.02, 0.02, 0.02), (0.9, 0.9, 0.9)
CAMERAS = {
    "perspective": Camera.perspective(
        look_at((0, 0, 0), (0, 0, -1), (0, 1, 0)), 2 * math.atan(SIDE / 200), (SIDE, SIDE), 1, 1000
    ),
    "parallel": Camera.orthographic(look_at((0, 0, 0), (0, 0, -1), (0, 1, 0)), SIDE, (SIDE, SIDE), 1, 1000),
}


def strip(low: float, high: float, depth: float, turn: float, tilt: float, color, opacity: float):
    """From x = low to high and endless along y, turned in the picture and then tilted away from it: ellipses of 0.6 to
    each side, overlapping until the edges are straight."""
    x, y = (a.reshape(-1, 1) for a in np.meshgrid(np.arange(low + 0.6, high - 0.59, 0.4), np.arange(-40, 40.5, 0.7)))
    turned = np.array(((math.cos(turn), math.sin(turn), 0), (-math.sin(turn), math.cos(turn), 0)))
    across, up = turned * (1, math.cos(tilt), 0) + turned[:, 1:2] * (0, 0, math.sin(tilt))
    made = discs(x * across + y * up + (0, 0, -depth), 0.6 * across, 2 * up, color)
    return replace(made, colors=made.colors * (1, 1, 1, opacity))


def scene_of(kind: str, turn: float, tilt: float, opacity: float = 1, distance: float = 30) -> Scene:
    if kind == "wire":
        near = [strip(-0.1, 1.11, 100, turn, tilt, WHITE, opacity)]
        behind = BLACK
    else:
        near = [strip(*ends, 100, turn, tilt, BLACK, opacity) for ends in ((-24, 0), (1, 25))]
        behind = WHITE
    # Of transparent surfaces, the farther one is in the nearer one's layer where that is not.
    return Scene((*near, strip(-40, 40, 100 + distance, turn, tilt, behind, 1 if opacity == 1 else 0.95)))


@pytest.mark.parametrize("opacity", [1, 0.6], ids=["opaque", "transparent"])
@pytest.mark.parametrize(("turn", "tilt"), [(0, 0), (0.3, 0), (1.2, 0.7)])
@pytest.mark.parametrize("name", CAMERAS)
@pytest.mark.parametrize("kind", ["wire", "gap"])
def test_both_silhouettes_are_filtered(kind, name, turn, tilt, opacity, render):
    """Unfiltered, a pixel in the gap or on the wire is all white: 0.25 to 0.55 off."""
    scene, settings = scene_of(kind, turn, tilt, opacity), Settings(shading="flat")
    frame = render(scene, CAMERAS[name], settings)
    truth = render_exact(scene, CAMERAS[name], settings, samples=4, pixel_filter="gaussian")
    off = np.abs(frame.color - truth.color)[2:-2, 2:-2, 0]
    assert off.max() < 0.25, off.max()


@pytest.mark.parametrize(("turn", "tilt"), [(0, 0), (0.3, 0), (1.2, 0.2)])
@pytest.mark.parametrize("kind", ["wire", "gap"])
def test_so_they_are_before_a_close_surface(kind, turn, tilt, render):
    """2.5 behind, where up to 1 would mix. Visibility moved both back by 1; if that is forgotten, what is before the
    other passes for it and is not filtered: 0.27 to 0.31 off."""
    scene, camera, settings = scene_of(kind, turn, tilt, distance=2.5), CAMERAS["parallel"], Settings(shading="flat")
    truth = render_exact(scene, camera, settings, samples=4, pixel_filter="gaussian")
    off = np.abs(render(scene, camera, settings).color - truth.color)[2:-2, 2:-2, 0]
    assert off.max() < 0.2, off.max()


@pytest.mark.parametrize("turn", [0.1, 0.3, 1.2])
def test_the_scallops_of_a_crease_are_filtered(turn, render):
    """Two planes meet in a ridge, in one depth: discs of either stick out of the other, and only their normals tell
    them apart. Unfiltered, pixels there are all white or all black."""
    along, up = (a.reshape(-1, 1) for a in np.meshgrid(np.arange(0, 30, 1.1), np.arange(-30, 30, 1.1)))
    roll = np.array(((math.cos(turn), math.sin(turn), 0), (-math.sin(turn), math.cos(turn), 0), (0, 0, 1)))
    flanks = []
    for across, color in (((0.6, 0, -0.8), WHITE), ((-0.6, 0, -0.8), BLACK)):
        u, v = across @ roll, (0, 1, 0) @ roll
        center = along * u + up * v + (0.3, 0, -100)
        flanks.append(discs(center, 1.1 * u, 1.1 * v * math.copysign(1, across[0]), color))
    scene, camera, settings = Scene(tuple(flanks)), CAMERAS["perspective"], Settings(shading="flat")
    truth = render_exact(scene, camera, settings, samples=4, pixel_filter="gaussian")
    off = np.abs(render(scene, camera, settings).color - truth.color)[2:-2, 2:-2, 0]
    assert off.max() < 0.3, off.max()


@pytest.mark.parametrize("lean", [0.02, 0.05])
def test_what_is_edge_on_behind_the_back_of_a_wall_does_not_shine_through_it(lean, render):
    """Beyond its rim its plane runs ahead of the wall, as far as the filter reaches; and a front weighs more there."""
    across, up = (a.reshape(-1, 1) for a in np.meshgrid(np.arange(-30, 30, 0.7), np.arange(-30, 30, 0.7)))
    wall = discs(across * (1, 0, 0) + up * (0, 1, 0) + (0, 0, -100), (0.6, 0, 0), (0, -0.6, 0), WHITE)
    into, along = (a.reshape(-1, 1) for a in np.meshgrid(np.arange(4.5, 20, 0.7), np.arange(-30, 30, 0.7)))
    axis = np.array((lean, 0, -1))
    behind = discs(into * axis + along * (0, 1, 0) + (0.3, 0, -100), 0.6 * axis, (0, 0.6, 0), BLACK)
    picture = render(Scene((wall, behind)), CAMERAS["perspective"], Settings(shading="flat")).color
    assert picture[2:-2, 2:-2, :3].min() > 0.89
