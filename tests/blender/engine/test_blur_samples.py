# SPDX-License-Identifier: GPL-3.0-or-later
"""A final render with depth of field or motion blur takes enough samples to show the blur, even if Samples is 1."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.engine import final_render
from splat_addon.blender.ui import report_panel


@pytest.fixture
def blurred(scene, add_camera, add_surfels):
    """A disc seen through a lens that blurs it; Blur Samples has its default."""
    made = add_camera()
    made.data.dof.use_dof, made.data.dof.focus_distance, made.data.dof.aperture_fstop = True, 5, 0.05
    add_surfels([(0, 0, 0)], size=1.0)
    scene.surfel_splatting.property_unset("blur_samples")
    return made


def test_depth_of_field_takes_samples_by_itself(scene, blurred, picture, said):
    seen = picture()
    assert final_render.last_frame_stats["samples"] == 16
    assert np.unique(seen[..., 3]).size > 8 and "Depth of field" not in said()
    scene.surfel_splatting.blur_samples = 1
    assert not np.array_equal(picture(), seen)
    assert "Depth of field needs Samples above 1" in said()


def test_motion_blur_takes_samples_by_itself(scene, blurred, picture):
    blurred.data.dof.use_dof, scene.render.use_motion_blur = False, True
    picture()
    assert final_render.last_frame_stats["samples"] == 16


def test_more_samples_stay_more_and_a_sharp_picture_takes_one(scene, blurred, picture):
    scene.surfel_splatting.samples = 32
    picture()
    assert final_render.last_frame_stats["samples"] == 32
    blurred.data.dof.use_dof, scene.surfel_splatting.samples = False, 1
    picture()
    assert "samples" not in final_render.last_frame_stats


def test_the_panel_tells_what_was_drawn(scene, blurred, picture):
    blurred.data.dof.use_dof = False
    picture()
    lines = list(report_panel.measured(final_render.last_frame_stats))
    assert lines[0] == "Drawn: 1 of 1 splats, and 0 polygons" and lines[1].startswith("Time: ")
    megabytes = final_render.last_frame_stats["texture_bytes"] / 1e6
    assert 0.05 < megabytes < 20 and lines[2] == f"Textures on the device: {megabytes:,.1f} MB"
    assert list(report_panel.measured({})) == ["Nothing has been rendered yet"]
    assert hasattr(bpy.types, "RENDER_PT_surfel_report_plan")


def test_the_panel_tells_what_was_left_out(scene, add_camera, add_surfels, picture):
    """One of four splats is in view, and two others of the four face away."""
    add_camera()
    away = np.array([(50, 0, 0), (0, 50, 0), (0, -50, 0)])
    for place, normal in zip([(0, 0, 0), *away], [(0, 0, 1), (0, 0, 1), (0, 0, -1), (0, 0, -1)], strict=True):
        add_surfels([place], normal, name=str(place))
    scene.surfel_splatting.culls_backs = True
    picture()
    lines = list(report_panel.measured(final_render.last_frame_stats))
    assert lines[:2] == ["Drawn: 1 of 1 splats, and 0 polygons", "Back-facing splats left out: 2 (50%)"]
