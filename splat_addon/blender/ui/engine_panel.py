# SPDX-License-Identifier: GPL-3.0-or-later
"""The common base of this engine's panels in the properties editor."""

from __future__ import annotations

from ..ids import ENGINE


class EnginePanel:
    """A base class beside `bpy.types.Panel`; `bl_context` names the panel's tab in the properties editor."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"

    @classmethod
    def poll(cls, context):
        return context.engine == ENGINE

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
