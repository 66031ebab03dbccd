# SPDX-License-Identifier: GPL-3.0-or-later
"""Presets of one's own, by Blender's own preset system, in the headers of the render's and the conversion's panels.

Each is a file in the user's presets folder. The conversion's operators have theirs in Adjust Last Operation besides.
"""

from __future__ import annotations

import bpy
from bl_operators.presets import AddPresetBase
from bl_ui.utils import PresetPanel

from ..conversion.mesh_settings import PROPERTY_NAMES
from ..ids import ADD_CONVERSION_PRESET, ADD_RENDER_PRESET, CONVERSION_SETTINGS, RENDER_SETTINGS
from ..properties import SurfelSplattingSettings

#: A choice that a preset cannot hold: an image of this file.
_OF_THIS_FILE = frozenset({"matcap"})

_FOLDER = "surfel_splatting"


class RENDER_PT_surfel_presets(PresetPanel, bpy.types.Panel):
    bl_label = "Surfel Splatting Presets"
    preset_subdir = f"{_FOLDER}/render"
    preset_operator = "script.execute_preset"
    preset_add_operator = ADD_RENDER_PRESET


class RENDER_OT_surfel_preset_add(AddPresetBase, bpy.types.Operator):
    """Add a preset of all render settings of Surfel Splatting, or remove one"""

    bl_idname = ADD_RENDER_PRESET
    bl_label = "Add Surfel Splatting Preset"
    preset_menu = "RENDER_PT_surfel_presets"
    preset_subdir = RENDER_PT_surfel_presets.preset_subdir
    preset_defines = [f"settings = bpy.context.scene.{RENDER_SETTINGS}"]  # noqa: RUF012 - Blender reads a list

    @property
    def preset_values(self):
        return [f"settings.{name}" for name in _own_names(SurfelSplattingSettings)]


class VIEW3D_PT_surfel_conversion_presets(PresetPanel, bpy.types.Panel):
    bl_label = "Surfel Conversion Presets"
    preset_subdir = f"{_FOLDER}/conversion"
    preset_operator = "script.execute_preset"
    preset_add_operator = ADD_CONVERSION_PRESET


class OBJECT_OT_surfel_conversion_preset_add(AddPresetBase, bpy.types.Operator):
    """Add a preset of the conversion settings in the sidebar, or remove one"""

    bl_idname = ADD_CONVERSION_PRESET
    bl_label = "Add Surfel Conversion Preset"
    preset_menu = "VIEW3D_PT_surfel_conversion_presets"
    preset_subdir = VIEW3D_PT_surfel_conversion_presets.preset_subdir
    preset_defines = [f"settings = bpy.context.scene.{CONVERSION_SETTINGS}"]  # noqa: RUF012 - Blender reads a list
    preset_values = [f"settings.{name}" for name in PROPERTY_NAMES]  # noqa: RUF012 - Blender reads a list


def _own_names(group: type[bpy.types.PropertyGroup]) -> list[str]:
    """The properties of a group that a file of presets can hold; choices last, which setting a number may change."""
    every = sorted(group.bl_rna.properties, key=lambda p: p.type == "ENUM")
    return [p.identifier for p in every if not p.is_readonly and p.identifier not in {"name", *_OF_THIS_FILE}]


register, unregister = bpy.utils.register_classes_factory(
    (
        RENDER_PT_surfel_presets,
        RENDER_OT_surfel_preset_add,
        VIEW3D_PT_surfel_conversion_presets,
        OBJECT_OT_surfel_conversion_preset_add,
    )
)
