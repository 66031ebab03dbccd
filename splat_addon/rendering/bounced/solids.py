# SPDX-License-Identifier: GPL-3.0-or-later
"""Which things are solid, so that nobody is inside them and sees their backs."""

from __future__ import annotations

import numpy as np

from ..scene import Scene
from ..scene.polygons import Polygons

#: Odd numbers that mix the bits of a place's three coordinates, and then those of the whole in two ways.
_MIXING = np.array([0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9], np.uint64)
_TWO_WAYS = np.array([0xFF51AFD7ED558CCD, 0xC4CEB9FE1A85EC53], np.uint64)
_FOLD = np.uint64(31)
#: Of so many instances, the largest ones, it is looked whether others are inside of them.
_MOST_ROOMS = 256


def are_solid(scene: Scene, eye: np.ndarray) -> np.ndarray:
    """(n,) bool for each instance of the scene's table: whether it is closed, its normals point outwards, and it is no
    room: neither the eye, (3,) world, nor a lamp nor another instance is in a box around it."""
    table = scene.table
    closed = np.array([_is_closed(one) for one in table.every_kind], bool)[table.kind_of]
    corners = table.world_corners
    low, high = corners.min(axis=1), corners.max(axis=1)
    places = np.array([eye, *(light.position for light in scene.lights if light.kind != "sun")], np.float64)
    for place in places:
        closed &= ~((place > low) & (place < high)).all(axis=1)
    rows = np.flatnonzero(closed)
    largest = np.argsort(-(high - low)[rows].max(axis=1), kind="stable")[:_MOST_ROOMS]
    for row in rows[largest].tolist():
        closed[row] = not ((low > low[row]).all(axis=1) & (high < high[row]).all(axis=1)).any()
    return closed


def _is_closed(placed) -> bool:
    if isinstance(placed.shape, Polygons) and not getattr(placed, "is_cut_out", False):
        return placed.is_closed or is_closed_surface(placed.shape)
    return placed.is_closed


def is_closed_surface(polygons: Polygons) -> bool:
    """Whether each edge of a triangle is another's in the opposite direction, and the volume within is positive.

    Edges are summed by a hash that changes its sign with the direction, so the sum is 0 where all have a partner; of
    others it is 0 by a chance of 2^-64.
    """
    if not len(polygons):
        return False
    bits = (polygons.positions + np.float32(0)).view(np.uint32).astype(np.uint64)  # -0 is 0
    with np.errstate(over="ignore"):
        mixed = (bits * _MIXING).sum(axis=1, dtype=np.uint64)
        mixed ^= mixed >> _FOLD
        first, second = ((mixed * factor) ^ ((mixed * factor) >> _FOLD) for factor in _TWO_WAYS)
        first, second = first.reshape(-1, 3), second.reshape(-1, 3)
        after = [1, 2, 0]
        total = (first * second[:, after] - first[:, after] * second).sum(dtype=np.uint64)
    a, b, c = polygons.positions.astype(np.float64).reshape(-1, 3, 3).transpose(1, 0, 2)
    return bool(total == 0) and float((a * np.cross(b, c)).sum()) > 0
