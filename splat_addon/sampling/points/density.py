# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a scan's density shows scanners among its points: it falls with the square of the distance from them."""

from __future__ import annotations

import numpy as np

#: Points that are looked at, places from which the search starts, places that are sought, steps for each of them, and
#: moves that a step tries.
_POINTS, _STARTS, _PLACES, _STEPS, _MOVES = 800, 150, 5, 120, 8

#: Density that varies less (mean difference of logarithms, each at most `_MOST`) shows no place: it is 0.17 to 0.4 for
#: scanned models and terrain, and 0.65 to 0.75 in rooms.
_VARIES, _MOST = 0.45, 1.5

#: Places explain the density if no more than this share of its variation is left: 0.3 to 0.6 in rooms with up to four
#: places, 0.8 to 1.2 for scanned models.
_LEFT = 0.65

#: Least cosine between a normal and the direction to a scanner.
_STEEP = 0.05


def is_scanned_from_within(positions: np.ndarray, normals: np.ndarray, spacing: np.ndarray) -> bool:
    """Whether a few places among (N, 3) points explain how dense these are.

    normals: (N, 3) unit, in either direction. spacing: (N,) between points, each with its neighbours.
    """
    random = np.random.default_rng(0)
    some = random.choice(len(positions), min(_POINTS, len(positions)), replace=False)
    points, directions, density = positions[some], normals[some], -2 * np.log(spacing[some])
    cells = _cells(points)
    constant = _spread(density, np.zeros((1, len(some))), cells)[0]
    if constant < _VARIES:
        return False
    starts = positions[random.integers(len(positions), size=(2, _STARTS))].mean(axis=0)
    size, places, parts = np.ptp(points, axis=0), np.empty((0, 3)), np.empty((0, len(some)))
    for _ in range(_PLACES):
        found = _densities(starts, points, directions)
        least = _spread(density, np.log(parts.sum(axis=0) + found), cells)
        best = int(least.argmin())
        places, parts, left = np.vstack([places, starts[best]]), np.vstack([parts, found[best]]), least[best]
        for step in range(_STEPS):
            # every second step moves the newest place, the others any
            moved = random.integers(len(places)) if step % 2 else len(places) - 1
            reach = 0.15 * size * np.exp(-4 * step / _STEPS)
            tried = places[moved] + reach * random.normal(size=(_MOVES, 3))
            found = _densities(tried, points, directions)
            least = _spread(density, np.log(np.delete(parts, moved, axis=0).sum(axis=0) + found), cells)
            best = int(least.argmin())
            if least[best] < left:
                left, places[moved], parts[moved] = least[best], tried[best], found[best]
        if left < _LEFT * constant:
            return True
    return False


def _densities(places: np.ndarray, points: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """(P, n) points per area of scanners at (P, 3) places, relative to each other, without occlusion."""
    towards = places[:, None] - points
    squares = np.maximum(np.einsum("pnc,pnc->pn", towards, towards), 1e-300)
    cosines = np.abs(np.einsum("pnc,nc->pn", towards, normals)) / np.sqrt(squares)
    return np.maximum(cosines, _STEEP) / squares


def _cells(points: np.ndarray) -> np.ndarray:
    """(n, c) which cell each of (n, 3) points is in, of thirds of the box, divided by the root of its members."""
    low, size = points.min(axis=0), np.ptp(points, axis=0)
    thirds = np.minimum((points - low) * (3 / np.where(size > 0, size, 1)), 2).astype(np.int64)
    _, cell, members = np.unique(thirds @ (9, 3, 1), return_inverse=True, return_counts=True)
    return np.eye(len(members))[cell] / np.sqrt(members)


def _spread(density: np.ndarray, predicted: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """(P,) mean difference of logarithms of (n,) densities and (P, n) predicted ones, apart from a factor in each cell:
    things beside each other may differ in density. cells: of `_cells`."""
    off = density - predicted
    off -= (off @ cells) @ cells.T
    return np.minimum(np.abs(off), _MOST).mean(axis=1)
