# SPDX-License-Identifier: GPL-3.0-or-later
"""Which material each slot of an evaluated object has."""

from __future__ import annotations

import bpy


def slot_materials(evaluated: bpy.types.Object, mesh: bpy.types.Mesh) -> list[bpy.types.Material | None]:
    """The mesh's materials, which Geometry Nodes may have set, overridden by slots that the object owns."""
    slots = evaluated.material_slots
    materials = list(mesh.materials) + [slot.material for slot in slots[len(mesh.materials) :]]
    return [slots[k].material if k < len(slots) and slots[k].link == "OBJECT" else m for k, m in enumerate(materials)]
