# SPDX-License-Identifier: GPL-3.0-or-later
"""The operator that lets a scene show scans as they were captured."""

from __future__ import annotations

import bpy

from ..doors import register_classes_factory
from ..ids import ENGINE_LABEL, SCAN_LOOK
from ..scan_look import VIEW_TRANSFORM, give_scan_look


class RENDER_OT_surfel_scan_look(bpy.types.Operator):
    bl_idname = SCAN_LOOK
    bl_label = "Scan Look"
    bl_description = (
        f"Show scans as they were captured, without any light: choose {ENGINE_LABEL}, Captured Color, Eye-Dome "
        f"Lighting and the view transform {VIEW_TRANSFORM}"
    )
    bl_options = frozenset({"REGISTER", "UNDO"})

    def execute(self, context):
        self.report({"INFO"}, give_scan_look(context.scene))
        return {"FINISHED"}


register, unregister = register_classes_factory((RENDER_OT_surfel_scan_look,))
