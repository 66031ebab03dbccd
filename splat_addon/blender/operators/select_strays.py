# SPDX-License-Identifier: GPL-3.0-or-later
"""Selects surfels that stand alone or are too large, in edit mode, where they are seen before anything is deleted."""

from __future__ import annotations

import bpy
import numpy as np
from bpy.props import FloatProperty

from ...sampling.points.strayness import strayness
from ..doors import register_classes_factory
from ..fingerprints import of_array
from ..geometry.attributes import has_surfels
from ..geometry.stored_surfels import read_field
from ..geometry.surfel_files import file_of
from ..ids import POINT_ATTRIBUTES, SELECT_STRAYS
from ..spoken import said

#: What was found last, so that another strength needs no search: checksums of what was looked at, and how stray it is.
_last: tuple[list[str], np.ndarray] | None = None

_FIELDS = "positions", "scales", "normals"


def _how_stray(mesh: bpy.types.Mesh) -> np.ndarray:
    """(N,) `strayness` of the surfels of a mesh, whose unusable ones are as stray as can be."""
    global _last
    given = [read_field(mesh, POINT_ATTRIBUTES[name], mesh.name) for name in _FIELDS]
    told = list(map(of_array, given))
    if _last is None or _last[0] != told:
        positions, scales, normals = given
        radii, found = scales[:, :2].max(axis=1, initial=0.0), np.full(len(positions), np.inf)
        is_usable = np.isfinite(np.hstack(given)).all(axis=1) & (scales[:, :2] > 0).all(axis=1)
        found[is_usable] = strayness(positions[is_usable], radii[is_usable], normals[is_usable])
        _last = told, found
    return _last[1]


class OBJECT_OT_surfels_select_strays(bpy.types.Operator):
    """Select surfels that stand alone or are much larger than those around them, in Edit Mode; nothing is deleted"""

    bl_idname = SELECT_STRAYS
    bl_label = "Select Strays"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 - Blender reads a set

    strength: FloatProperty(
        name="Strength",
        description="Higher values select surfels that are less stray. 1 selects about what an import leaves out",
        min=0.01,
        soft_min=0.2,
        soft_max=5.0,
        max=100.0,
        default=1.0,
    )

    @classmethod
    def poll(cls, context):
        owner = context.active_object
        is_mesh = owner is not None and owner.type == "MESH" and context.mode in ("OBJECT", "EDIT_MESH")
        if is_mesh and has_surfels(owner.data):
            if not file_of(owner):
                return True
            # deleting some of the coarsest would change no picture
            cls.poll_message_set(said("Select an object whose surfels are in the .blend, in Object Mode"))
            return False
        cls.poll_message_set(said("Select an object of surfels, in Object Mode or Edit Mode"))
        return False

    def execute(self, context):
        owner = context.active_object
        if owner.mode == "EDIT":
            bpy.ops.object.mode_set(mode="OBJECT")  # which writes its points into the mesh
        mesh = owner.data
        is_stray = _how_stray(mesh) * self.strength > 1
        mesh.vertices.foreach_set("select", is_stray)
        context.tool_settings.mesh_select_mode = True, False, False
        bpy.ops.object.mode_set(mode="EDIT")
        count = said("Selected {count:,} of {all:,} surfels; X deletes them", count=is_stray.sum(), all=len(is_stray))
        self.report({"INFO"}, count)
        return {"FINISHED"}


register, unregister = register_classes_factory((OBJECT_OT_surfels_select_strays,))
