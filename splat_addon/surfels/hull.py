# SPDX-License-Identifier: GPL-3.0-or-later
"""A hull around all ellipses of a set, tighter than its box."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .surfels import Surfels

#: Cells along each edge of the lattice of `local_hull`, and surfels that are put into it at a time.
_HULL_CELLS = 16
_HULL_AT_ONCE = 1 << 18


def local_hull(surfels: Surfels) -> np.ndarray:
    """(n, 3) float64 positions whose convex hull holds all ellipses.

    They are corners of boxes, one around the centres in each row of a lattice, enlarged by the longest half-axis.
    """
    low, high = surfels.local_bounds
    if not len(surfels):
        return np.empty((0, 3))
    low, high = low + surfels.largest, high - surfels.largest
    cell = np.maximum(high - low, 1e-30) / _HULL_CELLS
    is_full = np.zeros((_HULL_CELLS,) * 3, bool)
    for start in range(0, len(surfels), _HULL_AT_ONCE):
        # What overflows in a lattice of huge extent is in its first or last cells.
        with np.errstate(over="ignore", invalid="ignore"):
            places = (surfels.positions[start : start + _HULL_AT_ONCE] - np.float32(low)) * np.float32(1 / cell)
        is_full[tuple(np.clip(np.nan_to_num(places), 0, _HULL_CELLS - 1).astype(np.int32).T)] = True
    y, z = np.nonzero(is_full.any(axis=0))
    rows = is_full[:, y, z]
    first = np.stack([rows.argmax(axis=0), y, z], axis=1)
    last = np.stack([_HULL_CELLS - rows[::-1].argmax(axis=0), y + 1, z + 1], axis=1)
    ends = low + first * cell - surfels.largest, low + last * cell + surfels.largest
    corners = [np.stack([ends[k >> axis & 1][:, axis] for axis in range(3)], axis=1) for k in range(8)]
    return np.concatenate(corners)
