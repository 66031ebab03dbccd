# SPDX-License-Identifier: GPL-3.0-or-later
"""Object > Convert Points to Surfels: turns the points of each selected mesh or point cloud into a surfel object."""

from __future__ import annotations

import bpy

from ..conversion.points_conversion import PointsBatch
from ..conversion.points_settings import (
    PointsConversionProperties,
    draw_gaussian_properties,
    draw_points_properties,
    keywords,
    viewpoint,
)
from ..geometry.points_extraction import has_points
from ..ids import SURFELS_FROM_POINTS
from ..spoken import said
from .menu_entry import with_menu_entry
from .modal_conversion import ModalConversion, was_converted


def selected_points(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The objects that the operator converts: point clouds, and meshes that are not surfels already."""
    return [source for source in context.selected_objects if has_points(source)]


class OBJECT_OT_surfels_from_points(PointsConversionProperties, ModalConversion, bpy.types.Operator):
    """Make a surfel from every point of the selected point clouds and meshes. Missing normals, sizes and \
directions are estimated from neighbouring points"""

    bl_idname = SURFELS_FROM_POINTS
    bl_label = "Convert Points to Surfels"
    bl_options = {"REGISTER", "UNDO", "PRESET"}  # noqa: RUF012 - Blender reads a set

    kind = "POINTS"

    @classmethod
    def poll(cls, context):
        if context.mode != "OBJECT":
            cls.poll_message_set(said("Points are converted in object mode; leave the current mode first"))
        elif not (selected_points(context) or was_converted(context)):
            cls.poll_message_set(said("Select a point cloud, or a mesh that is not surfels already"))
        else:
            return True
        return False

    def draw(self, context):
        draw_points_properties(self.layout, self)
        draw_gaussian_properties(self.layout, self)
        for name in ("source", "follow"):
            self.layout.prop(self, name)

    def _new_batch(self, context):
        return PointsBatch(
            selected_points(context), keywords(self), lambda: viewpoint(self, context.scene), self.flatness
        )


def draw_points_menu_entry(menu, context):
    menu.layout.operator(SURFELS_FROM_POINTS)


register, unregister = with_menu_entry(
    OBJECT_OT_surfels_from_points, bpy.types.VIEW3D_MT_object, draw_points_menu_entry
)
