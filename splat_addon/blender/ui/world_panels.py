# SPDX-License-Identifier: GPL-3.0-or-later
"""The sun of a world's picture: of EEVEE's settings for it, those that this engine uses."""

from __future__ import annotations

import bpy

from ..doors import register_classes_factory
from .engine_panel import EnginePanel


class WORLD_PT_surfel_sun(EnginePanel, bpy.types.Panel):
    bl_label = "Sun"
    bl_context = "world"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.world is not None

    def draw(self, context):
        super().draw(context)
        world = context.world
        self.layout.prop(world, "use_sun_shadow", text="Shadow")
        row = self.layout.row()
        row.active = world.use_sun_shadow
        row.prop(world, "sun_threshold", text="Threshold")


register, unregister = register_classes_factory((WORLD_PT_surfel_sun,))
