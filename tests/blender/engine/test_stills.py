# SPDX-License-Identifier: GPL-3.0-or-later
"""A final picture merges small surfels, whatever was drawn before it. Surfels that may be others in the next frame are
merged only if the picture's samples save more time than making levels of detail takes."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.engine import final_render


@pytest.fixture
def crowd(scene, add_camera, add_surfels):
    """10,000 surfels on 100 pixels."""
    add_camera()
    x, y = np.mgrid[:100, :100].reshape(2, -1) / 100 - 0.5
    scene["crowd"] = add_surfels(np.stack([x, y, 0 * x], axis=1), size=0.01)
    scene.surfel_splatting.detail_tolerance = 1.0
    return scene


def drawn():
    return final_render.last_frame_stats["splats_drawn"]


@pytest.mark.parametrize("persists", [False, True])
def test_surfels_that_stay_are_merged_whatever_the_number_of_samples(persists, crowd, picture):
    crowd.render.use_persistent_data = persists
    for samples in (1, 16):
        crowd.surfel_splatting.samples = samples
        picture()
        assert drawn() < 5000


@pytest.mark.parametrize("persists", [False, True])
def test_surfels_that_may_change_are_merged_if_the_samples_pay_for_it(persists, crowd, picture):
    crowd.render.use_persistent_data = persists
    crowd["crowd"].modifiers.new("Wave", "WAVE")
    found = []
    for samples in (1, 16, 1):
        crowd.surfel_splatting.samples = samples
        picture()
        found.append(drawn() < 5000)
    assert found == [False, True, False]


@pytest.mark.parametrize("has_wave", [False, True])
def test_frames_of_an_animation_are_those_that_are_drawn_alone(has_wave, crowd, picture):
    crowd.frame_start, crowd.frame_end, found, alone = 1, 2, [], []
    if has_wave:
        crowd["crowd"].modifiers.new("Wave", "WAVE")
        crowd.surfel_splatting.samples = 4
    bpy.app.handlers.render_post.append(lambda *_: found.append(drawn()))
    try:
        bpy.ops.render.render(animation=True)
    finally:
        bpy.app.handlers.render_post.pop()
    for frame in (1, 2):
        crowd.frame_set(frame)
        picture()
        alone.append(drawn())
    assert found == alone and max(found) < 5000
