# SPDX-License-Identifier: GPL-3.0-or-later
"""What a new scene renders without a choice: the mip filter, one sample a pixel."""

import bpy
import numpy as np
import pytest

from splat_addon.rendering.presets import PRESETS


def test_a_new_scene_has_the_balanced_preset():
    settings = bpy.data.scenes.new("new").surfel_splatting
    assert (settings.method, settings.supersampling) == ("mip", 1)
    assert PRESETS["balanced"].is_in(settings)


@pytest.mark.parametrize("pixels", [0.3, 2.5, 9.0])
def test_a_disc_covers_its_area_under_the_pixels_gaussian(pixels, scene, add_camera, add_surfels, picture):
    """Of any size; a hard-edged picture of the smallest is empty or full."""
    for name in ("method", "supersampling"):
        scene.surfel_splatting.property_unset(name)
    add_camera((0, 0, 10), type="ORTHO", ortho_scale=32)
    add_surfels([(0.2, -0.1, 0)], size=pixels)
    alpha = picture()[..., 3]
    assert alpha.sum() == pytest.approx(np.pi * pixels**2, rel=0.05, abs=0.3)
    assert np.unique(alpha).size > 6
