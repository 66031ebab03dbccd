# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels so large, small, far away or bright that float32 cannot hold the squares and sums that merging computes.

They never merge: in every level they wait for larger cells, and are drawn as they are.
"""

from __future__ import annotations

import numpy as np

from ..surfels import Surfels
from .nodes import Leaves, Table

#: Object units: the largest size and place, and the smallest size, of a surfel that may merge. Products of two of them
#: stay within float32, and so do sums of a million.
LARGEST, SMALLEST = 1e15, 1e-18
#: The largest colour, and the largest material: float32 counts no further.
BRIGHTEST, MOST_MATERIALS = 1e30, 1 << 24


def extreme(table: Table | Leaves) -> np.ndarray | None:
    """(n,) bool: which rows never merge; None if all may."""
    if not len(table):
        return None
    never = None
    limits = {"positions": LARGEST, "radii": LARGEST, "colors": BRIGHTEST, "materials": MOST_MATERIALS}
    for name, most in limits.items():
        values = table.column(name)
        if max(float(values.max()), -float(values.min())) > most:
            are_too_large = np.abs(np.atleast_2d(values).astype(np.float64)).max(axis=0) > most
            never = are_too_large if never is None else never | are_too_large
    areas = table.column("areas")
    if areas.min() < SMALLEST**2:
        are_too_small = areas < SMALLEST**2
        never = are_too_small if never is None else never | are_too_small
    return never


def has_extremes(surfels: Surfels) -> bool:
    """Whether any of a set never merge, so that a hierarchy that had them merged does not fit it any more."""
    return extreme(Leaves(surfels)) is not None
