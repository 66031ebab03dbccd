# SPDX-License-Identifier: GPL-3.0-or-later
"""A still merges small surfels only if its samples save more time than making levels of detail takes; an animation
does from its first frame on."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.engine import final_render


@pytest.fixture
def crowd(scene, add_camera, add_surfels):
    """10,000 surfels on 100 pixels."""
    add_camera()
    x, y = np.mgrid[:100, :100].reshape(2, -1) / 100 - 0.5
    add_surfels(np.stack([x, y, 0 * x], axis=1), size=0.01)
    scene.surfel_splatting.detail_tolerance = 1.0
    return scene


def drawn():
    return final_render.last_frame_stats["splats_drawn"]


def test_one_sample_does_not_pay_for_levels_and_many_do(crowd, picture):
    picture()
    assert drawn() == 10_000
    crowd.surfel_splatting.samples = 16
    picture()
    assert drawn() < 5000


def test_data_that_persists_is_made_for_further_renders(crowd, picture):
    crowd.render.use_persistent_data = True
    picture()
    assert drawn() < 5000


def test_an_animation_has_levels_in_each_frame(crowd):
    crowd.frame_start, crowd.frame_end, found = 1, 2, []
    bpy.app.handlers.render_post.append(lambda *_: found.append(drawn()))
    try:
        bpy.ops.render.render(animation=True)
    finally:
        bpy.app.handlers.render_post.pop()
    assert len(found) == 2 and max(found) < 5000
