# SPDX-License-Identifier: GPL-3.0-or-later
"""Panel for a panoramic camera's projection, which Blender's Lens panel only shows for Cycles."""

from __future__ import annotations

import bpy

from ..cameras import PANORAMA_PROPERTIES
from ..doors import register_classes_factory
from .engine_panel import EnginePanel


class DATA_PT_surfel_panorama(EnginePanel, bpy.types.Panel):
    bl_label = "Panorama"
    bl_context = "data"
    bl_parent_id = "DATA_PT_lens"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.camera is not None and context.camera.type == "PANO"

    def draw(self, context):
        super().draw(context)
        camera = context.camera
        self.layout.prop(camera, "panorama_type")
        names = PANORAMA_PROPERTIES.get(camera.panorama_type)
        if names is None:
            self.layout.label(text="Only for Cycles; choose another type", icon="ERROR")
        column = self.layout.column(align=True)
        for name in names or ():
            column.prop(camera, name)


register, unregister = register_classes_factory((DATA_PT_surfel_panorama,))
