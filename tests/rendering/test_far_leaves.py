# SPDX-License-Identifier: GPL-3.0-or-later
"""Leaves smaller than a pixel, each drawn as one merged surfel, show as much of what is behind them as they should."""

import numpy as np
import pytest

from splat_addon.quaternions import axes_quaternions
from splat_addon.rendering import Camera, Scene, Settings, look_at
from splat_addon.rendering.scene import Instance
from splat_addon.surfels import Surfels

COLOR, BEHIND = np.array([0.2, 0.6, 0.1]), np.array([0.5, 0.5, 0.8])
#: Surfels along the edge of a leaf, leaves along that of a bush, bushes along that of the field; in pixels, the edge of
#: a leaf and the distance between leaves.
ACROSS, LEAVES, BUSHES, EDGE, APART = 6, 4, 3, 0.7, 3.07
SETTINGS = Settings(samples=16, shading="flat", shadow_resolution=0)


def bush(tilt):
    """Leaves apart from one another, turned about the picture's x."""
    spacing = EDGE / ACROSS
    within = (np.arange(ACROSS) - (ACROSS - 1) / 2) * spacing
    middles = (np.arange(LEAVES) - (LEAVES - 1) / 2) * APART
    u, v = (each.ravel() for each in np.meshgrid(within, within))
    across, along = np.array([1.0, 0, 0]), np.array([0, np.cos(tilt), np.sin(tilt)])
    leaf = u[:, None] * across + v[:, None] * along
    x, y = (each.ravel() for each in np.meshgrid(middles, middles))
    places = (np.column_stack([x, y, 0 * x])[:, None] + leaf).reshape(-1, 3)
    count = len(places)
    normal = np.cross(across, along)
    return Surfels(
        positions=places,
        rotations=axes_quaternions(*(np.tile(axis, (count, 1)) for axis in (across, along, normal))),
        scales=np.full((count, 2), 1.25 * spacing),
        normals=np.tile(normal, (count, 1)),
        colors=np.tile([*COLOR, 1.0], (count, 1)),
        materials=np.zeros(count, np.int32),
        blend_depth=np.full(count, 0.1, np.float32),
    )


def drawn(render, shape):
    """The frame of a square field of bushes, a pixel a unit."""
    width = LEAVES * APART
    size = round(BUSHES * width)
    matrices = np.tile(np.eye(4), (BUSHES**2, 1, 1))
    matrices[:, 0, 3] = width * (np.arange(BUSHES**2) % BUSHES - (BUSHES - 1) / 2)
    matrices[:, 1, 3] = width * (np.arange(BUSHES**2) // BUSHES - (BUSHES - 1) / 2)
    scene = Scene(surfels=[Instance(shape, matrix) for matrix in matrices], background=tuple(BEHIND))
    camera = Camera.orthographic(look_at((0, 0, 20), (0, 0, 0), (0, 1, 0)), size, (size, size))
    return render(scene, camera, SETTINGS)


@pytest.mark.parametrize("tilt", [0.0, 0.9])
def test_leaves_below_a_pixel_keep_their_cover_and_colour(render, tilt):
    shape = bush(tilt)
    frame = drawn(render, shape)
    assert frame.stats["splats_drawn"] == LEAVES**2 * BUSHES**2
    half = 1.25 * EDGE / ACROSS
    edge = EDGE * (1 - 1 / ACROSS) + 2 * half
    cover = np.cos(tilt) * (edge**2 - (4 - np.pi) * half**2) * (LEAVES * BUSHES / round(BUSHES * LEAVES * APART)) ** 2
    seen = frame.color[..., :3].mean(axis=(0, 1))
    assert seen == pytest.approx(cover * COLOR + (1 - cover) * BEHIND, rel=0.003)
    assert (seen - BEHIND) / (COLOR - BEHIND) == pytest.approx(cover, rel=0.03)
