# SPDX-License-Identifier: GPL-3.0-or-later
"""What is seen of a cloud from places within it, as an indoor scanner sees a room."""

from __future__ import annotations

import numpy as np

from ...workers import in_order

#: Places that are tried, chosen far apart among this many middles between two points, which lie this many spacings or
#: more from the nearest of a few points.
_PLACES, _MIDDLES, _FEW, _FREE = 32, 400, 6000, 12.0

#: Another place is taken if it shows this share of the points for the first time.
_WORTH_TAKING = 1e-3

#: Cells along each edge of the six pictures around a place. A point is hidden if one in its own cell or the eight
#: around it is nearer by this many of their edges, or as much as from outside.
_CELLS, _BEHIND = 64, 3.0


def views_within(
    places: np.ndarray, wanted: np.ndarray, is_lonely: np.ndarray, spacing: float, least_behind: float
) -> tuple[np.ndarray, np.ndarray]:
    """(V, 3) places from which most of (N, 3) float32 points are seen, and (V, N) bool, which of them from each.

    wanted: (N,) bool, the points that are above all to be seen. is_lonely: (N,) bool, which of them hide nothing.
    spacing: between points. least_behind: a point that is farther than another one by less is not hidden by it.
    """
    tried, hiding = _free_places(places[~is_lonely], places[wanted], spacing), np.flatnonzero(~is_lonely)
    shown = list(in_order((lambda at=at: _seen_from(at, places, hiding, least_behind)) for at in tried))
    left, taken = np.ones(len(places), bool), []
    while shown:
        gains = [np.count_nonzero(left & seen) for seen in shown]
        best = int(np.argmax(gains))
        if gains[best] <= _WORTH_TAKING * len(places):
            break
        taken.append(best)
        left &= ~shown[best]
    return tried[taken], np.array([shown[k] for k in taken]).reshape(len(taken), len(places))


def _free_places(points: np.ndarray, wanted: np.ndarray, spacing: float) -> np.ndarray:
    """(P, 3) places between (n, 3) wanted points and any, away from all (N, 3) points and far apart."""
    random = np.random.default_rng(0)
    # squares of distances in single precision are off by more than a spacing in a large scan
    few = points[random.choice(len(points), min(_FEW, len(points)), replace=False)].astype(np.float64)
    middles = (few[random.integers(len(few), size=_MIDDLES)] + wanted[random.integers(len(wanted), size=_MIDDLES)]) / 2
    squares = (middles**2).sum(axis=1)[:, None] - 2 * (middles @ few.T) + (few**2).sum(axis=1)
    middles = middles[squares.min(axis=1) > (_FREE * spacing) ** 2]
    chosen, distances = [0], np.full(len(middles), np.inf)
    while len(chosen) < min(_PLACES, len(middles)):
        distances = np.minimum(distances, ((middles - middles[chosen[-1]]) ** 2).sum(axis=1))
        chosen.append(int(distances.argmax()))
    return (middles[chosen] if len(middles) else middles).astype(np.float32)


def _seen_from(at: np.ndarray, places: np.ndarray, hiding: np.ndarray, least_behind: float) -> np.ndarray:
    """(N,) bool: whether none of those in the rows `hiding` hides (N, 3) places from a point."""
    away = (places - at).T
    size = np.abs(away)
    axis = size.argmax(axis=0)
    face = 2 * axis + (np.take_along_axis(away, axis[None], 0)[0] < 0)
    largest = np.maximum(size.max(axis=0), np.float32(1e-20))
    # cells of equal angles, inside a border of empty ones
    across = (
        np.arctan(side / largest) for side in (np.where(axis == 0, *away[[1, 0]]), np.where(axis == 2, *away[1:]))
    )
    row, column = (np.clip((a * (4 / np.pi) + 1) * (_CELLS / 2), 0, _CELLS - 1).astype(np.int64) + 1 for a in across)
    edge = _CELLS + 2
    cells, distance = (face * edge + row) * edge + column, np.sqrt((away * away).sum(axis=0))
    nearest = np.full((6, edge, edge), np.inf, np.float32)
    np.minimum.at(nearest.reshape(-1), cells[hiding], distance[hiding])
    for _ in range(2):
        around = nearest.copy()
        np.minimum(around[:, 1:], nearest[:, :-1], out=around[:, 1:])
        np.minimum(around[:, :-1], nearest[:, 1:], out=around[:, :-1])
        nearest = np.ascontiguousarray(around.transpose(0, 2, 1))
    behind = np.maximum(np.float32(least_behind), np.float32(_BEHIND * np.pi / 2 / _CELLS) * distance)
    return distance < nearest.reshape(-1)[cells] + behind
