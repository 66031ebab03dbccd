# SPDX-License-Identifier: GPL-3.0-or-later
"""Mip Filter also filters silhouettes of features a pixel wide, on both sides, in front of or between other
surfaces.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import render_exact
from splat_addon.reference.extremes import discs
from splat_addon.rendering import Camera, Scene, Settings, look_at

SIDE = 24  # pixels; at a depth of 100 a pixel is 1 wide
BLACK, WHITE = (0.02, 0.02, 0.02), (0.9, 0.9, 0.9)
CAMERAS = {
    "perspective": Camera.perspective(
        look_at((0, 0, 0), (0, 0, -1), (0, 1, 0)), 2 * math.atan(SIDE / 200), (SIDE, SIDE), 1, 1000
    ),
    "parallel": Camera.orthographic(look_at((0, 0, 0), (0, 0, -1), (0, 1, 0)), SIDE, (SIDE, SIDE), 1, 1000),
}


def strip(low: float, high: float, depth: float, turn: float, tilt: float, color, opacity: float):
    """A strip from x = low to high, endless along y, turned in the picture and then tilted away from it.

    Its ellipses reach 0.6 to each side and overlap so much that the edges are straight.
    """
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


@pytest.mark.parametrize(("turn", "tilt", "opacity"), [(0, 0, 1), (0.3, 0, 1), (1.2, 0.7, 1), (1.2, 0.7, 0.6)], ids=str)
@pytest.mark.parametrize("name", CAMERAS)
@pytest.mark.parametrize("kind", ["wire", "gap"])
def test_both_silhouettes_are_filtered(kind, name, turn, tilt, opacity, render):
    """Without a filter, a pixel in the gap or on the wire is all white, an error of 0.25 to 0.55."""
    scene, settings = scene_of(kind, turn, tilt, opacity), Settings(shading="flat")
    frame = render(scene, CAMERAS[name], settings)
    truth = render_exact(scene, CAMERAS[name], settings, samples=4, pixel_filter="gaussian")
    off = np.abs(frame.color - truth.color)[2:-2, 2:-2, 0]
    assert off.max() < 0.25, off.max()


@pytest.mark.parametrize(("turn", "tilt"), [(0, 0), (0.3, 0), (1.2, 0.2)])
@pytest.mark.parametrize("kind", ["wire", "gap"])
def test_so_they_are_before_a_close_surface(kind, turn, tilt, render):
    """The surface is 2.5 behind; surfaces up to 1 apart would blend.

    The visibility pass moves both back by 1. If that is forgotten, the front surface is taken for the rear one and is
    not filtered: an error of 0.27 to 0.31.
    """
    scene, camera, settings = scene_of(kind, turn, tilt, distance=2.5), CAMERAS["parallel"], Settings(shading="flat")
    truth = render_exact(scene, camera, settings, samples=4, pixel_filter="gaussian")
    off = np.abs(render(scene, camera, settings).color - truth.color)[2:-2, 2:-2, 0]
    assert off.max() < 0.2, off.max()


@pytest.mark.parametrize("turn", [0.1, 0.3, 1.2])
def test_the_scallops_of_a_crease_are_filtered(turn, render):
    """Two planes meet in a ridge at the same depth. Discs of each stick out of the other, and only their normals
    distinguish them.

    Without a filter, pixels there are all white or all black.
    """
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
    """Beyond its rim an edge-on splat's plane runs in front of the wall, as far as the filter reaches, and fronts weigh
    more than the wall's back.
    """
    across, up = (a.reshape(-1, 1) for a in np.meshgrid(np.arange(-30, 30, 0.7), np.arange(-30, 30, 0.7)))
    wall = discs(across * (1, 0, 0) + up * (0, 1, 0) + (0, 0, -100), (0.6, 0, 0), (0, -0.6, 0), WHITE)
    into, along = (a.reshape(-1, 1) for a in np.meshgrid(np.arange(4.5, 20, 0.7), np.arange(-30, 30, 0.7)))
    axis = np.array((lean, 0, -1))
    behind = discs(into * axis + along * (0, 1, 0) + (0.3, 0, -100), 0.6 * axis, (0, 0.6, 0), BLACK)
    picture = render(Scene((wall, behind)), CAMERAS["perspective"], Settings(shading="flat")).color
    assert picture[2:-2, 2:-2, :3].min() > 0.89
