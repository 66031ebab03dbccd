# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds which samples of a layered depth image are neighbours: in the next column or row, on the same surface."""

from __future__ import annotations

import numpy as np

from ..edges.ordering import order_of

#: Samples of one cell are ordered by depth in these parts of a cell.
_PARTS = 8

#: The least cosine between the planes of neighbours, and the farthest that one may be from where a sample's plane
#: expects it, in cells along the axis.
SAME_SIDE, _FARTHEST = np.float32(0.5), np.float32(1.5)

#: Steeper planes are taken to be this steep, in cells of depth a cell.
_STEEPEST = np.float32(2)


class ImageSamples:
    """The n samples of one image, ordered by row, column and depth.

    axis: of the image. rows: (n,) of all samples. places: three of (n,) float32, x, y and z in cells from the grid's
    middle. depth: (n,), the one along the axis. normals: three of (n,) across, up and along the axis, unit.
    next_axis: (n,) of the image that the surface would be seen in if it were steeper. neighbours: step in columns and
    rows -> (n,) number of the sample there, or -1.
    """

    STEPS = ((1, 0), (-1, 0), (0, 1), (0, -1))

    def __init__(self, places: np.ndarray, normals: np.ndarray, axis: int, rows: slice):
        self.axis, self._order = axis, [(axis + k) % 3 for k in (1, 2, 0)]
        here = [places[k, rows] for k in self._order]
        self._lowest = [np.floor(place.min()) for place in here]
        self._size = [int(place.max() - low) + 1 for place, low in zip(here, self._lowest, strict=True)]
        self._bits = (self._size[2] * _PARTS).bit_length()
        keys = self._keys(*self._cells(*here))
        order = order_of(keys)
        self._sorted, self.rows = keys.take(order), order + rows.start
        self.places = [place.take(self.rows) for place in places]
        self.depth = self.places[axis]
        self.normals = [normals[k].take(self.rows) for k in self._order]
        u, v, _ = self.normals
        self.next_axis = np.where(np.abs(u) >= np.abs(v), self._order[0], self._order[1])
        self.neighbours = self._all_neighbours()

    def along_axes(self, u, v, a) -> list:
        """What is given across, up and along the axis, as x, y and z."""
        return [(u, v, a)[(k - self.axis - 1) % 3] for k in range(3)]

    def in_order(self, x, y, z) -> list:
        """What is given as x, y and z, across, up and along the axis."""
        return [(x, y, z)[k] for k in self._order]

    @staticmethod
    def rise(step, normals: list[np.ndarray]) -> np.ndarray:
        """How much higher planes are at a step from their samples, in cells along the axis. normals: across, up and
        along it."""
        u, v, a = normals
        rise = u * step[0]
        rise += v * step[1]
        rise /= a
        return np.clip(np.negative(rise, out=rise), -_STEEPEST, _STEEPEST, out=rise)

    def nearest(self, x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
        """(m,) numbers of the samples in the same cells as places and nearest to them in depth, or -1."""
        u, v, depth = self.in_order(x, y, z)
        return self._nearest(*self._cells(u, v, depth), depth)

    def _cells(self, u: np.ndarray, v: np.ndarray, depth: np.ndarray):
        """Columns and rows, from 1, and parts of depth; beside the image, those of a margin of one cell."""
        (left, low, _), (width, height, _) = self._lowest, self._size
        column = np.clip(np.floor(u - left), -1, width) + 1
        row = np.clip(np.floor(v - low), -1, height) + 1
        return column.astype(np.int64), row.astype(np.int64), self._parts(depth)

    def _parts(self, depth: np.ndarray) -> np.ndarray:
        return np.clip((depth - self._lowest[2]) * _PARTS, 0, self._size[2] * _PARTS - 1).astype(np.int64)

    def _keys(self, column: np.ndarray, row: np.ndarray, parts: np.ndarray) -> np.ndarray:
        return ((row * (self._size[0] + 2) + column) << self._bits) + parts

    def _nearest(self, column, row, parts, depth: np.ndarray) -> np.ndarray:
        keys = self._keys(column, row, parts)
        after = np.searchsorted(self._sorted, keys)
        keys >>= self._bits
        found, gap = np.full(len(keys), -1, np.intp), np.full(len(keys), _FARTHEST, np.float32)
        for number in (after - 1, after):
            np.clip(number, 0, len(self.rows) - 1, out=number)
            off = np.abs(self.depth.take(number) - depth)
            nearer = off < gap
            nearer &= self._sorted.take(number) >> self._bits == keys
            np.copyto(found, number, where=nearer)
            np.copyto(gap, off, where=nearer)
        return found

    def _all_neighbours(self) -> dict[tuple[int, int], np.ndarray]:
        column, row, _ = self._cells(*self.in_order(*self.places))
        ahead, found = {}, {}
        for step in ((1, 0), (0, 1)):
            expected = self.depth + self.rise(np.float32(step), self.normals)
            there = self._nearest(column + step[0], row + step[1], self._parts(expected), expected)
            alike = sum(n * n.take(there) for n in self.normals) >= SAME_SIDE
            there[~alike] = -1
            back = np.full(len(there) + 1, -1, np.intp)
            back[there] = np.arange(len(there))
            # One more, so that the neighbour of none is none.
            ahead[step] = np.append(there, -1)
            back[-1] = -1
            ahead[-step[0], -step[1]] = back
        for step, numbers in ahead.items():
            found[step] = numbers[:-1]
        for u in (-1, 1):
            for v in (-1, 1):
                across, up = ahead[u, 0], ahead[0, v]
                corner = up.take(across[:-1])
                found[u, v] = np.where(corner >= 0, corner, across.take(up[:-1]))
        return found
