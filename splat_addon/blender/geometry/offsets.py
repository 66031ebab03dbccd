# SPDX-License-Identifier: GPL-3.0-or-later
"""What is added to the places of stored surfels, and other numbers that data-blocks keep as custom properties."""

from __future__ import annotations

import bpy
import numpy as np

from ..ids import OFFSET

#: Data-blocks whose points can be surfels.
Points = bpy.types.Mesh | bpy.types.PointCloud


def offset_of(mesh: bpy.types.ID) -> np.ndarray:
    """What is added to the positions of a surfel mesh of the .blend, (3,) float64. What modifiers make of the mesh has
    no such property, but the same offset."""
    return numbers_of(mesh, OFFSET, 3, np.zeros(3))


def numbers_of(owner: bpy.types.ID, name: str, count: int, otherwise: np.ndarray) -> np.ndarray:
    """(count,) float64 of a custom property, if it holds so many finite numbers."""
    values = np.ravel(owner.get(name, ()))
    is_known = values.shape == (count,) and np.issubdtype(values.dtype, np.number) and np.isfinite(values).all()
    return values.astype(np.float64) if is_known else otherwise
