# SPDX-License-Identifier: GPL-3.0-or-later
"""The k nearest neighbours of all points at once, in numpy: those that a k-d tree finds.

Points are sorted into cubic cells; a point's neighbours are sought in its own cell and the 26 around it. They are final
if the k-th is no farther than the nearest face of that block. The remaining points go on to cells twice as large. Those
that then remain, strays and sparse regions, are first compared with one point of each cell: this tells how far their
neighbours are at most, and therefore in which cells.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from ...runs import ranges, sorted_with_order
from ...workers import in_order
from .cells import Cells, fine_cell_size
from .distances import CUT_OFF, Block, exactly_nearest

#: Distances computed per batch: fewer would spend more on calls, more would leave the processor's cache.
_BLOCK = 1 << 18

#: Points in a cell, as a share of the neighbours sought and the point itself, and the least, itself included.
_COMPANY, _LEAST_COMPANY = 0.4, 2.0

#: Sizes of cells before points are compared with one of each cell.
_SIZES = 2

#: A block of cells with fewer candidates than this many times k is skipped: on a surface about a third of the block's
#: points lie in the ball that is certain to be complete.
_WORTH_LOOKING = 2.5

#: Blocks whose numbers of candidates agree to this are compared in one batch.
_ALIKE = 8

#: By how much distances in float32, in units, are increased where nothing may be missed: their share, and in all.
_ROUNDING = 1 + 1e-5, 1e-5

#: The last few points, usually far from all others, are compared with every point, which is cheaper than searching
#: larger cells: at least and at most this many points, and this many comparisons in between.
_FEW, _MORE = 16, 256
_FEW_COMPARISONS = 1 << 21


def nearest_neighbours(
    positions: np.ndarray, count: int, report: Callable[[float], None] = lambda share: None
) -> tuple[np.ndarray, np.ndarray]:
    """(N, k) int32 indices and (N, k) float32 distances of each point's nearest neighbours, nearest first.

    positions: (N, 3) float64, finite and pairwise different. count: k, at most N - 1. Neighbours whose distances agree
        to 4 digits are in any order. report: called with the share of the points that are finished.
    Raises ValueError if there are too few points.
    """
    total = len(positions)
    if not 1 <= count < total:
        raise ValueError(f"{total} points do not have {count} neighbours each; ask for 1 to {total - 1}.")
    found = _Found(np.empty((total, count), np.int32), np.empty((total, count), np.float32))
    size = first = fine_cell_size(positions, max((count + 1) * _COMPANY, _LEAST_COMPANY))
    waiting, few = np.arange(total), np.clip(_FEW_COMPARISONS // total, _FEW, _MORE)
    thinned = None
    while len(waiting) > few:
        if size < first * 2**_SIZES:
            searched = cells = Cells(positions, size, waiting)
            look = partial(_among_all, found, cells)
        else:
            thinned = thinned or _Thinned(positions, cells, waiting)
            searched = Cells(thinned.positions, size, np.searchsorted(thinned.points, waiting))
            look = partial(_among_thinned, found, thinned, searched)
        done = total - len(waiting)
        is_found = _searched(searched, count, look, lambda more, done=done: report((done + more) / total))
        waiting = waiting[~is_found]
        size *= 2
    _compare_with_all(positions, waiting, found)
    return found.neighbours, found.distances


@dataclass(frozen=True, eq=False)
class _Found:
    """(N, k) each, as `nearest_neighbours` returns them."""

    neighbours: np.ndarray
    distances: np.ndarray

    @property
    def count(self) -> int:
        return self.neighbours.shape[1]

    def keep(self, points: np.ndarray, neighbours: np.ndarray, squares: np.ndarray, unit: float):
        """squares: of distances, in units."""
        self.neighbours[points] = neighbours
        self.distances[points] = np.sqrt(squares) * np.float32(unit)


class _Thinned:
    """One point of each cell, those that wait, and those so far away that cells have no size.

    points: (n,) their indices, ascending; positions: (n, 3). first, counts: (n,) the places in `cells` of the points
    that each stands for. diagonal: farthest distance of these from it.
    """

    def __init__(self, positions: np.ndarray, cells: Cells, waiting: np.ndarray):
        of_cells = cells.order[cells.first[:-1]]
        self.cells = cells
        self.points = np.unique(np.concatenate([of_cells, waiting, cells.far_points]))
        self.positions = positions[self.points]
        self.first, self.counts = cells.place_of_point[self.points], np.zeros(len(self.points), np.intp)
        self.counts[np.searchsorted(self.points, of_cells)] = np.diff(cells.first)
        self.counts[np.searchsorted(self.points, cells.far_points)] = 1
        self.diagonal = math.sqrt(3) * cells.size * cells.unit


def _searched(
    cells: Cells, count: int, look: Callable[[np.ndarray], np.ndarray], report: Callable[[int], None]
) -> np.ndarray:
    """(Q,) bool: for which of the queries everything was found. look: called with some of them, in threads; returns for
    which it was. report: called with their number so far."""
    candidates, certain = cells.candidate_counts, np.zeros(len(cells.queries), bool)
    worth = min(_WORTH_LOOKING * (count + 1), len(cells.order))
    # Points in the last cells may be far from others in the same cell.
    queries = np.flatnonzero((candidates[cells.cell_of_query] >= worth) & ~cells.is_far)
    own = cells.cell_of_query[queries]
    likeness = candidates // _ALIKE
    order, _ = sorted_with_order(likeness[own] * len(candidates) + own, (likeness.max(initial=0) + 1) * len(candidates))
    queries = queries[order]

    def job(part: slice) -> int:
        good = certain[queries[part]] = look(queries[part])
        return np.count_nonzero(good)

    done = 0
    for more in in_order(partial(job, part) for part in _blocks(candidates[cells.cell_of_query[queries]])):
        done += more
        report(done)
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


def _among_all(found: _Found, cells: Cells, queries: np.ndarray) -> np.ndarray:
    """Keep the neighbours of queries that are certain; which they are, (q,) bool. Others' rows stay."""
    places, squares = Block(cells, queries).nearest(found.count)
    good = squares[:, -1] < _certain_squares(cells, queries)
    found.keep(cells.queries[queries[good]], cells.order[places[good]], squares[good], cells.unit)
    return good


