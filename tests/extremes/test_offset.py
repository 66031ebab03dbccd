# SPDX-License-Identifier: GPL-3.0-or-later
"""Far from the world's origin nothing changes: positions are made camera-relative in float64."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.reference.extremes import transformed
from splat_addon.reference.metrics import psnr

OFFSETS = [1e4, 1e6, 1e8]
DIRECTION = np.array((1.0, -1.0, 0.5))


@pytest.fixture
def world():
    return scenes.torus(6000, (64, 64))


def moved(offset):
    matrix = np.eye(4)
    matrix[:3, 3] = offset * DIRECTION
    return matrix


def test_object_and_camera_far_away_look_the_same(world, render_all):
    base, *others = render_all([(*transformed(*world, moved(offset)), None) for offset in (0.0, *OFFSETS)])
    assert [o for o, f in zip(OFFSETS, others, strict=True) if psnr(f.color, base.color) < 60] == []


def test_the_distance_may_lie_in_the_surfels_origin(world, render_all):
    """A scan in map coordinates: float32 positions relative to a float64 origin."""
    scene, camera = world
    shots = [(scene, camera, None)]
    for offset in OFFSETS:
        far_scene, far_camera = transformed(scene, camera, moved(offset))
        instances = [replace(i, surfels=replace(i.surfels, origin=offset * DIRECTION)) for i in scene.surfels]
        shots.append((replace(far_scene, surfels=instances), far_camera, None))
    base, *others = render_all(shots)
    assert [o for o, f in zip(OFFSETS, others, strict=True) if psnr(f.color, base.color) < 60] == []
