# SPDX-License-Identifier: GPL-3.0-or-later
"""View layer settings beyond those that Blender's Filter panel shows for other engines."""

from __future__ import annotations

import bpy

from ..doors import register_classes_factory
from .engine_panel import EnginePanel


class VIEWLAYER_PT_surfel_filter(EnginePanel, bpy.types.Panel):
    bl_label = "Filter"
    bl_context = "view_layer"
    bl_options = frozenset({"DEFAULT_CLOSED"})

    def draw(self, context):
        super().draw(context)
        view_layer = context.view_layer
        column = self.layout.column(heading="Include")
        column.prop(view_layer, "use_sky", text="Environment")
        column.prop(view_layer, "use_solid", text="Surfaces")
        row = self.layout.column(heading="Use").row()
        row.active = context.scene.render.use_motion_blur
        row.prop(view_layer, "use_motion_blur", text="Motion Blur")


class VIEWLAYER_PT_surfel_override(EnginePanel, bpy.types.Panel):
    """The material override, as in Blender's own panel, which before 5.0 exists for Cycles only."""

    bl_label = "Override"
    bl_context = "view_layer"
    bl_options = frozenset({"DEFAULT_CLOSED"})

    @classmethod
    def poll(cls, context):
        return super().poll(context) and not hasattr(bpy.types, "VIEWLAYER_PT_override")

    def draw(self, context):
        super().draw(context)
        for name in ("material_override", "world_override", "samples"):
            self.layout.prop(context.view_layer, name)


register, unregister = register_classes_factory((VIEWLAYER_PT_surfel_filter, VIEWLAYER_PT_surfel_override))
