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

from ...workers import in_order
from .cells import Cells, fine_cell_size

#: Distances computed per batch, few enough for temporaries to stay in the processor's cache.
_BLOCK = 1 << 17

#: A block of cells with fewer candidates than this many times k is skipped: on a surface about a third of the block's
#: points lie in the ball that is certain to be complete.
_WORTH_LOOKING = 2.5

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
    size = fine_cell_size(positions, (count + 1) / 2)
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
    queries = queries[np.argsort(candidates[cells.cell_of_query[queries]], kind="stable")]

    def look(part: slice) -> int:
        """The number of queries whose neighbours are certain; parts write to rows of their own."""
        of = queries[part]
        found, square = _nearest_in_block(cells, of, count)
        has_all = candidates[cells.cell_of_query[of]] == len(cells.order)
        good = has_all | (square[:, -1] < cells.certain_squares(of))
        rows = cells.queries[of[good]]
        neighbours[rows] = found[good]
        distances[rows] = np.sqrt(square[good], dtype=np.float64) * cells.size
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
    """(q, k) point indices and (q, k) float32 squared distances, in cells, of the nearest candidates."""
    # Queries of one cell are consecutive and share candidates.
    changes = np.flatnonzero(np.diff(cells.cell_of_query[queries], prepend=-1))
    repeats = np.diff(changes, append=len(queries))
    candidates = cells.candidates(cells.cell_of_query[queries[changes]])
    squared = np.zeros((len(queries), candidates.shape[1]))
    for column, at in zip(cells.columns, cells.query_columns, strict=True):
        away = np.repeat(column[candidates], repeats, axis=0)
        away -= at[queries, None]
        away *= away
        squared += away
    own = cells.place_of_query[queries]
    places, squares = _smallest(squared, np.repeat(candidates, repeats, axis=0), own, count)
    return cells.order[places], squares


def _smallest(squared: np.ndarray, places: np.ndarray, own: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The `count` nearest places of each of q queries, nearest first, and their squared distances.

    squared: (q, m) squared distances to the candidates. places: (q, m) which candidates these are. own: (q,) the place
        of the query itself, which is left out.
    The bits of non-negative float32 values sort like the values. A squared distance and its place are therefore packed
    into one 64-bit integer, and these integers are sorted.
    """
    with np.errstate(over="ignore"):
        squared = squared.astype(np.float32)
    keys = squared.view(np.uint32).astype(np.uint64)
    keys <<= np.uint64(32)
    keys |= places.astype(np.uint64)
    keys = np.partition(keys, count, axis=1)[:, : count + 1]
    keys.sort(axis=1)
    found = (keys & np.uint64(0xFFFFFFFF)).astype(np.intp)
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
