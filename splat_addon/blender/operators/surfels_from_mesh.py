# SPDX-License-Identifier: GPL-3.0-or-later
"""Object > Convert to Surfels: converts the selection to surfel objects in the same place."""

from __future__ import annotations

import bpy

from ..conversion.batch import ConversionBatch
from ..conversion.mesh_settings import ConversionProperties, choices
from ..conversion.mesh_settings_layout import draw_properties
from ..geometry.sources import has_surfaces
from ..ids import SURFELS_FROM_MESH
from ..spoken import said
from .menu_entry import with_menu_entry
from .modal_conversion import ModalConversion, was_converted


def selected_sources(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The objects that the operator converts: everything that may show a surface and is not surfels already."""
    return [source for source in context.selected_objects if has_surfaces(source)]


class OBJECT_OT_surfels_from_mesh(ConversionProperties, ModalConversion, bpy.types.Operator):
    """Convert the selected objects, with their modifiers, to surfel objects in exactly the same place. It converts \
meshes, curves, texts, metaballs, and the instances of Geometry Nodes and collections"""

    bl_idname = SURFELS_FROM_MESH
    bl_label = "Convert to Surfels"
    bl_options = {"REGISTER", "UNDO", "PRESET"}  # noqa: RUF012 - Blender reads a set

    @classmethod
    def poll(cls, context):
        if context.mode != "OBJECT":
            cls.poll_message_set(said("Objects are converted in object mode; leave the current mode first"))
        elif not (selected_sources(context) or was_converted(context)):
            cls.poll_message_set(
                said("Select a mesh object, curve, text, metaball or collection instance, not surfels already")
            )
        else:
            return True
        return False

    kind = "MESH"

    def draw(self, context):
        draw_properties(self.layout, self)

    def _new_batch(self, context):
        return ConversionBatch(selected_sources(context), choices(self), context.active_object)


def draw_menu_entry(menu, context):
    menu.layout.separator()
    menu.layout.operator(SURFELS_FROM_MESH)


register, unregister = with_menu_entry(OBJECT_OT_surfels_from_mesh, bpy.types.VIEW3D_MT_object, draw_menu_entry)
