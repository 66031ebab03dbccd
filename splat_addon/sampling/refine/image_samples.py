# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds which samples of a layered depth image are neighbours: in the next column or row, on the same surface."""

from __future__ import annotations

from itertools import product

import numpy as np

from ...runs import order_of
from ..ldc.scan_conversion import Spans
from ..mesh.triangle_mesh import triangle_chunks

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
    """

    STEPS = ((1, 0), (-1, 0), (0, 1), (0, -1))

    def __init__(self, places: np.ndarray, normals: np.ndarray, axis: int, rows: slice):
        self.axis, self._order = axis, [(axis + k) % 3 for k in (1, 2, 0)]
        here = [places[k, rows] for k in self._order]
        self._lowest = [np.floor(place.min()) for place in here]
        self._size = [int(place.max() - low) + 1 for place, low in zip(here, self._lowest, strict=True)]
        self._bits = (self._size[2] * _PARTS).bit_length()
        keys = self._keys(*here)
        order = order_of(keys)
        self._sorted, self.rows = keys.take(order), order + rows.start
        self.places = [place.take(self.rows) for place in places]
        self.depth = self.places[axis]
        self.normals = [normals[k].take(self.rows) for k in self._order]
        self._next = self._next_samples()

    def __len__(self) -> int:
        return len(self.rows)

    def neighbours(self, part: np.ndarray) -> dict[tuple[int, int], np.ndarray]:
        """Step in columns and rows -> (p,) number of the sample there, or -1, for the p samples with
        these numbers."""
        found = {step: there[part] for step, there in self._next.items()}
        for u, v in product((-1, 1), repeat=2):
            corner = self._next[0, v].take(found[u, 0])
            found[u, v] = np.where(corner >= 0, corner, self._next[u, 0].take(found[0, v]))
        return found

    def next_axes(self, part: np.ndarray) -> np.ndarray:
        """(p,) axis of the image that the surface would be seen in if it were steeper."""
        u, v, _ = (n[part] for n in self.normals)
        return np.where(np.abs(u) >= np.abs(v), self._order[0], self._order[1])

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
        return self._nearest(self._keys(u, v, depth), depth)

    def _keys(self, u: np.ndarray, v: np.ndarray, depth: np.ndarray) -> np.ndarray:
        """Numbers by row, column and part of depth; beside the image, those of a margin of one cell."""
        (left, low, _), (width, height, _) = self._lowest, self._size
        column = np.clip(np.floor(u - left), -1, width) + 1
        row = np.clip(np.floor(v - low), -1, height) + 1
        cells = row.astype(np.int64) * (width + 2) + column.astype(np.int64)
        return (cells << self._bits) + self._parts(depth)

    def _parts(self, depth: np.ndarray) -> np.ndarray:
        return np.clip((depth - self._lowest[2]) * _PARTS, 0, self._size[2] * _PARTS - 1).astype(np.int64)

    def _nearest(self, keys: np.ndarray, depth: np.ndarray) -> np.ndarray:
        # Only between the least and the greatest: of samples that follow each other, few others then stay in the cache.
        first, last = np.searchsorted(self._sorted, (keys.min(initial=0), keys.max(initial=0)))
        after = np.searchsorted(self._sorted[first:last], keys)
        after += first
        keys >>= self._bits
        found, gap = np.full(len(keys), -1, np.intp), np.full(len(keys), _FARTHEST, np.float32)
        for number in (after - 1, after):
            np.clip(number, 0, len(self) - 1, out=number)
            off = np.abs(self.depth.take(number) - depth)
            nearer = off < gap
            nearer &= self._sorted.take(number) >> self._bits == keys
            np.copyto(found, number, where=nearer)
            np.copyto(gap, off, where=nearer)
        return found

    def _next_samples(self) -> dict[tuple[int, int], np.ndarray]:
        """One of `STEPS` -> (n + 1,) numbers of the samples there, or -1; the last, so that none has none."""
        found = {}
        for step, cells in (((1, 0), 1), ((0, 1), self._size[0] + 2)):
            ahead, back = np.full((2, len(self) + 1), -1, np.intp)
            for part in triangle_chunks(len(self)):
                normals = [n[part] for n in self.normals]
                expected = self.depth[part] + self.rise(np.float32(step), normals)
                keys = (((self._sorted[part] >> self._bits) + cells) << self._bits) + self._parts(expected)
                there = self._nearest(keys, expected)
                alike = sum(n * of.take(there) for n, of in zip(normals, self.normals, strict=True)) >= SAME_SIDE
                there[~alike] = -1
                ahead[part], back[there] = there, np.arange(part.start, part.stop)
            back[-1] = -1
            found[step], found[-step[0], -step[1]] = ahead, back
        return found


def inside_triangles(images: tuple[Spans, ...]) -> np.ndarray:
    """(N,) int8 of all samples: 2 for those with 5 x 5 samples of their own triangle around them, 1 for those with
    3 x 3, otherwise 0.
    """
    return np.concatenate([_inside_triangles(spans) for spans in images])


def _inside_triangles(spans: Spans) -> np.ndarray:
    # In a row, a triangle has one span, or one on either side of its large samples (`flat_blocks`).
    is_first = np.ones(len(spans), bool)
    is_first[1:] = (spans.triangles[1:] != spans.triangles[:-1]) | (spans.rows[1:] != spans.rows[:-1])
    starts, row = np.flatnonzero(is_first), np.cumsum(is_first) - 1
    column, ends = spans.columns.astype(np.int64), np.cumsum(spans.counts, dtype=np.int64)
    first, stop = column[starts], (column + spans.counts)[np.append(starts[1:], len(spans)) - 1] if len(spans) else ends
    follows = in_next_row(spans[starts])
    changes = np.zeros(int(ends[-1]) + 1 if len(ends) else 1, np.int8)
    offset = ends - spans.counts - column
    for _ in range(2):
        first, stop = eroded(first, stop, follows)
        left, right = np.maximum(first.take(row), column), np.minimum(stop.take(row), column + spans.counts)
        some = np.flatnonzero(right > left)
        # no two spans share an end
        changes[(offset + left).take(some)] += 1
        changes[(offset + right).take(some)] -= 1
    return np.cumsum(changes[:-1], dtype=np.int8)


def in_next_row(spans: Spans) -> np.ndarray:
    """(n - 1,) bool: whether a span lies in the row after that of the span before it, in the same triangle."""
    return (spans.triangles[1:] == spans.triangles[:-1]) & (spans.rows[1:] == spans.rows[:-1] + 1)


def eroded(first: np.ndarray, stop: np.ndarray, follows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The columns of (n,) half-open runs that have columns of runs on all eight sides. follows: (n - 1,), from
    `in_next_row`."""
    left, right = first.copy(), stop.copy()
    np.maximum(left[1:], first[:-1], out=left[1:], where=follows)
    np.maximum(left[:-1], first[1:], out=left[:-1], where=follows)
    np.minimum(right[1:], stop[:-1], out=right[1:], where=follows)
    np.minimum(right[:-1], stop[1:], out=right[:-1], where=follows)
    is_between = np.zeros(len(first), bool)
    is_between[1:-1] = follows[1:] & follows[:-1]
    return left + 1, np.where(is_between, right - 1, left + 1)
