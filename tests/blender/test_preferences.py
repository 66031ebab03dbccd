# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on's preferences are obeyed: the memory of a picture, and the conversion settings of new scenes."""

import bpy
import pytest

from splat_addon.blender import preferences
from splat_addon.blender.conversion.mesh_settings import PROPERTY_NAMES
from tests.blender.engine.conftest import *  # noqa: F403 - a scene that is rendered


@pytest.fixture
def chosen(add_on, empty_file):
    """The add-on's preferences, stored where Blender keeps those of an enabled add-on."""
    bpy.context.preferences.addons.new().module = preferences.ROOT
    yield bpy.context.preferences.addons[preferences.ROOT].preferences
    bpy.context.preferences.addons.remove(bpy.context.preferences.addons[preferences.ROOT])


def test_without_preferences_nothing_is_bounded(empty_file):
    assert preferences.preferences() is None and preferences.most_bytes() is None


def test_a_render_that_needs_more_memory_stops_and_says_so(chosen, scene, add_camera, add_surfels, picture):
    add_camera()
    add_surfels([(0, 0, 0)], size=1.0)
    scene.render.resolution_x = scene.render.resolution_y = 400
    chosen.most_megabytes = 1
    with pytest.raises(RuntimeError, match="needs more than 1 MB of the graphics device"):
        picture()
    chosen.most_megabytes = 100
    bounded = picture()
    chosen.most_megabytes = 0
    assert (picture() == bounded).all() and bounded.any()


def test_a_new_file_converts_with_the_preferences_and_one_with_a_choice_of_its_own_does_not(chosen, tmp_path):
    chosen.conversion.density, chosen.conversion.resolution = "RESOLUTION", 77
    file = str(tmp_path / "own.blend")
    bpy.context.scene.surfel_conversion.resolution = 33
    bpy.ops.wm.save_as_mainfile(filepath=file)
    bpy.ops.wm.read_homefile(app_template="", use_empty=True)
    settings = bpy.context.scene.surfel_conversion
    assert (settings.density, settings.resolution) == ("RESOLUTION", 77)
    assert not settings.is_property_set("spacing")
    bpy.ops.wm.open_mainfile(filepath=file)
    settings = bpy.context.scene.surfel_conversion
    assert (settings.density, settings.resolution) == ("AUTOMATIC", 33)


def test_the_preferences_have_every_setting_of_the_conversion(chosen):
    assert set(PROPERTY_NAMES) <= {p.identifier for p in chosen.conversion.bl_rna.properties}


def test_the_device_is_named_or_said_to_be_missing():
    lines = preferences.device_lines()
    assert len(lines) == 2 or "no graphics context here" in lines[0]
