# SPDX-License-Identifier: GPL-3.0-or-later
"""A preset sets the render settings that it names, in one step of undo, and its description says what it is for."""

import bpy
import pytest

from splat_addon.blender.properties import final_settings
from splat_addon.rendering import PRESETS, Settings
from splat_addon.rendering.settings import OUTPUTS

every_preset = pytest.mark.parametrize("preset", PRESETS.values(), ids=PRESETS)


@every_preset
def test_a_preset_is_what_the_next_render_uses(preset):
    scene = bpy.context.scene
    settings = scene.surfel_splatting
    settings.method, settings.supersampling, settings.epsilon = "ewa", 7, 0.75
    assert not preset.is_in(settings)
    assert bpy.ops.render.surfel_preset(preset=preset.name) == {"FINISHED"}
    assert preset.is_in(settings)
    used = final_settings(scene.view_layers[0], scene, OUTPUTS)
    assert preset.is_in(used) and used.epsilon == pytest.approx(0.75)


@every_preset
def test_a_preset_is_undone_in_one_step(preset):
    settings = bpy.context.scene.surfel_splatting
    settings.method, settings.supersampling = "ewa", 7
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.render.surfel_preset("EXEC_DEFAULT", True, preset=preset.name)
    bpy.ops.ed.undo()
    settings = bpy.context.scene.surfel_splatting
    assert (settings.method, settings.supersampling) == ("ewa", 7)


@every_preset
def test_a_preset_says_what_it_is_for(preset):
    items = bpy.ops.render.surfel_preset.get_rna_type().properties["preset"].enum_items
    text = items[preset.name].description
    assert text == preset.summary and len(text.split()) >= 8


def test_presets_are_different_choices():
    assert len({preset.of(Settings()) for preset in PRESETS.values()}) == len(PRESETS)


def test_an_unknown_preset_is_refused():
    with pytest.raises(TypeError, match="not found in"):
        bpy.ops.render.surfel_preset(preset="fastest")
