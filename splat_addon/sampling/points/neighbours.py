# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact k nearest neighbours of all points at once, in numpy: the same result as a k-d tree.

Points are sorted into cubic cells; a point's neighbours are sought in its own cell and the 26 around it. They are final
if the k-th is no farther than the nearest face of that block. The remaining points go on to cells twice as large, so
dense regions finish with small cells and sparse ones with large cells.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from ...runs import steps
from ...workers import in_order
from .cells import Cells, fine_cell_size

#: Distances computed per batch: fewer would spend more on calls, more would leave the processor's cache.
_BLOCK = 1 << 18

#: Points in a cell, as a share of the neighbours sought and the point itself.
_COMPANY = 0.4

#: A block of cells with fewer candidates than this many times k is skipped: on a surface about a third of the block's
#: points lie in the ball that is certain to be complete.
_WORTH_LOOKING = 2.5

#: Blocks whose numbers of candidates agree to this are compared in one batch, those with as many queries in the middle
#: cell beside each other.
_ALIKE, _MOST_QUERIES = 8, 255

#: How many neighbours more than are wanted are chosen by approximate distances.
_SPARE = 3

#: Approximate squared distances, in units of the cells, are this inexact, with offsets of up to four units along each
#: axis; they are increased by as much, so that none is negative.
_INEXACT = np.float32(4e-5)

#: Offsets from a point of the cell, in units, that are not told apart beyond this.
_FARTHEST = 6.0

#: The last few points, usually far from all others, are compared with every point, which is cheaper than searching
#: larger cells: at least and at most this many points, and this many comparisons in between.
_FEW, _MORE = 16, 256
_FEW_COMPARISONS = 1 << 23


