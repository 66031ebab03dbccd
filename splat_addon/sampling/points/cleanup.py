# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds points that cannot be used or that stand alone: non-finite, duplicate and isolated points."""

from __future__ import annotations

import numpy as np

from ..mesh.cleaning import MAX_COORDINATE
from .normals import least_around, local_moments, thicknesses

#: A point is isolated if its neighbours are this many times as far from it as they are from theirs. In scans of even
#: density the ratio stays below 2; at a step to a quarter of the density it is 2.
ISOLATED_RATIO = 3.0

#: A small group of stray points is isolated too, if its neighbours are this many times as far as those of the median
#: point. A scanner's spacing grows with distance, to several times its median at most.
ISOLATED_FROM_ALL_RATIO = 20.0

#: From this many times on, a point is isolated if it lies on no surface: its neighbours fill space, or it belongs to a
#: small group far from all others. Sparse parts of a scan are flat and have no such gaps.
SPARSE_RATIO = 6.0

#: Neighbours of sparse points fill space if their variance across the plane that fits them best is more than this share
#: of the whole. It is 0 on a plane, with noise of half the typical spacing below 0.01 there, and of 17 random points in
#: a ball 0.19 on average and never below this (of 20,000).
_THICK = 0.03

#: A gap separates a group of at least this many points from its next neighbour, which is this many times as far as the
#: one before. One of 4,000 random points on a surface has such a gap.
_FEWEST_IN_GROUP, _GAP = 4, 4.0

#: A point lies off the surface if it is this many standard deviations of noise away from the plane of its neighbours,
#: and this many spacings, which the tip of a clean scan is not.
_OFF_NOISE, _OFF_SPACINGS = 3.3, 1.2

#: An odd number whose bits look random, that of Knuth's multiplicative hashing for 64 bits.
_MULTIPLIER = np.uint64(0x9E3779B97F4A7C15)

#: Points are overlapped by those of scanners at most this share of the distance away, whose scan is four times as
#: dense, if most of this many nearest neighbours are such points. With more, it would reach beyond the denser scan.
_NEARER, _OVERLAPPING = 0.5, 8


def finite_points(positions: np.ndarray) -> np.ndarray:
    """(N,) bool: whether all three coordinates are finite and of a usable magnitude; positions (N, 3)."""
    return np.logical_and.reduce([np.abs(column) <= MAX_COORDINATE for column in positions.T])


def first_of_each(positions: np.ndarray) -> np.ndarray:
    """(M,) ascending indices of the points that are not exact duplicates of an earlier one; positions (N, 3),
    finite."""
    suspects = np.flatnonzero(_share_a_hash(positions))
    # lexsort is stable, so the first of equal points stays first
    suspects = suspects[np.lexsort(positions[suspects].T)]
    repeats = (np.diff(positions[suspects], axis=0) == 0).all(axis=1)
    keep = np.ones(len(positions), bool)
    keep[suspects[1:][repeats]] = False
    return np.flatnonzero(keep)


def _share_a_hash(positions: np.ndarray) -> np.ndarray:
    """(N,) bool: which of (N, 3) positions may equal another; few others do."""
    hashes = np.zeros(len(positions), np.uint64)
    for column in positions.T:
        # 0 is added because it has two signs
        hashes ^= (column + 0.0).view(np.uint64)
        hashes *= _MULTIPLIER
        hashes ^= hashes >> np.uint64(32)
    found = np.sort(hashes)
    repeated = np.unique(found[1:][found[1:] == found[:-1]])
    if not len(repeated):
        return np.zeros(len(positions), bool)
    at = np.minimum(np.searchsorted(repeated, hashes), len(repeated) - 1)
    return repeated[at] == hashes


def isolated_points(positions: np.ndarray, neighbours: np.ndarray, distances: np.ndarray) -> np.ndarray:
    """(N,) bool: points that are far from their neighbours while these are close to others, sparse points off any
    surface, and points most of whose neighbours are such points.

    positions: (N, 3). neighbours, distances: (N, k) indices and distances, nearest first. Only ratios are compared, so
    a sparse region of a scan does not count as isolated.
    """
    mean = distances.mean(axis=1, dtype=np.float64)
    typical = np.median(mean)
    isolated = np.zeros(len(mean), bool)
    # the median is dear, and never below the least
    far = np.flatnonzero(mean > ISOLATED_RATIO * least_around(mean, neighbours))
    isolated[far] = mean[far] > ISOLATED_RATIO * np.median(mean[neighbours[far]], axis=1)
    isolated |= mean > ISOLATED_FROM_ALL_RATIO * typical
    sparse = np.flatnonzero((mean > SPARSE_RATIO * typical) & ~isolated)
    own = distances[sparse]
    has_gap = (own[:, _FEWEST_IN_GROUP - 1 :] > _GAP * own[:, _FEWEST_IN_GROUP - 2 : -1]).any(axis=1)
    isolated[sparse] = has_gap | (thicknesses(local_moments(positions, neighbours, sparse)[1]) > _THICK)
    return isolated | (isolated[neighbours].mean(axis=1) > 0.5)


def off_surface(heights: np.ndarray, noise: np.ndarray, spacing: np.ndarray, neighbours: np.ndarray) -> np.ndarray:
    """(N,) bool: points beside a surface that is smooth there.

    heights: (N,) above the plane of the neighbours. noise: (N,) standard deviation. spacing: (N,) between points.
    neighbours: (N, k) indices, nearest first. The spacing is that of the nearest neighbour, because a stray's own is
    large.
    """
    return heights > np.maximum(_OFF_NOISE * noise, _OFF_SPACINGS * spacing[neighbours[:, 0]])


def overlapped(positions: np.ndarray, scanners: np.ndarray, neighbours: np.ndarray) -> np.ndarray:
    """(N,) bool: points that add noise alone, because nearer scanners saw the same place more densely.

    positions, scanners: (N, 3), NaN where a scanner's place is unknown. neighbours: (N, k) indices.
    """
    ranges = np.linalg.norm(scanners - positions, axis=1)
    return (ranges[neighbours[:, :_OVERLAPPING]] < _NEARER * ranges[:, None]).mean(axis=1) > 0.5
