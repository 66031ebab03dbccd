# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that applies a measured preset to the render settings, and the buttons that call it."""

from __future__ import annotations

import bpy
from bpy.props import EnumProperty

from ...rendering.presets import PRESETS
from ..doors import register_classes_factory
from ..ids import RENDER_PRESET, RENDER_SETTINGS


class RENDER_OT_surfel_preset(bpy.types.Operator):
    bl_idname = RENDER_PRESET
    bl_label = "Surfel Splatting Preset"
    bl_description = "Choose method and samples together"
    bl_options = frozenset({"REGISTER", "UNDO", "INTERNAL"})

    preset: EnumProperty(
        name="Preset",
        description="The balance between speed and accuracy",
        items=[(preset.name, preset.label, preset.summary) for preset in PRESETS.values()],
    )

    @classmethod
    def description(cls, context, properties):
        return PRESETS[properties.preset].summary

    def execute(self, context):
        settings = getattr(context.scene, RENDER_SETTINGS)
        for name, value in PRESETS[self.preset].render_values.items():
            setattr(settings, name, value)
        return {"FINISHED"}


def draw_presets(layout: bpy.types.UILayout, settings) -> None:
    """A row of buttons; the one whose values are set is shown pressed."""
    row = layout.row(align=True)
    for preset in PRESETS.values():
        button = row.operator(RENDER_PRESET, text=preset.label, depress=preset.is_in(settings))
        button.preset = preset.name


register, unregister = register_classes_factory((RENDER_OT_surfel_preset,))
