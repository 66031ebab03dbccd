# SPDX-License-Identifier: GPL-3.0-or-later
"""The nearest candidates of queries whose candidates are in cells, for the search in `neighbours`."""

from __future__ import annotations

import numpy as np

from .cells import Cells

#: Offsets from a point of the cell, in units, that are not told apart beyond this; and squared distances from which
#: candidates may therefore be farther.
_FARTHEST, CUT_OFF = 6.0, 16.0

#: Squared distances, in units, of which float32 offsets from a point of the cell tell less than 5 digits.
_TOO_NEAR = 2e-3

#: Up to this many candidates are sorted by distances without their lowest bits, which agree to 4 digits.
_MOST_IN_32_BITS = 256


class Block:
    """Queries, those of one cell beside each other, and their candidates.

    candidates: (C, m) places in `cells`, of each cell. row: (q,) each query's, of these. squares: (q, m) float32
    squared distances, in units.
    """

    def __init__(self, cells: Cells, queries: np.ndarray):
        of = cells.cell_of_query[queries]
        first = np.flatnonzero(np.diff(of, prepend=-1))
        self.cells, self.queries = cells, queries
        self.row = np.repeat(np.arange(len(first)), np.diff(first, append=len(queries)))
        self.candidates = cells.candidates(of[first])
        own = cells.place_of_query[queries]
        self.squares = self._squares(own, own[first])

    def _squares(self, own: np.ndarray, corners: np.ndarray) -> np.ndarray:
        sums = None
        for column in self.cells.columns:
            corner = column[corners]
            theirs = column.take(self.candidates)
            theirs -= corner[:, None]
            # What is farther away is at no certain distance, however far.
            np.clip(theirs, -_FARTHEST, _FARTHEST, out=theirs)
            away = theirs.astype(np.float32).take(self.row, axis=0)
            away -= (column[own] - corner[self.row]).astype(np.float32)[:, None]
            away *= away
            sums = away if sums is None else np.add(sums, away, out=sums)
        return sums

    def nearest(self, count: int) -> tuple[np.ndarray, np.ndarray]:
        """(q, k) places and (q, k) float32 squared distances, in units, of the nearest candidates, nearest first.

        Where points are too near for float32, distances are found in float64.
        """
        columns, every = self.squares.shape[1], np.arange(len(self.queries))
        keys, mask = _sortable(self.squares)
        if count < columns - 1:
            keys.partition(count, axis=1)
        keys = keys[:, : count + 1]
        keys.sort(axis=1)
        keys &= mask
        # A point is its own nearest neighbour, if no other is too near.
        at = keys[:, 1:].astype(np.intp)
        at += (every * columns)[:, None]
        squares = self.squares.ravel().take(at)
        at += ((self.row - every) * columns)[:, None]
        places = self.candidates.ravel().take(at)
        close = np.flatnonzero(squares[:, 0] < _TOO_NEAR)
        if len(close):
            own, every = self.cells.place_of_query[self.queries[close]], self.candidates[self.row[close]]
            places[close], squares[close] = exactly_nearest(self.cells.columns, own, every, count)
        return places, squares


def _sortable(squares: np.ndarray) -> tuple[np.ndarray, np.integer]:
    """(q, m) integers that sort like (q, m) float32 squared distances, and which of their bits are the column.

    The bits of non-negative float32 values sort like the values; few columns fit in the lowest of them.
    """
    bits, columns = squares.view(np.uint32), squares.shape[1]
    if columns > _MOST_IN_32_BITS:
        keys = bits.astype(np.uint64)
        keys <<= np.uint64(32)
        keys |= np.arange(columns, dtype=np.uint64)
        return keys, np.uint64(0xFFFFFFFF)
    mask = np.uint32((1 << (columns - 1).bit_length()) - 1)
    keys = bits & ~mask
    keys |= np.arange(columns, dtype=np.uint32)
    return keys, mask


def exactly_nearest(
    columns: np.ndarray, own: np.ndarray, places: np.ndarray, count: int, unit: float = 1.0
) -> tuple[np.ndarray, np.ndarray]:
    """The `count` nearest places of each of q queries, nearest first, and their squared distances in a unit.

    columns: (3, N) by place. own: (q,) places of the queries. places: (q, m) the candidates; the query itself, which is
    among them, is left out. A squared distance and its place are packed into one 64-bit integer, and these integers are
    sorted.
    """
    away = columns.take(places, axis=1)
    away -= columns.take(own, axis=1)[:, :, None]
    away /= unit
    with np.errstate(over="ignore"):
        squared = np.einsum("iqm,iqm->qm", away, away).astype(np.float32)
    keys = squared.view(np.uint32).astype(np.uint64)
    keys <<= np.uint64(32)
    keys |= places.view(np.uint64)
    keys = np.partition(keys, count, axis=1)[:, : count + 1]
    keys.sort(axis=1)
    found = (keys & np.uint64(0xFFFFFFFF)).view(np.intp)
    squares = (keys >> np.uint64(32)).astype(np.uint32).view(np.float32)
    # A point is its own nearest neighbour; points at the same distance may come before it.
    found[np.arange(len(own)), (found == own[:, None]).argmax(axis=1)] = found[:, 0]
    return found[:, 1:], squares[:, 1:]
