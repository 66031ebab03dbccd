# SPDX-License-Identifier: GPL-3.0-or-later
"""Transparent surfels and materials as a user renders them, beside Cycles."""

import numpy as np
import pytest

WHITE_GLASS = (1, 1, 1, 0.5)


def test_surfels_of_half_opacity_show_half_of_what_is_behind(scene, add_camera, add_sheet, picture):
    add_camera()
    add_sheet(side=8, count=30, colors=WHITE_GLASS)
    add_sheet(side=8, count=30, colors=(1, 0, 0, 1)).location.z = -1
    for method in ("quad", "mip"):
        scene.surfel_splatting.method = method
        np.testing.assert_allclose(picture()[8:24, 8:24], np.broadcast_to((1, 0.5, 0.5, 1), (16, 16, 4)), atol=1e-5)


def test_layers_are_as_many_as_the_user_says(scene, add_camera, add_sheet, picture):
    add_camera(type="ORTHO", ortho_scale=4)
    for z in range(4):
        add_sheet(side=8, count=30, colors=WHITE_GLASS).location.z = -z
    properties = scene.surfel_splatting
    for layers, blends_rest, alpha in (
        (2, False, 0.75),
        (3, False, 0.875),
        (2, True, 1 - 0.5**4),
        (8, True, 1 - 0.5**4),
    ):
        properties.layers, properties.blends_rest = layers, blends_rest
        np.testing.assert_allclose(picture()[8:24, 8:24, 3], alpha, atol=1e-4)


@pytest.mark.parametrize("threshold", [0.0, 0.5, 0.9])
def test_depth_is_as_cycles_has_it_behind_what_is_transparent(scene, add_camera, add_sheet, passes, threshold):
    """The view layer's Alpha Threshold says how opaque a surface must be to have a depth."""
    add_camera()
    add_sheet(side=8, count=30, colors=(1, 1, 1, 0.4)).location.z = 1
    add_sheet(side=8, count=30, colors=(1, 1, 1, 0.8))
    add_sheet(side=8, count=30).location.z = -1
    scene.view_layers[0].use_pass_z = True
    scene.view_layers[0].pass_alpha_threshold = threshold
    depth = passes()["ViewLayer.Depth"]
    np.testing.assert_allclose(depth[8:24, 8:24], {0.0: 9, 0.5: 10, 0.9: 11}[threshold], atol=1e-3)


def test_a_sprite_method_says_that_it_draws_what_is_transparent_opaque(scene, add_camera, add_sheet, picture):
    from splat_addon.blender.final_render import last_frame_stats

    add_camera()
    add_sheet(side=8, count=30, colors=WHITE_GLASS)
    scene.surfel_splatting.method = "affine_unfiltered"
    assert picture()[16, 16, 3] == 1
    assert any("drawn opaque" in note for note in last_frame_stats["notes"])
