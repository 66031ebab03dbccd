# SPDX-License-Identifier: GPL-3.0-or-later
"""How evaluated objects are read: the mesh for as long as it is valid, the slots, and values as whole arrays."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy
import numpy as np


@contextmanager
def readable_mesh(evaluated: bpy.types.Object) -> Iterator[bpy.types.Mesh]:
    """The mesh of an evaluated mesh object or instance, whether or not it is subdivided on the graphics card."""
    try:
        yield evaluated.to_mesh()
    finally:
        evaluated.to_mesh_clear()


def read_values(collection, key: str, width: int, count: int, dtype=np.float32) -> np.ndarray:
    """(count, width), or (count,) for width 1, from one `foreach_get`."""
    values = np.empty(count * width, dtype)
    if count:
        collection.foreach_get(key, values)
    return values.reshape(count, width) if width > 1 else values


def own_materials(evaluated: bpy.types.Object) -> list[bpy.types.Material | None]:
    """The materials of an evaluated object's slots. A slot that belongs to the object and is empty has none, as in
    Cycles: the evaluated one shows the mesh's there."""
    given = evaluated.original.material_slots

    def is_emptied(k: int) -> bool:
        return k < len(given) and given[k].link == "OBJECT" and given[k].material is None

    return [None if is_emptied(k) else slot.material for k, slot in enumerate(evaluated.material_slots)]