def nearest_neighbours(
    positions: np.ndarray, count: int, report: Callable[[float], None] = lambda share: None
) -> tuple[np.ndarray, np.ndarray]:
    """(N, k) int32 indices and (N, k) float32 distances of each point's nearest neighbours, nearest first.

    positions: (N, 3) float64, finite and pairwise different. count: k, at most N - 1. Distances are compared in
        float32, so the order of neighbours whose distances agree to 7 digits is arbitrary. report: called with the
        share of the points that are finished.
    Raises ValueError if there are too few points.
    """
    total = len(positions)
    if not 1 <= count < total:
        raise ValueError(f"{total} points do not have {count} neighbours each; ask for 1 to {total - 1}.")
    neighbours, distances = np.empty((total, count), np.int32), np.empty((total, count), np.float32)
    size = fine_cell_size(positions, (count + 1) * _COMPANY)
    waiting = np.arange(total)
    few = np.clip(_FEW_COMPARISONS // total, _FEW, _MORE)
    while len(waiting) > few:
        cells = Cells(positions, size, waiting)
        done = total - len(waiting)
        found = _search(cells, count, neighbours, distances, lambda more, done=done: report((done + more) / total))
        waiting = waiting[~found]
        size *= 2
    _compare_with_all(positions, waiting, count, neighbours, distances)
    return neighbours, distances


def _search(
    cells: Cells, count: int, neighbours: np.ndarray, distances: np.ndarray, report: Callable[[int], None]
) -> np.ndarray:
    """Fill the rows of those queries whose neighbours are certain; returns which they are, (Q,) bool.

    report: called regularly with their number.
    """
    candidates = cells.candidate_counts()
    certain = np.zeros(len(cells.queries), bool)
    worth = min(_WORTH_LOOKING * (count + 1), len(cells.order))
    # Points in the last cells may be far from others in the same cell.
    queries = np.flatnonzero((candidates[cells.cell_of_query] >= worth) & ~cells.is_far)
    own = cells.cell_of_query[queries]
    numbers = np.minimum(np.bincount(own, minlength=len(candidates)), _MOST_QUERIES)
    likeness = candidates // _ALIKE * (_MOST_QUERIES + 1) + numbers
    queries = queries[np.argsort(likeness[own], kind="stable")]

    def look(part: slice) -> int:
        """The number of queries whose neighbours are certain; parts write to rows of their own."""
        of = queries[part]
        found, square = _nearest_in_block(cells, of, count)
        has_all = candidates[cells.cell_of_query[of]] == len(cells.order)
        good = has_all | (square[:, -1] < cells.certain_squares(of))
        rows = cells.queries[of[good]]
        neighbours[rows] = found[good]
        distances[rows] = np.sqrt(square[good], dtype=np.float64) * cells.unit
        certain[of] = good
        return int(np.count_nonzero(good))

    found_so_far = 0
    parts = _blocks(candidates[cells.cell_of_query[queries]])
    for found in in_order(partial(look, part) for part in parts):
        found_so_far += found
        report(found_so_far)
    return certain


def _blocks(costs: np.ndarray):
    """Slices of consecutive queries with about `_BLOCK` candidates in each; costs: (Q,) candidates, ascending."""
    ends = np.cumsum(costs, dtype=np.int64)
    start = 0
    while start < len(costs):
        done = ends[start - 1] if start else 0
        stop = max(int(np.searchsorted(ends, done + _BLOCK, "right")), start + 1)
        yield slice(start, stop)
        start = stop


def _nearest_in_block(cells: Cells, queries: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """(q, k) point indices and (q, k) float32 squared distances, in units, of the nearest candidates.

    A few more than are wanted are chosen by approximate distances, and the nearest of these by exact ones. Where the
    others may be as near, all candidates are compared exactly.
    """
    # Queries of one cell are consecutive and share candidates.
    first = np.flatnonzero(np.diff(cells.cell_of_query[queries], prepend=-1))
    numbers = np.diff(first, append=len(queries))
    candidates = cells.candidates(cells.cell_of_query[queries[first]])
    row, columns = np.repeat(np.arange(len(first)), numbers), candidates.shape[1]
    keys, mask = _approximate_squares(cells, queries, candidates, first, numbers), _column_bits(columns)
    most = min(count + _SPARE, columns - 1)
    keys = np.partition(keys, most, axis=1)[:, : most + 1]
    others = (keys[:, -1] & ~mask).view(np.float32) - 2 * _INEXACT
    keys &= mask
    places, squares = _smallest(cells, queries, candidates.ravel()[keys + (row * columns)[:, None]], count)
    doubtful = np.flatnonzero(~(squares[:, -1] < others))
    if len(doubtful) and most + 1 < columns:
        every = _smallest(cells, queries[doubtful], candidates[row[doubtful]], count)
        places[doubtful], squares[doubtful] = every
    return cells.order[places], squares


def _approximate_squares(
    cells: Cells, queries: np.ndarray, candidates: np.ndarray, first: np.ndarray, numbers: np.ndarray
) -> np.ndarray:
    """(q, m) uint32 squared distances of queries from their candidates, in units and too large by at most twice
    `_INEXACT`, as the bits of float32; the lowest bits of each are the candidate's column.

    candidates: (C, m). first, numbers: (C,) the queries in each cell. Products of matrices take a fifth of the time
    of differences.
    """
    corner = cells.columns[:, cells.place_of_query[queries[first]]]
    away = cells.columns.take(candidates, axis=1)
    away -= corner[:, :, None]
    # What is farther away is at no certain distance, however far.
    np.clip(away, -_FARTHEST, _FARTHEST, out=away)
    theirs = np.ones((len(first), 5, candidates.shape[1]), np.float32)
    theirs[:, :3] = away.swapaxes(0, 1)
    np.einsum("cim,cim->cm", theirs[:, :3], theirs[:, :3], out=theirs[:, 3])
    own = cells.columns[:, cells.place_of_query[queries]] - np.repeat(corner, numbers, axis=1)
    place = np.repeat(np.arange(len(first)) * numbers.max(), numbers) + steps(numbers)
    ours = np.zeros((len(first) * numbers.max(), 5), np.float32)
    ours[place] = np.stack([*(-2 * own), np.ones(len(queries)), _INEXACT + np.einsum("iq,iq->q", own, own)], axis=1)
    products = np.matmul(ours.reshape(len(first), -1, 5), theirs)
    keys = products.reshape(len(ours), -1).take(place, axis=0).view(np.uint32)
    keys &= ~_column_bits(candidates.shape[1])
    keys |= np.arange(candidates.shape[1], dtype=np.uint32)
    return keys


def _column_bits(columns: int) -> np.uint32:
    """The bits that number so many columns."""
    return np.uint32((1 << (columns - 1).bit_length()) - 1)


def _smallest(cells: Cells, queries: np.ndarray, places: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The `count` nearest places of each of q queries, nearest first, and their squared distances, in units.

    places: (q, m) the candidates; the query itself, which is among them, is left out.
    The bits of non-negative float32 values sort like the values. A squared distance and its place are therefore packed
    into one 64-bit integer, and these integers are sorted.
    """
    own = cells.place_of_query[queries]
    away = cells.columns.take(places, axis=1)
    away -= cells.columns.take(own, axis=1)[:, :, None]
    with np.errstate(over="ignore"):
        squared = np.einsum("iqm,iqm->qm", away, away).astype(np.float32)
    keys = squared.view(np.uint32).astype(np.uint64)
    keys <<= np.uint64(32)
    keys |= places.view(np.uint64)
    if places.shape[1] > count + _SPARE + 1:
        keys = np.partition(keys, count, axis=1)
    keys = keys[:, : count + 1 + _SPARE]
    keys.sort(axis=1)
    keys = keys[:, : count + 1]
    found = (keys & np.uint64(0xFFFFFFFF)).view(np.intp)
    squares = (keys >> np.uint64(32)).astype(np.uint32).view(np.float32)
    # A point is its own nearest neighbour; points at the same distance may come before it.
    found[np.arange(len(own)), (found == own[:, None]).argmax(axis=1)] = found[:, 0]
    return found[:, 1:], squares[:, 1:]


def _compare_with_all(positions, queries, count, neighbours, distances):
    for query in queries:
        squared = ((positions - positions[query]) ** 2).sum(axis=1)
        squared[query] = np.inf
        nearest = np.argpartition(squared, count - 1)[:count]
        nearest = nearest[np.argsort(squared[nearest], kind="stable")]
        neighbours[query], distances[query] = nearest, np.sqrt(squared[nearest])
