# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact scan conversion of triangles onto one axis's grid: which cell centres lie inside which triangle.

Corners are whole sub-cells stored as float64. With L the largest coordinate in sub-cells, every product and sum below
stays under 2 L^2 <= 2^51 and is exact; the only division is correctly rounded, and a quotient that is not an integer is
at least 1/L away from one, which exceeds the rounding, so its `ceil` is right. Rows and columns are half-open, so two
triangles that share an edge never share or lose a sample.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields

import numpy as np

#: Rows, or samples, that are expanded per batch.
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
        """Spans concatenated in order; an empty list gives no spans."""
        if not parts:
            return Spans(*(np.zeros(0, np.int32) for _ in fields(Spans)))
        return Spans(*(np.concatenate([getattr(p, f.name) for p in parts]) for f in fields(Spans)))


def scan_convert(u: np.ndarray, v: np.ndarray, subcells: int, band: np.ndarray | None = None) -> Iterator[Spans]:
    """The samples of t triangles, numbered from 0, as spans.

    u, v: (3, t) float64, the corners' image coordinates in whole sub-cells.
    band: (2, t) float64, the half-open range of rows wanted of each triangle; None: all. The edge A-B meets row j, the
        line v = y = j S, at column ceil((uA (vB - vA) + (y - vA)(uB - uA)) / ((vB - vA) S)).
    """
    u, v = _sorted_by_row(u, v)
    first, turn, last = np.ceil(v * (1 / subcells))
    if band is not None:
        first, last = np.maximum(first, band[0]), np.minimum(last, band[1])
        last = np.maximum(last, first)
    base, slope, divisor = (line.ravel() for line in _edges(u, v, subcells))
    rows_of = (last - first).astype(np.intp)
    for part in batches(rows_of, BATCH):
        owner, row = _rows(part, first, rows_of)
        # Each row meets the long edge and one short edge: the lower one below the middle corner's row, else the upper
        # one.
        edge = np.empty((2, len(owner)), np.intp)
        edge[0] = owner
        np.multiply(row >= turn.take(owner), len(first), out=edge[1])
        edge[1] += owner
        edge[1] += len(first)
        ends = slope.take(edge)
        ends *= row
        ends += base.take(edge)
        ends /= divisor.take(edge)
        start, stop = np.ceil(ends, out=ends)
        some = np.flatnonzero(start != stop)
        start, stop = start.take(some), stop.take(some)
        yield Spans(
            owner.take(some).astype(np.int32),
            row.take(some).astype(np.int32),
            np.minimum(start, stop).astype(np.int32),
            np.abs(stop - start).astype(np.int32),
        )


def batches(counts: np.ndarray, limit: int) -> Iterator[slice]:
    """Slices of consecutive entries whose counts add up to at most `limit`; an entry above the limit gets its own
    slice."""
    if 0 < len(counts) and counts.sum(dtype=np.int64) <= limit:
        yield slice(0, len(counts))
        return
    ends = np.cumsum(counts, dtype=np.int64)
    start = 0
    while start < len(counts):
        before = ends[start - 1] if start else 0
        stop = max(int(np.searchsorted(ends, before + limit, "right")), start + 1)
        yield slice(start, stop)
        start = stop


#: Two integers of magnitude up to 2^25, one of them multiplied by this and added to the other, fit one float64 exactly.
_PACKING = 2.0**27


def _sorted_by_row(u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The corners of each triangle by rising v: u and v, both (3, t).

    Both are packed into single numbers for sorting, because numpy computes minima ten times as fast as it applies
    masks.
    """
    a, b, c = v * _PACKING + u
    a, b = np.minimum(a, b), np.maximum(a, b)
    packed = np.empty_like(u)
    b, _ = np.minimum(b, c), np.maximum(b, c, out=packed[2])
    np.minimum(a, b, out=packed[0])
    np.maximum(a, b, out=packed[1])
    v = packed * (1 / _PACKING)
    np.rint(v, out=v)
    packed -= v * _PACKING
    return packed, v


def _edges(u: np.ndarray, v: np.ndarray, subcells: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Base, slope and divisor, (3, t) each, of the long edge, the lower and the upper short edge.

    u, v: (3, t), sorted by v. An edge meets row j at column ceil((base + j slope) / divisor).
    """
    base, slope, divisor = (np.empty_like(u) for _ in range(3))
    for edge, (low, high) in enumerate(((0, 2), (0, 1), (1, 2))):
        np.subtract(u[high], u[low], out=slope[edge])
        np.subtract(v[high], v[low], out=divisor[edge])
        np.multiply(u[low], divisor[edge], out=base[edge])
        base[edge] -= v[low] * slope[edge]
    slope *= subcells
    divisor *= subcells
    return base, slope, divisor


def _rows(part: slice, first: np.ndarray, counts: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The rows of these triangles: (n,) intp triangle and (n,) float64 row, from the `first` row and `counts` per
    triangle."""
    counts = counts[part]
    owner = np.repeat(np.arange(part.start, part.stop), counts)
    offset = first[part] + counts
    offset -= np.cumsum(counts)
    row = np.arange(len(owner), dtype=np.float64)
    row += offset.take(owner - part.start if part.start else owner)
    return owner, row
