# SPDX-License-Identifier: GPL-3.0-or-later
"""Which boxes lie behind everything that a view has drawn (Greene, Kass, Miller, "Hierarchical Z-Buffer Visibility",
1993)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..scene.camera import Camera

#: Samples along each side of a cell.
COVER_CELL = 4


@dataclass(frozen=True, eq=False)
class Cover:
    """How far each cell of a picture sees, and that picture's camera.

    farthest: (rows, columns), distances along the view, world units times `scale`. begin: x and y of the picture in the
    first cell, samples. samples: per pixel along each axis.
    """

    farthest: np.ndarray
    camera: Camera
    scale: float
    samples: int
    begin: np.ndarray

    def hides(self, middle: np.ndarray, half: np.ndarray, nearer: np.ndarray | float, beside: float) -> np.ndarray:
        """(n,) bool: whether boxes along the axes of view space are behind what every cell under them sees.

        middle, half: (3, n) world units, the latter half their extent. nearer: by which their contents may seem to be
        nearer, (n,) or for all. beside: pixels beside them in which their contents may be seen.
        """
        nearest, farthest = -middle[2] - half[2], -middle[2] + half[2]
        if not self.camera.is_orthographic:
            # what reaches nearer is before all that is seen
            nearest, farthest = (np.maximum(depth, self.camera.near) for depth in (nearest, farthest))
        first, last = self._cells(middle, half, nearest, farthest, beside)
        seen = self._farthest_under(first, last)
        return (nearest - nearer) * self.scale > seen * (1 + 1e-6)

    def _cells(self, middle, half, nearest, farthest, beside: float) -> tuple[np.ndarray, np.ndarray]:
        """(2, n) first and last column and row of the cells under boxes."""
        low, high = middle[:2] - half[:2], middle[:2] + half[:2]
        if not self.camera.is_orthographic:
            low, high = (
                np.where(low < 0, low / nearest, low / farthest),
                np.where(high > 0, high / nearest, high / farthest),
            )
        left, right, bottom, top = self.camera.window
        size = np.reshape(self.camera.size, (2, 1))
        corner, extent = np.array([[left], [bottom]]), np.array([[right - left], [top - bottom]])
        low, high = ((place - corner) / extent * size for place in (low, high))
        begin = np.reshape(self.begin, (2, 1))
        places = ((low - beside) * self.samples + begin, (high + beside) * self.samples + begin)
        end = np.reshape(self.farthest.shape[::-1], (2, 1)) - 1
        first, last = (np.clip(place / COVER_CELL, 0, end).astype(int) for place in places)
        return first, last

    def _farthest_under(self, first: np.ndarray, last: np.ndarray) -> np.ndarray:
        """(n,) the farthest that any of the cells of these columns and rows sees: that of four windows, each as large
        as powers of two may be, which together cover them."""
        power = np.floor(np.log2(last - first + 1)).astype(int)
        kind, result = power[0] << 5 | power[1], np.empty(first.shape[1])
        for number in np.flatnonzero(np.bincount(kind)):
            at, across, up = np.flatnonzero(kind == number), number >> 5, number & 31
            (x, y), (right, top) = first[:, at], last[:, at] + 1 - np.array([[1 << across], [1 << up]])
            cells = self._windows(across, up)
            result[at] = np.maximum.reduce([cells[y, x], cells[y, right], cells[top, x], cells[top, right]])
        return result

    def _windows(self, across: int, up: int) -> np.ndarray:
        """The farthest that any cell sees of each window of 2^across columns and 2^up rows, by its first ones."""
        cells = self.farthest
        for step in 1 << np.arange(across):
            cells = np.maximum(cells[:, :-step], cells[:, step:])
        for step in 1 << np.arange(up):
            cells = np.maximum(cells[:-step], cells[step:])
        return cells
