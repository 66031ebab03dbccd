# SPDX-License-Identifier: GPL-3.0-or-later
"""Which material each slot of an evaluated object has."""

from __future__ import annotations

import bpy

from ..geometry.reading import own_materials


def slot_materials(evaluated: bpy.types.Object, mesh: bpy.types.Mesh) -> list[bpy.types.Material | None]:
    """The mesh's materials, which Geometry Nodes may have set, overridden by slots that the object owns."""
    slots, own = evaluated.material_slots, own_materials(evaluated)
    materials = list(mesh.materials) + own[len(mesh.materials) :]
    return [own[k] if k < len(own) and slots[k].link == "OBJECT" else m for k, m in enumerate(materials)]
