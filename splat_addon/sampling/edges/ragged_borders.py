# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the two lines that best approximate a border of many short edges in one splat, judged at points all over it.

A place in the circle belongs to the surface if it is inside of the edge that is nearest to it. The first line is that
of the surfel's nearest edge; each other one is tried as its second, at a convex and at a reflex corner, and none.
"""

from __future__ import annotations

import numpy as np

#: The points at which a splat is judged: rings in the unit circle.
_RINGS = ((0.35, 4), (0.7, 7), (0.95, 11))

#: Edges per batch.
_CHUNK = 2048


def two_lines(start: np.ndarray, end: np.ndarray, line: np.ndarray, owner: np.ndarray):
    """For each of n surfels which of its edges gives the second line, (n,) by number among the m given ones; and (n,)
    what the lines keep: 0 the first one's side, 1 that of both, 2 that of either, 3 all.

    start, end: (2, m) float32 in the circle. line: (3, m). owner: (m,) ascending, 0 to n - 1; a surfel's first edge is
    its nearest.
    """
    starts = np.flatnonzero(np.append(True, owner[1:] != owner[:-1]))
    parts = []
    # In small batches, whose points stay in the processor's cache.
    stops = np.append(np.searchsorted(starts, np.arange(0, len(owner), _CHUNK)), len(starts))
    for low, high in zip(stops[:-1].tolist(), stops[1:].tolist(), strict=True):
        if high > low:
            rows = slice(int(starts[low]), int(starts[high]) if high < len(starts) else len(owner))
            best, kind = _judged(start[:, rows], end[:, rows], line[:, rows], owner[rows] - low)
            parts.append((best + rows.start, kind))
    return tuple(np.concatenate(found) for found in zip(*parts, strict=True))


def _judged(start, end, line, owner) -> tuple[np.ndarray, np.ndarray]:
    places, weights = _places()
    starts = np.flatnonzero(np.append(True, owner[1:] != owner[:-1]))
    inside, distance = _inside_of_each(start, end, line, places)
    is_nearest = distance == np.minimum.reduceat(distance, starts, axis=1).take(owner, axis=1)
    belongs = np.logical_and.reduceat(inside | ~is_nearest, starts, axis=1).take(owner, axis=1)
    first = inside.take(starts, axis=1).take(owner, axis=1)
    shown = first, first & inside, first | inside, np.True_
    wrongs = np.stack([weights @ (kept != belongs).astype(np.float32) for kept in shown], axis=1)
    # One line if a second gains nothing.
    wrongs[:, 0] -= 1e-4
    kind = wrongs.argmin(axis=1)
    order = np.lexsort((wrongs.min(axis=1), owner))
    best = order[starts]
    return best, kind[best]


def _places() -> tuple[np.ndarray, np.ndarray]:
    """(2, p) float32 points in the unit circle, and (p,) the weight of the splat around each."""
    angles = [(np.arange(count) + 0.5) * 2 * np.pi / count for _, count in _RINGS]
    places = [radius * np.stack([np.cos(a), np.sin(a)]) for (radius, _), a in zip(_RINGS, angles, strict=True)]
    weights = [np.full(count, radius * np.exp(-2 * radius**2) / count) for radius, count in _RINGS]
    weights = np.concatenate(weights)
    return np.concatenate(places, axis=1).astype(np.float32), (weights / weights.sum()).astype(np.float32)


def _inside_of_each(start, end, line, places) -> tuple[np.ndarray, np.ndarray]:
    """(p, m) bool, whether each place is inside of each edge's line, and (p, m) how far the edge is from it, squared.

    At an end that two edges share, both are as far, and the one whose line is farther off is right: it counts as a
    little nearer.
    """
    (x, y), (u, v) = start, end - start
    inverse = 1 / np.maximum(u * u + v * v, np.float32(1e-30))
    px, py = places[..., None]
    across, distance = line[0] * px, px - x
    across += line[1] * py
    across += line[2]
    to_y = py - y
    share = distance * (u * inverse)
    share += to_y * (v * inverse)
    np.clip(share, 0, 1, out=share)
    distance -= share * u
    to_y -= share * v
    distance *= distance
    to_y *= to_y
    distance += to_y
    distance -= np.float32(1e-4) * across * across
    return across >= 0, distance
