# SPDX-License-Identifier: GPL-3.0-or-later
"""The passes of a view layer: Blender's own settings for those that this engine supports, and settings for our
own passes.
"""

from __future__ import annotations

import bpy

from ..doors import register_classes_factory
from ..engine.render_passes import ViewLayerPasses
from ..ids import LAYER_SETTINGS
from .engine_panel import EnginePanel

#: heading -> the properties under it
_SWITCHES = {
    "Data": ("use_pass_z", "use_pass_position", "use_pass_normal"),
    "Index": ("use_pass_object_index", "use_pass_material_index"),
    "Light": ("use_pass_diffuse_color", "use_pass_emit", "use_pass_shadow"),
    "Splats": ("use_pass_coverage", "use_pass_overdraw"),
}


class VIEWLAYER_PT_surfel_passes(EnginePanel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context):
        super().draw(context)
        layout, view_layer = self.layout, context.view_layer
        for heading, flags in _SWITCHES.items():
            column = layout.column(heading=heading)
            for flag in flags:
                is_ours = flag in ViewLayerPasses.__annotations__
                column.prop(getattr(view_layer, LAYER_SETTINGS) if is_ours else view_layer, flag)
        layout.prop(view_layer, "pass_alpha_threshold")
        column = layout.column(heading="Cryptomatte")
        column.prop(view_layer, "use_pass_cryptomatte_object")
        levels = layout.column()
        levels.active = view_layer.use_pass_cryptomatte_object
        levels.prop(view_layer, "pass_cryptomatte_depth", text="Levels")


register, unregister = register_classes_factory((VIEWLAYER_PT_surfel_passes,))
