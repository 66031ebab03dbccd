# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the two lines that best approximate a border of many short edges in one splat, judged at points all over it.

A place in the circle belongs to the surface if it is inside of the edge that is nearest to it. The first line is that
of the surfel's nearest edge; each other one is tried as its second, at a convex and at a reflex corner, and none.
"""

from __future__ import annotations

from functools import cache

import numpy as np

#: The points at which a splat is judged: rings in the unit circle.
_RINGS = ((0.35, 4), (0.7, 7), (0.95, 11))

#: Edges per batch: their points stay in the processor's cache.
_CHUNK = 8192

#: Weights are multiples of this, so that their sums are exact in any order.
_UNIT = 2.0**-18

#: A second line must gain more than this share of the splat.
_LEAST_GAIN = round(1e-4 / _UNIT)

#: What two lines keep: the first one's side, the intersection of both sides, their union, or everything.
FIRST, BOTH, EITHER, ALL = range(4)


def two_lines(start: np.ndarray, end: np.ndarray, line: np.ndarray, owner: np.ndarray):
    """The best second line for each of n surfels: (n,) index of its edge among the m given ones; (n,) what the lines
    keep, one of `FIRST`, `BOTH`, `EITHER` and `ALL`; and (n,) bool, whether they keep a place beyond the border.

    start, end: (2, m) float32 in the circle. line: (3, m). owner: (m,) ascending, 0 to n - 1; a surfel's first edge is
    its nearest.
    """
    starts = np.flatnonzero(np.append(True, owner[1:] != owner[:-1]))
    counts = np.diff(np.append(starts, len(owner)))
    edges = np.concatenate([start, end - start, line])
    best, kind, beyond = (np.empty(len(starts), dtype) for dtype in (np.intp, np.intp, bool))
    # Surfels with equally many edges are judged together, because their edges then fill an array.
    for count in np.unique(counts):
        alike = np.flatnonzero(counts == count)
        step = max(_CHUNK // int(count), 1)
        for surfels in np.split(alike, range(step, len(alike), step)):
            rows = np.add.outer(np.arange(count), starts.take(surfels))
            chosen, kind[surfels], beyond[surfels] = _judged(edges.take(rows, axis=1))
            best[surfels] = starts.take(surfels) + chosen
    return best, kind, beyond


def _judged(edges: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """For each of n surfels, as `two_lines` returns it, and the best second edge among its k edges. edges: (7, k, n).

    A set of places is held in the bits of an integer.
    """
    inside, distance = _inside_of_each(edges, places()[0])
    belongs = (inside | (distance != distance.min(axis=1, keepdims=True))).all(axis=1)
    inside, belongs = _bits(inside), _bits(belongs)
    # The first edge with itself: its line alone, or everything.
    both, either = inside & inside[0], inside | inside[0]
    either[0] = _bits(np.ones(len(places()[1]), bool))
    wrongs = np.stack([_weight(both ^ belongs), _weight(either ^ belongs)], axis=1)
    # One line if a second gains nothing.
    wrongs[0, 0] -= _LEAST_GAIN
    found = wrongs.reshape(-1, wrongs.shape[2]).argmin(axis=0)
    kept = np.stack([both, either], axis=1).reshape(wrongs.shape[0] * 2, -1)
    beyond = (np.take_along_axis(kept, found[None], axis=0)[0] & ~belongs) != 0
    kind = np.where(found < 2, np.where(found == 0, FIRST, ALL), np.where(found % 2 == 0, BOTH, EITHER))
    return found // 2, kind, beyond


def _bits(sets: np.ndarray) -> np.ndarray:
    """(...) int32 from (p, ...) bool. A float32 holds as many bits exactly as there are places."""
    powers = np.exp2(np.arange(len(sets), dtype=np.float32))
    return (powers @ sets.reshape(len(sets), -1).astype(np.float32)).astype(np.int32).reshape(sets.shape[1:])


def _weight(sets: np.ndarray) -> np.ndarray:
    """(...) int32: what the places in each set weigh, looked up for a half of the bits at a time."""
    low, high = _weights_of_bits()
    return low.take(sets & (len(low) - 1)) + high.take(sets >> (len(low).bit_length() - 1))


@cache
def _weights_of_bits() -> np.ndarray:
    """(2, h) int32: the weights of the places whose bits are set in each number, from the lower and the upper half of
    the places."""
    weights = places()[1].astype(np.int32)
    half = len(weights) // 2
    bits = np.arange(1 << half) >> np.arange(half)[:, None] & 1
    return weights.reshape(2, half) @ bits.astype(np.int32)


@cache
def places() -> tuple[np.ndarray, np.ndarray]:
    """(2, p) float32 points in the unit circle, and (p,) the weight of the splat around each, in
    units."""
    angles = [(np.arange(count) + 0.5) * 2 * np.pi / count for _, count in _RINGS]
    places = [radius * np.stack([np.cos(a), np.sin(a)]) for (radius, _), a in zip(_RINGS, angles, strict=True)]
    weights = [np.full(count, radius * np.exp(-2 * radius**2) / count) for radius, count in _RINGS]
    weights = np.concatenate(weights)
    weights = np.rint(weights / (weights.sum() * _UNIT))
    return np.concatenate(places, axis=1).astype(np.float32), weights.astype(np.float32)


def _inside_of_each(edges: np.ndarray, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(p, m) bool: whether each place is inside each edge's line, and (p, m) its squared distance from the edge.

    At an end that two edges share, both distances are equal, but the edge whose line is farther off is right, so it
    counts as slightly nearer.
    """
    x, y, u, v, *line = edges
    inverse = 1 / np.maximum(u * u + v * v, np.float32(1e-30))
    px, py = places[..., None, None]
    across, distance = line[0] * px, px - x
    across += line[1] * py
    across += line[2]
    to_y = py - y
    share = distance * (u * inverse)
    share += to_y * (v * inverse)
    np.clip(share, 0, 1, out=share)
    distance -= share * u
    share *= v
    to_y -= share
    distance *= distance
    to_y *= to_y
    distance += to_y
    inside = across >= 0
    across *= across
    across *= np.float32(1e-4)
    distance -= across
    return inside, distance
