# SPDX-License-Identifier: GPL-3.0-or-later
"""Selects surfels that stand alone or are too large, in edit mode, where they are seen before anything is deleted."""

from __future__ import annotations

import bpy
import numpy as np
from bpy.props import FloatProperty

from ...sampling.points.strayness import strayness
from ..doors import register_classes_factory
from ..geometry.attributes import has_surfels, read_field
from ..ids import POINT_ATTRIBUTES, SELECT_STRAYS
from ..spoken import said

#: What was found last, so that another strength needs no search: positions, radii, how stray they are.
_last: tuple[np.ndarray, np.ndarray, np.ndarray] | None = None


def _how_stray(mesh: bpy.types.Mesh) -> np.ndarray:
    """(N,) `strayness` of the surfels of a mesh, whose unusable ones are as stray as can be."""
    global _last
    positions, scales = (read_field(mesh, POINT_ATTRIBUTES[name], mesh.name) for name in ("positions", "scales"))
    radii = scales[:, :2].max(axis=1, initial=0.0)
    if _last is None or not (np.array_equal(_last[0], positions) and np.array_equal(_last[1], radii)):
        found = np.full(len(positions), np.inf)
        is_usable = np.isfinite(positions).all(axis=1) & np.isfinite(radii) & (radii > 0)
        found[is_usable] = strayness(positions[is_usable], radii[is_usable])
        _last = positions, radii, found
    return _last[2]


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
            return True
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
