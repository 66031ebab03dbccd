# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels for the toon shading and the lines of a material and of an object."""

from __future__ import annotations

import bpy

from ..doors import register_classes_factory
from ..geometry.sources import has_surfaces, is_surfel_object
from ..ids import MATERIAL_SETTINGS, OBJECT_SETTINGS
from ..style_properties import draw_style
from .engine_panel import EnginePanel


class MATERIAL_PT_surfel_style(EnginePanel, bpy.types.Panel):
    bl_label = "Toon and Lines"
    bl_context = "material"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 - Blender reads a set

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.material is not None

    def draw(self, context):
        super().draw(context)
        draw_style(self.layout, getattr(context.material, MATERIAL_SETTINGS))


class OBJECT_PT_surfel_style(EnginePanel, bpy.types.Panel):
    bl_label = "Toon and Lines"
    bl_context = "object"
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 - Blender reads a set

    @classmethod
    def poll(cls, context):
        owner = context.object
        return super().poll(context) and owner is not None and (has_surfaces(owner) or is_surfel_object(owner))

    def draw(self, context):
        super().draw(context)
        draw_style(self.layout, getattr(context.object, OBJECT_SETTINGS).style)


register, unregister = register_classes_factory((MATERIAL_PT_surfel_style, OBJECT_PT_surfel_style))
