# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds the modifier that leaves out surfels beyond a box, of some classes, or closer together than a spacing."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ..doors import register_classes_factory
from ..geometry.attributes import has_surfels
from ..geometry.scan_filter import add_filter
from ..geometry.stored_surfels import read_field
from ..geometry.surfel_files import file_of
from ..ids import FILTER_SCAN, POINT_ATTRIBUTES
from ..spoken import said

#: How much larger the box is than the scan.
_ROOM = 1.01


class OBJECT_OT_surfels_filter(bpy.types.Operator):
    """Add a modifier that crops the surfels by a box, hides classes and thins to a spacing. Nothing stored changes"""

    bl_idname = FILTER_SCAN
    bl_label = "Filter Scan"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 - Blender reads a set

    @classmethod
    def poll(cls, context):
        owner = context.active_object
        is_mesh = context.mode == "OBJECT" and owner is not None and owner.type == "MESH"
        if is_mesh and has_surfels(owner.data) and not file_of(owner):
            return True
        cls.poll_message_set(said("Select an object whose surfels are in the .blend, in Object Mode"))
        return False

    def execute(self, context):
        made = context.active_object
        add_filter(made, _box_around(made))
        return {"FINISHED"}


def _box_around(made: bpy.types.Object) -> bpy.types.Object:
    """A new empty around all surfels of an object, which it follows."""
    positions = read_field(made.data, POINT_ATTRIBUTES["positions"], made.name)
    finite = positions[np.isfinite(positions).all(axis=1)]
    low, high = (finite.min(axis=0), finite.max(axis=0)) if len(finite) else (-np.ones(3), np.ones(3))
    half = Vector(np.maximum((high - low) / 2 * _ROOM, 1e-6).tolist())
    box = bpy.data.objects.new(f"{made.name} box", None)
    box.empty_display_type = "CUBE"
    for collection in made.users_collection:
        collection.objects.link(box)
    box.parent = made
    box.matrix_basis = Matrix.LocRotScale(Vector(((low + high) / 2).tolist()), None, half)
    return box


register, unregister = register_classes_factory((OBJECT_OT_surfels_filter,))
