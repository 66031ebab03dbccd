# SPDX-License-Identifier: GPL-3.0-or-later
"""The second panel of the Surfels tab: converts bare points, and imports and exports files of surfels."""

from __future__ import annotations

import bpy

from ..doors import register_classes_factory
from ..geometry.scene_offset import scene_offset, shown
from ..ids import EXPORT_PLY, IMPORT_FILE, POINTS_PANEL, SIDEBAR_TAB, SURFELS_FROM_POINTS
from ..operators.surfels_from_points import selected_points
from ..spoken import said
from .wrapped_text import write


class VIEW3D_PT_surfels_from_points(bpy.types.Panel):
    bl_idname = POINTS_PANEL
    bl_label = "From Points and Files"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = SIDEBAR_TAB
    bl_options = {"DEFAULT_CLOSED"}  # noqa: RUF012 - Blender reads a set

    def draw(self, context):
        points = self.layout.row()
        # For surfels its poll is true, because Adjust Last Operation asks it before it undoes the conversion.
        points.enabled = bool(selected_points(context))
        points.operator(SURFELS_FROM_POINTS, icon="POINTCLOUD_POINT")
        row = self.layout.row(align=True)
        # "Invoke" asks for the file; a sidebar's own way would run at once.
        row.operator_context = "INVOKE_DEFAULT"
        row.operator(IMPORT_FILE, icon="IMPORT")
        row.operator(EXPORT_PLY, icon="EXPORT")
        offset = scene_offset(context.scene)
        if offset.any():
            write(self.layout, said("Offset of the coordinates: {offset}", offset=shown(offset)), context, "INFO")


register, unregister = register_classes_factory((VIEW3D_PT_surfels_from_points,))
