# SPDX-License-Identifier: GPL-3.0-or-later
"""Which side of each point is seen: from outside of the cloud, from many directions, or from within, if scanners stood
there. Where signs that neighbours hand on to each other are wrong, whole regions are, and those are seen."""

from __future__ import annotations

import numpy as np

from ...workers import in_order, in_portions
from .density import is_scanned_from_within
from .normals import CHUNK, least_around
from .within import views_within

#: Directions from which the cloud is seen.
_DIRECTIONS = 26

#: Edge of a cell of the pictures, in spacings, and the most cells along an edge of a picture. A point is hidden if
#: another one in its own cell or the eight around it is nearer by this many edges.
_CELL, _MOST_CELLS, _BEHIND = 4.0, 2048, 3.0

#: Radians by which normals differ that are counted together with a weight of 0.6.
_ALIKE = 0.25

#: Points whose neighbours are this many times as far as those of the densest neighbour are strays, which hide nothing.
_LONELY = 3.0

#: A cloud of which more than this share is hidden from outside is looked at from within as well. It is 0 to 0.011 for
#: scanned models, 0.05 to 0.2 for furnished rooms.
_HIDDEN = 0.02

#: Only views from within count if they hide at most this share of the points, and at most half of what is hidden from
#: outside, or density shows scanners there. Otherwise they count for what is hidden from outside.
_MOST_LEFT = 0.1


def seen_sides(
    positions: np.ndarray, normals: np.ndarray, neighbours: np.ndarray, spacing: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """(N,) float32 how much more is seen of the sides of points that normals face than of the others; and (N,) how much
    is seen of both.

    positions, normals: (N, 3), normals unit. neighbours: (N, k) indices. spacing: (N,) between points.
    """
    places, columns = np.float32(positions - positions.mean(axis=0)), np.ascontiguousarray(normals.T, np.float32)
    typical, extent = float(np.median(spacing)), float(np.ptp(places, axis=0).max())
    cell = max(_CELL * typical, extent / _MOST_CELLS)

    def look(direction: np.ndarray) -> np.ndarray:
        cosine = direction @ columns
        return _seen_from(direction, places, cell) * (cosine * np.abs(cosine))

    found = np.stack(list(in_order((lambda d=d: look(d)) for d in _directions())))
    is_lonely = spacing >= _LONELY * least_around(spacing, neighbours)
    hidden = _hidden(found == 0, places, cell, is_lonely)
    share, is_within = hidden.mean(), is_scanned_from_within(positions, normals, spacing)
    if is_within or share > _HIDDEN:
        wanted = hidden if share > _HIDDEN else ~is_lonely
        at, seen = views_within(places, wanted, is_lonely, typical, _BEHIND * cell)
        inner = np.zeros(seen.shape, np.float32)
        for row, place, shown in zip(inner, at, seen, strict=True):
            row[shown] = _votes(place, places[shown], columns[:, shown])
        left = np.count_nonzero(~seen.any(axis=0) & ~is_lonely) / len(places)
        count_alone = left <= (_MOST_LEFT if is_within else min(_MOST_LEFT, share / 2))
        found = inner if count_alone else np.concatenate([found, inner * hidden])
    return _counted(found, columns, neighbours)


def _hidden(unseen: np.ndarray, places: np.ndarray, cell: float, is_lonely: np.ndarray) -> np.ndarray:
    """(N,) bool: which of (N, 3) places are hidden from everywhere outside, though strays, (N,) bool, hide nothing.
    unseen: (D, N) bool, which are hidden from each direction with strays."""
    hidden = unseen.all(axis=0) & ~is_lonely
    if hidden.mean() > _HIDDEN:
        rows = np.flatnonzero(~is_lonely)
        others = places[rows]
        for seen in in_order((lambda d=d: _seen_from(d, others, cell)) for d in _directions()):
            hidden[rows[seen]] = False
    return hidden


def _counted(found: np.ndarray, columns: np.ndarray, neighbours: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The results of `seen_sides` from (V, N) votes of views, with those of neighbours that are alike. columns: (3, N)
    normals."""
    votes, seen = found.sum(axis=0), np.abs(found).sum(axis=0)
    sides, both = np.empty(len(votes), np.float32), np.empty(len(votes), np.float32)

    def count(some: slice):
        at = neighbours[some].T.astype(np.intp, order="C")
        cosine = sum(column.take(at) * column[some] for column in columns)
        weight = np.exp((np.abs(cosine) - 1) / np.float32(_ALIKE**2))
        both[some] = seen[some] + np.einsum("kn,kn->n", weight, seen.take(at))
        sides[some] = votes[some] + np.einsum("kn,kn->n", np.copysign(weight, cosine), votes.take(at))

    in_portions(len(votes), CHUNK, count)
    return sides, both


def _votes(at: np.ndarray, places: np.ndarray, columns: np.ndarray) -> np.ndarray:
    """(N,) cosines between normals, (3, N), and the directions from (N, 3) places to a point, squared with their
    signs."""
    towards = (at - places).T
    squares = np.maximum((towards * towards).sum(axis=0), np.float32(1e-30))
    cosine = (towards * columns).sum(axis=0)
    return cosine * np.abs(cosine) / squares


def _directions() -> np.ndarray:
    """(D, 3) float32 unit vectors, spread evenly: a spiral whose turns are golden angles."""
    steps = np.arange(_DIRECTIONS) + 0.5
    height, angle = 1 - 2 * steps / _DIRECTIONS, np.pi * (1 + np.sqrt(5)) * steps
    across = np.sqrt(1 - height * height)
    return np.stack([np.cos(angle) * across, np.sin(angle) * across, height], axis=1).astype(np.float32)


def _seen_from(direction: np.ndarray, places: np.ndarray, cell: float) -> np.ndarray:
    """(N,) bool: whether nothing hides (N, 3) places from far away in a direction."""
    aside = np.cross(direction, np.eye(3, dtype=np.float32)[np.abs(direction).argmin()])
    aside /= np.linalg.norm(aside)
    aside /= np.float32(cell)
    u, v, height = np.stack([aside, np.cross(direction, aside), direction]) @ places.T
    for along in (u, v):
        # a border of empty cells
        along -= along.min() - 1
    row, column = u.astype(np.int32), v.astype(np.int32)
    nearest = np.full((row.max() + 2, column.max() + 2), -np.inf, np.float32)
    row *= nearest.shape[1]
    row += column
    cells = row.astype(np.intp)
    np.maximum.at(nearest.reshape(-1), cells, height)
    for _ in range(2):
        around = nearest.copy()
        np.maximum(around[1:], nearest[:-1], out=around[1:])
        np.maximum(around[:-1], nearest[1:], out=around[:-1])
        nearest = np.ascontiguousarray(around.T)
    return height > nearest.reshape(-1)[cells] - np.float32(_BEHIND * cell)
