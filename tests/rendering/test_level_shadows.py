# SPDX-License-Identifier: GPL-3.0-or-later
"""Shadows of merged surfels are those of all surfels, whatever level the shadow map draws."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import scenes
from splat_addon.rendering import Camera, Instance, Light, Scene, look_at
from splat_addon.sampling import TriangleMesh
from tests.plain import sample_mesh
from tests.rendering.level_scenes import EVERY, LAMPS, SIZE, SOME, far_torus


@pytest.mark.parametrize("resolution", [128, 512, 2048])
@pytest.mark.parametrize("tolerance", [1.25, 2.5])
def test_what_is_merged_casts_no_shadow_on_itself(tolerance, resolution, render):
    """The camera and the shadow map draw different levels, either of which may be coarser.

    They never differ so much that a lit surface shadows itself.
    """
    scene, camera = far_torus()
    light = replace(LAMPS["sun"][0], direction=tuple(camera.matrix_world[:3, :3] @ (0.2, -0.3, -1)))
    scene = replace(scene, lights=(light,))
    every = replace(EVERY, shadow_resolution=resolution, outputs=("color", "depth", "normal", "coverage", "shadow"))
    truth, some = (render(scene, camera, replace(every, detail_tolerance=t)) for t in (0.0, tolerance))
    inside = truth.coverage > 0.999
    falsely = inside & (truth.shadow[..., 0] > 0.999) & (some.shadow[..., 0] < 0.5)
    lost = inside & (truth.shadow[..., 0] < 0.001) & (some.shadow[..., 0] > 0.5)
    assert some.stats["splats_drawn"] < 0.5 * truth.stats["splats_drawn"] and inside.sum() > 80
    # a shadow's edge may move by the tolerance
    assert not falsely.any() and lost.sum() <= 0.02 * inside.sum()


def test_colors_make_no_shadow_map_finer(render):
    """A ball beside the picture casts the same shadow, to the bit, whatever its surfels' colours are."""
    ball = scenes.sphere(32_000, SIZE)[0].surfels[0].surfels
    colors = np.array(ball.colors)
    colors[:, :3] = np.random.default_rng(0).uniform(0, 1, (len(ball), 3))
    plane = TriangleMesh([(0, -3, 0), (6, -3, 0), (6, 3, 0), (0, 3, 0)], [(0, 1, 2), (0, 2, 3)])
    above = np.eye(4)
    above[2, 3] = 2.0
    floor = Instance(sample_mesh(plane, resolution=40), np.eye(4))
    sun = Light("sun", energy=3, direction=(1, 0, -0.7), casts_shadow=True)
    camera = Camera.orthographic(look_at((3, 0, 9), (3, 0, 0), (0, 1, 0)), 4.0, SIZE, 0.1, 20)
    settings = replace(SOME, shadow_resolution=64, outputs=("shadow",))
    grey, colored = (
        render(Scene((floor, Instance(caster, above)), (sun,)), camera, settings).shadow
        for caster in (ball, replace(ball, colors=colors))
    )
    assert 0.1 < grey.mean() < 0.9
    assert np.array_equal(grey, colored)
