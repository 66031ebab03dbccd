# SPDX-License-Identifier: GPL-3.0-or-later
"""Few things that lie far beyond all others: shadow maps are not fitted to them, or shadows among the others would have
no texels left.
"""

from __future__ import annotations

import numpy as np

from ..scene.camera import Camera
from ..scene.table import InstanceTable

#: Strays begin at this many times the distance of the farthest thing before them, and are at most this share of all
#: surfels and triangles.
_GAP, _FEW = 16.0, 1 / 16


def among_others(triangles: np.ndarray, nearest: np.ndarray, farthest: np.ndarray) -> np.ndarray:
    """(n,) which of some objects are no strays. triangles: (n,) that are drawn of each. nearest, farthest: (n,) bounds
    on their distances from where they are looked at."""
    found = np.ones(len(triangles), bool)
    if len(triangles) < 2:
        return found
    order = np.argsort(nearest, kind="stable")
    reach = np.maximum.accumulate(farthest[order])
    left = triangles.sum() - np.cumsum(triangles[order])
    gaps = (nearest[order][1:] > _GAP * np.maximum(reach[:-1], 0)) & (left[:-1] <= _FEW * triangles.sum())
    if gaps.any():
        found[order[int(gaps.argmax()) + 1 :]] = False
    return found


def near_things(table: InstanceTable, camera: Camera) -> tuple[np.ndarray, np.ndarray] | None:
    """Two (3,) world corners of a box that holds everything but far-reaching triangles and strays, with as much again
    around it; None if there is nothing else."""
    others = table.firm.taken(np.delete(np.arange(len(table.firm)), table.firm.reaching))
    if not len(others):
        return None
    corners = others.world_corners
    distances = np.linalg.norm(corners - camera.matrix_world[:3, 3], axis=2)
    boxes = corners[among_others(others.triangles, distances.min(axis=1), distances.max(axis=1))]
    low, high = boxes.min(axis=(0, 1)), boxes.max(axis=(0, 1))
    around = np.linalg.norm(high - low)
    return low - around, high + around
