# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact scan conversion of triangles onto one axis's grid: which cell centres lie inside which triangle.

Corners are whole sub-cells held in float64. With L the largest coordinate in sub-cells, every product and sum
below stays under 2 L^2 <= 2^51 and is exact; the one division is correctly rounded, and a quotient that is no integer
lies at least 1/L away from one, more than the rounding, so its `ceil` is right. Rows and columns are half-open, so two
triangles that share an edge never share or lose a sample (facts/sampling.md section 1).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields

import numpy as np

#: Rows, or samples, that are expanded at a time.
BATCH = 65536


@dataclass(frozen=True, eq=False)
class Spans:
    """n runs of samples, each along one row of the grid and inside one triangle, in the order of the triangles.

    triangles: (n,) int32. rows: (n,) int32. columns: (n,) int32, of the first sample. counts: (n,) int32, > 0.
    """

    triangles: np.ndarray
    rows: np.ndarray
    columns: np.ndarray
    counts: np.ndarray

    def __len__(self) -> int:
        return len(self.triangles)

    def __getitem__(self, part: slice) -> Spans:
        return Spans(*(getattr(self, f.name)[part] for f in fields(self)))

    @staticmethod
    def joined(parts: list[Spans]) -> Spans:
        """One after the other; no parts make no spans."""
        if not parts:
            return Spans(*(np.zeros(0, np.int32) for _ in fields(Spans)))
        return Spans(*(np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(Spans)))


def scan_convert(u: np.ndarray, v: np.ndarray, triangles: np.ndarray, subcells: int) -> Iterator[Spans]:
    """The samples of t triangles, as spans.

    u, v: (3, t) float64, the corners' image coordinates in whole sub-cells.
    triangles: (t,) the number that stands for each triangle in the result.
    """
    hit = np.flatnonzero(_has_integer(u, subcells) & _has_integer(v, subcells))
    bottom, middle, top = _sorted_by_row(u.take(hit, axis=1), v.take(hit, axis=1))
    triangles = triangles.take(hit)
    long = _Edges(bottom, top, subcells)
    # The two short edges of a triangle, one after the other, cross the same rows as its long edge.
    short = _Edges(_interleaved(bottom, middle), _interleaved(middle, top), subcells)
    for part in batches(long.rows, BATCH):
        owner, row, start = long.columns(part)
        _, _, stop = short.columns(slice(2 * part.start, 2 * part.stop))
        count = np.abs(stop - start)
        some = np.flatnonzero(count)
        yield Spans(
            triangles[owner[some]].astype(np.int32),
            row[some].astype(np.int32),
            np.minimum(start, stop)[some].astype(np.int32),
            count[some].astype(np.int32),
        )


def expand(counts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """For runs of these lengths: which run each element belongs to, and its place in it, both (sum of counts,) intp."""
    owner = np.repeat(np.arange(len(counts)), counts)
    before = np.cumsum(counts, dtype=np.intp) - counts
    return owner, np.arange(len(owner)) - before.take(owner)


def batches(counts: np.ndarray, limit: int) -> Iterator[slice]:
    """Slices of neighbouring entries whose counts sum up to at most `limit`; an entry above it comes alone."""
    ends = np.cumsum(counts, dtype=np.int64)
    start = 0
    while start < len(counts):
        before = ends[start - 1] if start else 0
        stop = max(int(np.searchsorted(ends, before + limit, "right")), start + 1)
        yield slice(start, stop)
        start = stop


class _Edges:
    """Edges that go up from (u, v) `low` to `high`, each (2, e), ready to be met with rows.

    The edge A-B meets row j, the line v = y = j S, at column ceil((uA (vB - vA) + (y - vA)(uB - uA)) / ((vB - vA) S)).
    """

    def __init__(self, low: np.ndarray, high: np.ndarray, subcells: int):
        (u, v), (du, dv) = low, high - low
        self.first_row = np.ceil(v / subcells)
        self.rows = (np.ceil(high[1] / subcells) - self.first_row).astype(np.intp)
        self.base = u * dv - v * du
        self.slope = du * subcells
        self.divisor = dv * subcells

    def columns(self, part: slice) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """For each row that each edge of this slice meets: the edge, the row, the first column at or after it."""
        edge, step = expand(self.rows[part])
        edge += part.start
        row = self.first_row.take(edge) + step
        return edge, row, np.ceil((self.base.take(edge) + row * self.slope.take(edge)) / self.divisor.take(edge))


def _has_integer(coordinate: np.ndarray, subcells: int) -> np.ndarray:
    """(t,) whether a cell centre lies between the lowest (included) and the highest (excluded) of (3, t) corners."""
    a, b, c = coordinate
    low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
    return np.ceil(low / subcells) < np.ceil(high / subcells)


def _sorted_by_row(u: np.ndarray, v: np.ndarray) -> list[np.ndarray]:
    """The three corners of each triangle by rising v: three (2, t) arrays of u, v."""
    corners = [(u[k], v[k]) for k in range(3)]
    for low, high in ((0, 1), (1, 2), (0, 1)):
        (ua, va), (ub, vb) = corners[low], corners[high]
        swap = va > vb
        corners[low] = np.where(swap, ub, ua), np.minimum(va, vb)
        corners[high] = np.where(swap, ua, ub), np.maximum(va, vb)
    return [np.stack(corner) for corner in corners]


def _interleaved(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(2, 2 t): a's and b's columns by turns."""
    return np.stack([a, b], axis=2).reshape(2, -1)
