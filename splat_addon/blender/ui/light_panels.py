# SPDX-License-Identifier: GPL-3.0-or-later
"""A light's Data tab with all properties that the engine uses; Blender's panel for other engines only shows the
type."""

from __future__ import annotations

import bpy

from ..doors import register_classes_factory
from ..ids import RENDER_SETTINGS
from ..materials.node_trees import has_switch
from .engine_panel import EnginePanel

#: light type -> the properties of its size, with the label of each
_SIZES = {
    "SUN": (("angle", "Angle"),),
    "POINT": (("shadow_soft_size", "Radius"),),
    "SPOT": (("shadow_soft_size", "Radius"),),
}
_AREA_SIZES = {
    "SQUARE": (("size", "Size"),),
    "DISK": (("size", "Size"),),
    "RECTANGLE": (("size", "Size X"), ("size_y", "Y")),
    "ELLIPSE": (("size", "Size X"), ("size_y", "Y")),
}


class _LightPanel(EnginePanel):
    bl_context = "data"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.light is not None


class DATA_PT_surfel_light(_LightPanel, bpy.types.Panel):
    bl_label = "Light"

    def draw(self, context):
        layout, light = self.layout, context.light
        layout.row().prop(light, "type", expand=True)
        layout.use_property_split = True

        row = layout.column(heading="Temperature").row(align=True)
        row.prop(light, "use_temperature", text="")
        value = row.row(align=True)
        value.active = light.use_temperature
        value.prop(light, "temperature", text="")
        layout.prop(light, "color", text="Tint" if light.use_temperature else "Color")

        column = layout.column()
        column.prop(light, "energy")
        column.prop(light, "exposure")
        column.prop(light, "normalize")

        column = layout.column(align=True)
        if light.type == "AREA":
            column.prop(light, "shape")
        for name, label in _AREA_SIZES[light.shape] if light.type == "AREA" else _SIZES[light.type]:
            column.prop(light, name, text=label)


class DATA_PT_surfel_light_beam(_LightPanel, bpy.types.Panel):
    bl_label = "Beam Shape"
    bl_parent_id = "DATA_PT_surfel_light"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.light.type == "SPOT"

    def draw(self, context):
        layout, light = self.layout, context.light
        layout.use_property_split = True
        layout.prop(light, "spot_size", text="Angle")
        layout.prop(light, "spot_blend", text="Blend", slider=True)
        layout.prop(light, "show_cone")


class DATA_PT_surfel_light_shadow(_LightPanel, bpy.types.Panel):
    bl_label = "Shadow"
    bl_parent_id = "DATA_PT_surfel_light"

    def draw_header(self, context):
        self.layout.prop(context.light, "use_shadow", text="")

    def draw(self, context):
        layout = self.layout
        layout.use_property_split = True
        layout.active = context.light.use_shadow
        layout.prop(getattr(context.scene, RENDER_SETTINGS), "shadow_resolution")
        layout.label(text="Shared by all lights", icon="INFO")


class DATA_PT_surfel_light_nodes(_LightPanel, bpy.types.Panel):
    bl_label = "Nodes"
    bl_options = frozenset({"DEFAULT_CLOSED"})

    def draw_header(self, context):
        if has_switch(context.light):
            self.layout.prop(context.light, "use_nodes", text="")

    def draw(self, context):
        layout, light = self.layout, context.light
        layout.use_property_split = True
        layout.active = not has_switch(light) or light.use_nodes
        tree = light.node_tree
        output = tree.get_output_node("ALL") if tree else None
        if output is None:
            layout.label(text="Its Emission node's colour and strength scale the light", icon="INFO")
        else:
            layout.template_node_view(tree, output, output.inputs["Surface"])


register, unregister = register_classes_factory(
    (DATA_PT_surfel_light, DATA_PT_surfel_light_beam, DATA_PT_surfel_light_shadow, DATA_PT_surfel_light_nodes)
)