def _among_thinned(found: _Found, thinned: _Thinned, coarse: Cells, queries: np.ndarray) -> np.ndarray:
    """The same; coarse: of the thinned points, whose queries they are."""
    block, cells = Block(coarse, queries), thinned.cells
    farthest = np.sqrt(np.partition(block.squares, found.count, axis=1)[:, found.count], dtype=np.float64)
    reach = np.square(_ROUNDING[0] * farthest + _ROUNDING[1] + thinned.diagonal / coarse.unit)
    good = reach < _certain_squares(coarse, queries)
    rows = np.flatnonzero(good)
    if not len(rows):
        return good
    query, column = np.nonzero(block.squares[rows] <= reach[rows, None])
    near = coarse.order[block.candidates[block.row[rows[query]], column]]
    first, counts = thinned.first[near], thinned.counts[near]
    points = thinned.points[coarse.queries[queries[rows]]]
    totals = np.bincount(query, counts).astype(np.intp)
    # those with about as many candidates together
    sizes = np.frexp(totals)[1]
    for size in np.unique(sizes):
        of, own = sizes == size, points[sizes == size]
        runs = of[query]
        places = np.full((len(own), 1 << size), len(cells.order), np.int64)
        places[np.arange(1 << size) < totals[of, None]] = ranges(first[runs], counts[runs])
        places, squares = exactly_nearest(
            cells.columns, cells.place_of_point[own], places, found.count, coarse.unit / cells.unit
        )
        found.keep(own, cells.order[places], squares, coarse.unit)
    return good


def _certain_squares(cells: Cells, queries: np.ndarray) -> np.ndarray:
    """(q,) squared distance, in units, below which all points are candidates, at distances that are not cut off."""
    has_all = cells.candidate_counts[cells.cell_of_query[queries]] == len(cells.order)
    return np.where(has_all, CUT_OFF, cells.certain_squares(queries))


def _compare_with_all(positions: np.ndarray, queries: np.ndarray, found: _Found):
    columns = np.ascontiguousarray(positions.T)
    for query in queries:
        away = columns - columns[:, query, None]
        squared = np.einsum("in,in->n", away, away)
        squared[query] = np.inf
        nearest = np.argpartition(squared, found.count - 1)[: found.count]
        nearest = nearest[np.argsort(squared[nearest], kind="stable")]
        found.keep(query, nearest, squared[nearest], 1.0)
