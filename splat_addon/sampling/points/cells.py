# SPDX-License-Identifier: GPL-3.0-or-later
"""Sorts points into cubic cells, and finds the candidates in the 27 cells around one, for the search in
`neighbours`."""

from __future__ import annotations

import numpy as np

from ...runs import ranges, sorted_with_order

#: Cell numbers up to this can be added and multiplied in int64 without overflow.
_MAX_KEY = 2**62

#: Cells this far from the origin also hold everything beyond, so that one distant point does not make everyone's cells
#: large. The limit ensures that 53-bit coordinates in these last cells that differ at all differ by many cells.
_LAST_CELL = 2**60

#: Below this, coordinates lose digits.
_LEAST_SIZE = 1e-290

#: The first size that is tried, in spacings of a square full of points; the number of points that share a cell is found
#: to this factor, unless the size would have to be increased more often than this.
_FIRST, _ABOUT, _GROWN = 6.0, 1.2, 3


class Cells:
    """N points in cells of one size, and the queries among them.

    order: (N,) int32 points, cell by cell; a *place* is an index into it. unit: the largest power of two that is not
        above the size, so that coordinates in it keep every bit. size: of a cell, in units. columns: (3, N + 1) by
        place, in units, with a final infinite one at place N, which stands for "no point". first: (C + 1,) first place
        of each cell, and N. place_of_point: (N,). queries: (Q,) the queried points, ascending; cell_of_query,
        place_of_query: (Q,); is_far: (Q,) whether it lies in the last cells, as far_points do.
        candidate_counts: number of points in the block around each cell that holds a query.
    """

    def __init__(self, positions: np.ndarray, size: float, queries: np.ndarray):
        self.unit = 2.0 ** np.floor(np.log2(size))
        self.size = size / self.unit
        scaled = [column / size for column in positions.T]
        keys, self._strides = _cell_keys(scaled)
        order, keys = sorted_with_order(keys, int(keys.max(initial=0)) + 1)
        self.order = order.astype(np.int32)
        self.first = np.flatnonzero(np.diff(keys, prepend=-1))
        self._keys = keys[self.first]
        self.first = np.append(self.first, len(keys))
        self.columns = np.full((3, len(keys) + 1), np.inf)
        np.divide(positions[self.order].T, self.unit, out=self.columns[:, :-1])
        self.queries = queries
        is_far = _beyond_last(scaled)
        self.is_far, self.far_points = is_far[queries], np.flatnonzero(is_far)
        self._scaled_queries = [column[queries] for column in scaled]
        self.place_of_point = np.empty(len(keys), np.int32)
        self.place_of_point[self.order] = np.arange(len(keys), dtype=np.int32)
        self.place_of_query = self.place_of_point[queries]
        cell_of_place = np.repeat(np.arange(len(self._keys)), np.diff(self.first))
        self._cells, self.cell_of_query = np.unique(cell_of_place[self.place_of_query], return_inverse=True)
        self._starts, self._counts = self._rows_of_blocks()
        self.candidate_counts = self._counts.sum(axis=1)

    def candidates(self, cells: np.ndarray) -> np.ndarray:
        """(c, m) places of the points in the blocks around cells (by `cell_of_query`), padded with N."""
        starts, counts = self._starts[cells].ravel(), self._counts[cells].ravel()
        sums = self.candidate_counts[cells]
        places = np.full((len(cells), sums.max()), len(self.order), np.int64)
        places[np.arange(places.shape[1]) < sums[:, None]] = ranges(starts, counts)
        return places

    def certain_squares(self, queries: np.ndarray) -> np.ndarray:
        """(q,) squared distance, in units, up to which the block is certain to hold every point; slightly reduced for
        rounding."""
        walls = np.full(len(queries), np.inf)
        for column in self._scaled_queries:
            inside = column[queries] % 1.0
            rounding = 4 * np.finfo(np.float64).eps * np.abs(column[queries])
            walls = np.minimum(walls, np.minimum(inside, 1.0 - inside) - rounding)
        return (self.size * np.maximum(1.0 + walls, 0)) ** 2 * (1 - 1e-6)

    def _rows_of_blocks(self) -> tuple[np.ndarray, np.ndarray]:
        """(C, 9) first place and number of points of each row of three cells in the block around a query's cell."""
        keys = self._keys[self._cells]
        shape = (len(keys), 9)
        starts, counts = np.empty(shape, np.int64), np.empty(shape, np.int64)
        steps = [dx * self._strides[0] + dy * self._strides[1] for dx in (-1, 0, 1) for dy in (-1, 0, 1)]
        for row, step in enumerate(steps):
            starts[:, row] = self.first[np.searchsorted(self._keys, keys + (step - 1))]
            counts[:, row] = self.first[np.searchsorted(self._keys, keys + (step + 1), "right")] - starts[:, row]
        return starts, counts


