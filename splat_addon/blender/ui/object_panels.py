# SPDX-License-Identifier: GPL-3.0-or-later
"""Panel for an object's ray visibility, which Blender's Visibility panel does not show for other engines."""

from __future__ import annotations

import bpy

from ..geometry.sources import has_surfaces, is_surfel_object
from .engine_panel import EnginePanel


class OBJECT_PT_surfel_visibility(EnginePanel, bpy.types.Panel):
    bl_label = "Ray Visibility"
    bl_context = "object"
    bl_parent_id = "OBJECT_PT_visibility"

    @classmethod
    def poll(cls, context):
        owner = context.object
        return super().poll(context) and owner is not None and (has_surfaces(owner) or is_surfel_object(owner))

    def draw(self, context):
        super().draw(context)
        column = self.layout.column()
        column.prop(context.object, "visible_camera", text="Camera")
        column.prop(context.object, "visible_shadow", text="Shadow")


register, unregister = bpy.utils.register_classes_factory((OBJECT_PT_surfel_visibility,))
