# SPDX-License-Identifier: GPL-3.0-or-later
"""A new scene renders with the Mip Filter and one sample per pixel."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.engine import final_render
from splat_addon.blender.properties import viewport_settings
from splat_addon.blender.render_settings.samples import is_coarser_than_viewport
from splat_addon.rendering.presets import PRESETS


def test_a_new_scene_has_the_balanced_preset():
    settings = bpy.data.scenes.new("new").surfel_splatting
    assert (settings.method, settings.supersampling, settings.samples) == ("mip", 1, 16)
    assert PRESETS["balanced"].is_in(settings)


def test_a_new_scene_s_final_render_has_the_samples_of_the_viewport_at_rest(scene, add_camera, add_surfels, picture):
    """tests/rendering/test_refinement.py compares the viewport's redraws with final renders of as many samples."""
    properties, layer = scene.surfel_splatting, scene.view_layers[0]
    for name in ("method", "supersampling", "samples"):
        properties.property_unset(name)
    add_camera()
    add_surfels([(0, 0, 0)], size=1.0)
    picture()
    assert final_render.last_frame_stats["samples"] == viewport_settings(scene).samples == 16
    assert not is_coarser_than_viewport(scene, layer)
    properties.samples = 15
    assert is_coarser_than_viewport(scene, layer)
    properties.supersampling = 2
    assert not is_coarser_than_viewport(scene, layer)


def _use_defaults(scene):
    for name in ("method", "supersampling"):
        scene.surfel_splatting.property_unset(name)


@pytest.mark.parametrize("pixels", [2.5, 9.0])
def test_a_disc_covers_its_area_under_the_pixels_gaussian(pixels, scene, add_camera, add_surfels, picture):
    """Without the filter the edge would be hard, and the picture would have at most six different values."""
    _use_defaults(scene)
    add_camera((0, 0, 10), type="ORTHO", ortho_scale=32)
    add_surfels([(0.2, -0.1, 0)], size=pixels)
    alpha = picture()[..., 3]
    assert alpha.sum() == pytest.approx(np.pi * pixels**2, rel=0.05)
    assert np.unique(alpha).size > 6


def test_separate_discs_smaller_than_a_pixel_cover_their_area_on_average(scene, add_camera, add_surfels, picture):
    """A single small disc may contain a pixel's sample or miss it; the mean over many positions is the area."""
    _use_defaults(scene)
    add_camera((0, 0, 10), type="ORTHO", ortho_scale=64)
    scene.render.resolution_x = scene.render.resolution_y = 64
    across = 6.1 * np.arange(10) - 27.4
    add_surfels([(x, y, 0.0) for x in across for y in across], size=0.3)
    alpha = picture()[..., 3]
    assert alpha.sum() == pytest.approx(100 * np.pi * 0.3**2, rel=0.15)
    assert np.unique(alpha).size > 6
