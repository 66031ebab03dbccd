# SPDX-License-Identifier: GPL-3.0-or-later
"""Corners of boxes, (n, 8, 3), of which the same number of all boxes lies together in memory: over eight or three
numbers that lie side by side, numpy's operations take ten to a hundred times as long."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

#: (8, 3) for each corner of a box, whether it is at the high end of each axis.
CORNERS = np.array([[k & 1, k >> 1 & 1, k >> 2 & 1] for k in range(8)], bool)


def box_of(low: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """(n, 8, 3) the corners of boxes. low: (3, n) the first of each. edges: (3, 3, n) what leads to the next along each
    axis."""
    made = np.empty((8, *low.shape))
    made[0] = low
    for step, edge in zip((1, 2, 4), edges, strict=True):
        # those at the high end of an axis from those at its low end
        np.add(made[:step], edge, out=made[step : 2 * step])
    return made.transpose(2, 0, 1)


def corner_by_corner(corners: np.ndarray, rows: np.ndarray | None = None) -> np.ndarray:
    """(n, 8, 3) the same corners, or those of some boxes. rows: numbers, or (n,) bool."""
    each = corners.transpose(1, 2, 0)
    if rows is not None:
        each = np.take(each, np.flatnonzero(rows) if rows.dtype == bool else rows, axis=2)
    return np.ascontiguousarray(each).transpose(2, 0, 1)


def joined(some: Sequence[np.ndarray]) -> np.ndarray:
    """(n, 8, 3) the corners of several sets of boxes."""
    if len(some) == 1:
        return some[0]
    return np.concatenate([corners.transpose(1, 2, 0) for corners in some], axis=2).transpose(2, 0, 1)


def corners_times(corners: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """(n, 8, k) the product of each of (n, 8, 3) corners with a (3, k) matrix."""
    return (matrix.T @ np.ascontiguousarray(corners.transpose(1, 2, 0))).transpose(2, 0, 1)
