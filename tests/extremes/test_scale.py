# SPDX-License-Identifier: GPL-3.0-or-later
"""The picture of a world does not depend on its unit: 1e-18 to 1e18."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.reference.extremes import sheet, transformed
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Camera, look_at

SCALES = [1e-18, 1e-12, 1e-6, 1e6, 1e12, 1e18]
SIZE = (32, 32)


def perspective(count=1500):
    return scenes.torus(count, SIZE)


def orthographic():
    scene, _ = perspective()
    return scene, Camera.orthographic(look_at((0.3, -3.6, 2.2), (0, 0, 0)), 3.2, SIZE, 0.1, 10)


def scaled(scale):
    return np.diag([scale, scale, scale, 1.0])


@pytest.mark.parametrize("scale", SCALES)
@pytest.mark.parametrize("world", [perspective, orthographic])
def test_a_scaled_world_looks_the_same(world, scale, render_all, is_default):
    scene, camera = world()
    base, frame = render_all([(*transformed(scene, camera, scaled(s)), None) for s in (1.0, scale)])
    assert psnr(frame.color, base.color) > 60
    # Normals are sums brought to unit length: where tiny weights make them, that magnifies rounding. Where a rim ties
    # at a sample, rounding decides whether it has the splat.
    differences = np.abs(frame.normal - base.normal).max(axis=2)
    assert np.count_nonzero(differences > (1e-3 if is_default else 5e-3)) <= 1


@pytest.mark.parametrize("scale", SCALES)
def test_surfels_may_be_stored_at_any_scale(scale, render_all):
    scene, camera = perspective()
    lights, moved = transformed(scene, camera, scaled(scale))
    instances = [replace(i, shape=stored_at(i.surfels, np.float32(scale))) for i in scene.surfels]
    base, frame = render_all(
        [(scene, camera, None), (replace(scene, surfels=instances, lights=lights.lights), moved, None)]
    )
    assert psnr(frame.color, base.color) > 60


def stored_at(surfels, scale):
    return replace(surfels, positions=surfels.positions * scale, scales=surfels.scales * scale)


def test_a_depth_beyond_that_of_nothing_is_kept(hold, is_unfiltered):
    """The depth 1e10 marks an empty pixel.

    Farther surfaces still keep their depth, and their coverage shows that they exist.
    """
    ((frame, truth),) = hold({"1e12": transformed(*perspective(6000), scaled(1e12))}).values()
    hit = (frame.coverage > 0) & (truth.coverage > 0)
    assert np.median(np.abs(frame.depth[hit] / truth.depth[hit] - 1)) < (1e-6 if is_unfiltered else 1e-2)


@pytest.mark.parametrize("depth", [0, 1e-30, 1e-12])
def test_a_parallel_camera_may_stand_in_what_it_sees(depth, hold, lit):
    """Depths are near zero there, so the view is scaled by the window instead."""
    wall = lit(sheet(12, 1.2, 0, depth))
    hold({f"{depth}": (wall, Camera.orthographic(np.eye(4), 2.0, SIZE, -1, 1))}, least=60)
