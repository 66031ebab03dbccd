# SPDX-License-Identifier: GPL-3.0-or-later
"""Panels for how an object is drawn, for a scan's colours, and for ray visibility, which Blender's Visibility panel
does not show for other engines."""

from __future__ import annotations

import bpy

from ..doors import register_classes_factory
from ..geometry.sources import has_surfaces, is_surfel_object
from ..ids import OBJECT_SETTINGS
from ..mesh_sampling_settings import SPLIT_BY
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
        column.prop(context.object, "visible_glossy", text="Glossy")
        column.prop(context.object, "visible_shadow", text="Shadow")


class OBJECT_PT_surfel_splatting(EnginePanel, bpy.types.Panel):
    bl_label = "Surfel Splatting"
    bl_context = "object"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.object is not None and has_surfaces(context.object)

    def draw(self, context):
        super().draw(context)
        settings = getattr(context.object, OBJECT_SETTINGS)
        self.layout.prop(settings, "render_as")
        if settings.render_as == "GROUP":
            self.layout.prop_search(settings, "split_group", context.object, "vertex_groups")
        elif name := SPLIT_BY.get(settings.render_as):
            self.layout.prop(settings, name)
        self.layout.prop(settings, "detail")


class OBJECT_PT_surfel_colors(EnginePanel, bpy.types.Panel):
    bl_label = "Scan Colors"
    bl_context = "object"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.object is not None and is_surfel_object(context.object)

    def draw(self, context):
        super().draw(context)
        settings = getattr(context.object, OBJECT_SETTINGS)
        self.layout.prop(settings, "color_by")
        if settings.color_by == "ATTRIBUTE":
            self.layout.prop_search(settings, "color_attribute", context.object.data, "attributes")
        if settings.color_by == "COLOR":
            return
        self.layout.prop(settings, "color_is_automatic")
        ends = self.layout.column(align=True)
        ends.active = not settings.color_is_automatic
        ends.prop(settings, "color_from")
        ends.prop(settings, "color_to")
        self.layout.template_ID(settings, "color_ramp", new="texture.new")
        if settings.color_ramp is not None:
            self.layout.prop(settings.color_ramp, "use_color_ramp", text="Ramp")
            if settings.color_ramp.use_color_ramp:
                self.layout.template_color_ramp(settings.color_ramp, "color_ramp")


register, unregister = register_classes_factory(
    (OBJECT_PT_surfel_visibility, OBJECT_PT_surfel_splatting, OBJECT_PT_surfel_colors)
)
