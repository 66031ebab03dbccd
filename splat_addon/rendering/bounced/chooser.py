# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps one point of each cube of a grid and side: of many surfels, few are looked at further."""

from __future__ import annotations

import numpy as np

from .sides import SIDES, side_of


class Chooser:
    """Of points in a grid from `low`, (3,), with cubes of `edge`."""

    def __init__(self, low: np.ndarray, edge: float, shape: tuple[int, int, int]):
        self.low, self.edge, self._shape = low, edge, shape
        count = int(np.prod(shape)) * SIDES
        self._seen = np.zeros(count, bool)
        self._last = np.empty(count, np.int32)

    def fresh(self, at: np.ndarray, normals: np.ndarray) -> np.ndarray:
        """(m,) rows of (3, n) places in cubes from `low` and normals of any length: one of each cube and side that is
        new. Those outside of the grid are none."""
        is_inside = (at >= 0).all(axis=0)
        for row, size in zip(at, self._shape, strict=True):
            is_inside &= row < size
        rows = np.flatnonzero(is_inside)
        if len(rows) < len(is_inside):
            at, normals = at[:, rows], normals[:, rows]
        x, y, z = at.astype(np.int32)
        numbers = ((x * np.int32(self._shape[1]) + y) * np.int32(self._shape[2]) + z) * np.int32(SIDES)
        numbers += side_of(normals.T)
        some = np.flatnonzero(~self._seen[numbers])
        rows, numbers = rows[some], numbers[some]
        order = np.arange(len(rows), dtype=np.int32)
        self._last[numbers] = order
        is_last = self._last[numbers] == order
        self._seen[numbers] = True
        return rows[is_last]