def fine_cell_size(positions: np.ndarray, wanted: float) -> float:
    """A cell size at which an average point shares its cell with about `wanted` points, itself included.

    positions: (N, 3), pairwise different. The average is over points, so that a dense cluster counts; points in the
        last cells are excluded.
    """
    size = _FIRST * float(np.ptp(positions, axis=0).max()) / np.sqrt(len(positions))
    company = _company(positions, size)
    while company > _ABOUT * wanted and size > _LEAST_SIZE:
        # On a surface the number grows with the square of the size.
        size *= np.sqrt(wanted / company)
        company = _company(positions, size)
    for _ in range(_GROWN):
        # In space it grows with the cube.
        larger = size * np.cbrt(wanted / max(company, 1.0))
        if company > wanted / _ABOUT or (company := _company(positions, larger)) > _ABOUT * wanted:
            break
        size = larger
    return size


def _company(positions: np.ndarray, size: float) -> float:
    """Mean over the points of how many share a point's cell."""
    scaled = [column / size for column in positions.T]
    keys = np.sort(_cell_keys(scaled)[0][~_beyond_last(scaled)])
    counts = np.diff(np.flatnonzero(np.diff(keys, prepend=-1, append=-1)))
    return np.square(counts, dtype=np.float64).sum() / max(len(keys), 1)


def _beyond_last(scaled: list[np.ndarray]) -> np.ndarray:
    """(N,) bool: which points lie in the last cells along some axis, from columns in cell units."""
    return np.logical_or.reduce([np.abs(column) >= _LAST_CELL for column in scaled])


def _cell_keys(scaled: list[np.ndarray]) -> tuple[np.ndarray, tuple[int, int]]:
    """(N,) int64 cell number of each point, and its increments per cell along x and y (1 along z)."""
    cells = [np.clip(np.floor(column), -_LAST_CELL, _LAST_CELL).astype(np.int64) for column in scaled]
    cells = [column - (column.min() - 1) for column in cells]
    lengths = [int(column.max()) + 2 for column in cells]
    if lengths[0] * lengths[1] * lengths[2] > _MAX_KEY:
        cells = [_without_gaps(column) for column in cells]
        lengths = [int(column.max()) + 2 for column in cells]
    strides = lengths[1] * lengths[2], lengths[2]
    return cells[0] * strides[0] + cells[1] * strides[1] + cells[2], strides


def _without_gaps(column: np.ndarray) -> np.ndarray:
    """Cell numbers along one axis, renumbered so that neighbours stay neighbours and every gap shrinks to a single
    cell."""
    used, inverse = np.unique(column, return_inverse=True)
    return np.cumsum(np.minimum(np.diff(used, prepend=0), 2))[inverse]


def spatial_order(positions: np.ndarray) -> np.ndarray:
    """(N,) order that places points close in space close in memory, from (N, 3) finite positions.

    With points in random order, gathering neighbours is bound by memory latency.
    """
    corner = positions.min(axis=0)
    extent = float((positions - corner).max())
    size = 8 * extent / np.sqrt(len(positions)) if extent > 0 else 1.0
    keys, _ = _cell_keys([column / size for column in (positions - corner).T])
    return sorted_with_order(keys, int(keys.max()) + 1)[0]
