# SPDX-License-Identifier: GPL-3.0-or-later
"""The entries of `depsgraph.object_instances`, of which there may be many thousands: what they all have is read at
once, and they are of few kinds, of which everything else is found once."""

from __future__ import annotations

import bpy
import numpy as np


def matrices_of(depsgraph: bpy.types.Depsgraph) -> np.ndarray:
    """(n, 4, 4) float32 `matrix_world` of each, which may have numbers that are not finite."""
    entries = depsgraph.object_instances
    numbers = np.empty(16 * len(entries), np.float32)
    entries.foreach_get("matrix_world", numbers)
    # Blender stores columns
    return numbers.reshape(-1, 4, 4).transpose(0, 2, 1)


def kind_of(entry: bpy.types.DepsgraphObjectInstance) -> tuple:
    """A key that is equal for entries that differ in their places only, while they are iterated over.

    The object of an entry may be a temporary one, the same for all, to which Blender gives the data of each.
    """
    object_, instancer = entry.object, entry.parent if entry.is_instance else None
    return (
        object_.original.session_uid,
        object_.data.as_pointer() if object_.data else 0,
        instancer.original.session_uid if instancer else None,
    )
