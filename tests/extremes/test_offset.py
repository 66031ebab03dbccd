# SPDX-License-Identifier: GPL-3.0-or-later
"""Far from the world's origin nothing changes, because positions are made camera-relative in float64."""

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
    return scenes.torus(1500, (32, 32))


def moved(offset):
    matrix = np.eye(4)
    matrix[:3, 3] = offset * DIRECTION
    return matrix


@pytest.mark.parametrize("offset", OFFSETS)
def test_object_and_camera_far_away_look_the_same(offset, world, render_all):
    base, far = render_all([(*transformed(*world, moved(o)), None) for o in (0.0, offset)])
    assert psnr(far.color, base.color) > 60


@pytest.mark.parametrize("offset", OFFSETS)
def test_the_distance_may_lie_in_the_surfels_origin(offset, world, render_all):
    """The surfels are like a scan in map coordinates: float32 positions relative to a float64 origin."""
    scene, camera = world
    far_scene, far_camera = transformed(scene, camera, moved(offset))
    instances = [replace(i, shape=replace(i.surfels, origin=offset * DIRECTION)) for i in scene.surfels]
    base, far = render_all([(scene, camera, None), (replace(far_scene, surfels=instances), far_camera, None)])
    assert psnr(far.color, base.color) > 60
