# SPDX-License-Identifier: GPL-3.0-or-later
"""Normals of noisy points, and of points that lie on no surface, from wider neighbourhoods than a clean scan needs.

A point and its neighbours are fitted together with the neighbours of these: the moments of all these neighbourhoods are
added. Normals are then averaged with those of neighbours that are alike, which leaves creases sharp. How noisy a scan
is around a point tells the smoothest plane nearby: a crease roughens those that it runs through, noise all of them.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from ...vectors import unit
from ...workers import in_portions
from .normals import CHUNK, PAIRS, LocalPlanes, covariances, least_around, least_planes, thicknesses

#: Neighbours of noisy points, as a multiple of those of others.
WIDER = 1.5

#: The least roughness of this many planes is this many times below their mean, with noise alone.
_AROUND, _MEAN_OVER_LEAST = 16, 1.5

#: Standard deviation of noise, in spacings, from which normals are taken from wider neighbourhoods.
NOISY = 0.15

#: A normal is not to be trusted if more than this share of the variance around all neighbours is across their planes:
#: it is 0.03 to 0.05 with noise of half the spacing, and 0.06 to 0.17 for leaves.
_THICK = 0.055

#: Radians by which normals differ that are averaged with a weight of 0.6.
_ALIKE = 0.2

#: A point beside a crease takes a neighbour's plane if the own one has this many times its variance. Of these planes
#: the one with the least variance is taken, to which this share of the point's squared distance is added.
_WORSE, _OFF = 2.5, 0.3

#: Cosine below which normals are those of another side.
_OPPOSED = -0.8

#: Rounds in which untrusted normals take the mean of those around them that are alike, and then of all around them.
_ROUNDS_OF_ALIKE, _ROUNDS = 8, 2


def spacings(distances: np.ndarray) -> np.ndarray:
    """(N,) edge of a square with the mean area per point, from (N, k) distances of the neighbours, nearest first."""
    members = distances.shape[1] + 1
    return distances[:, -1] * math.sqrt(math.pi / members)


def noise_levels(roughness: np.ndarray, neighbours: np.ndarray) -> np.ndarray:
    """(N,) standard deviation of noise across the surface, from the (N,) roughness of planes."""
    return _MEAN_OVER_LEAST * least_around(roughness, neighbours[:, :_AROUND])


def smoothed_normals(
    positions: np.ndarray,
    planes: LocalPlanes,
    neighbours: np.ndarray,
    rows: np.ndarray,
    report: Callable[[float], None] = lambda share: None,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Normals of the noisy among N points.

    positions: (N, 3) float64. planes: of the points and their neighbours. neighbours: (N, k) indices, `WIDER` than
    those behind the planes. rows: (n,) ascending, the noisy points. report: called with the finished share.
    Returns (n, 3) unit normals in either direction, (n, 3) a point on each one's plane, relative to the noisy point,
    and (n,) bool, which of the normals are not to be trusted.
    """
    middles, thick, is_near = planes.middles + positions.T, *np.zeros((2, len(positions)), np.float32)
    is_near[rows] = is_near[neighbours[rows]] = 1
    near = np.flatnonzero(is_near)
    thick[near] = thicknesses(planes.moments[:, near])
    # rows of 32 bytes are gathered at once
    moments = np.zeros((len(thick), 8), np.float32)
    moments[:, : len(PAIRS)] = planes.moments.T
    directions, variances = np.ascontiguousarray(planes.normals.T, np.float32), planes.variances.astype(np.float32)
    wide = middles.copy()
    heights, is_thick = np.empty((len(rows), 3)), np.empty(len(rows), bool)

    def widened(part: slice):
        own = rows[part]
        near = np.concatenate([neighbours[own].T, own[None]]).astype(np.intp, order="C")
        mean, joined = _joined_moments(middles, moments, near)
        normals, variances[own] = least_planes(joined)
        directions[:, own], wide[:, own] = normals.T, mean
        heights[part] = mean.T - positions[own]
        is_thick[part] = thick.take(near).min(axis=0) > _THICK

    in_portions(len(rows), CHUNK // 2, widened, lambda share: report(0.5 * share))
    _take_better_planes(directions, positions.T, wide, variances, neighbours, rows[~is_thick])
    _average(
        directions, neighbours[:, :_AROUND], rows, _alike_or_opposite, report=lambda share: report(0.5 + 0.5 * share)
    )
    return unit(directions[:, rows].T.astype(np.float64)), heights, is_thick


def of_surroundings(normals: np.ndarray, neighbours: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """(n, 3) mean directions around some points, whose own normals are not to be trusted, so that they are lit as their
    surroundings. normals: (N, 3) unit, on their sides."""
    directions = np.ascontiguousarray(normals.T, np.float32)
    _average(directions, neighbours[:, :_AROUND], rows, _alike, _ROUNDS_OF_ALIKE)
    _average(directions, neighbours, rows, _not_opposed, _ROUNDS)
    return unit(directions[:, rows].T.astype(np.float64))


def _take_better_planes(
    directions: np.ndarray,
    places: np.ndarray,
    middles: np.ndarray,
    variances: np.ndarray,
    neighbours: np.ndarray,
    rows: np.ndarray,
):
    """Give some of (3, N) normals, in place, that of a neighbour whose plane fits its own neighbourhood much better: a
    neighbourhood that ends at a crease instead of crossing it (Kuwahara et al. 1976 do so in pictures).

    places, middles: (3, N) the points and where their planes are. variances: (N,) across the planes.
    """
    own = rows[variances[rows] > _WORSE * least_around(variances, neighbours)[rows]]
    made = np.empty((3, len(own)), np.float32)

    def taken(part: slice):
        at = np.ascontiguousarray(neighbours[own[part]].T).astype(np.intp)
        normals = [column.take(at) for column in directions]
        off = sum(n * (p[own[part]] - m.take(at)) for n, p, m in zip(normals, places, middles, strict=True))
        score = variances.take(at) + _OFF * off * off
        best = score.argmin(axis=0)[None]
        theirs = np.concatenate([np.take_along_axis(column, best, 0) for column in normals])
        is_worse = variances[own[part]] > _WORSE * variances.take(np.take_along_axis(at, best, 0)[0])
        made[:, part] = np.where(is_worse, theirs, directions[:, own[part]])

    in_portions(len(own), CHUNK // 2, taken)
    directions[:, own] = made


def _average(
    directions: np.ndarray,
    neighbours: np.ndarray,
    rows: np.ndarray,
    weights: Callable[[np.ndarray], np.ndarray],
    rounds: int = 1,
    report: Callable[[float], None] = lambda share: None,
):
    """Give some of (3, N) float32 unit normals, in place, the weighted mean of themselves and their neighbours'.

    neighbours: (N, k) indices. weights: of their cosines. report: called with the finished share of a round.
    """
    near, made = np.ascontiguousarray(neighbours[rows].T), np.empty((3, len(rows)), np.float32)

    def averaged(part: slice):
        at, own = near[:, part].astype(np.intp), directions[:, rows[part]]
        theirs = [column.take(at) for column in directions]
        cosine = theirs[0] * own[0]
        for column, mine in zip(theirs[1:], own[1:], strict=True):
            cosine += column * mine
        weight = weights(cosine)
        sums = own + np.stack([np.einsum("kn,kn->n", weight, column) for column in theirs])
        made[:, part] = sums / np.sqrt(np.maximum(np.einsum("in,in->n", sums, sums), np.float32(1e-30)))

    for _ in range(rounds):
        in_portions(len(rows), CHUNK, averaged, report)
        directions[:, rows] = made


def _alike(cosine: np.ndarray) -> np.ndarray:
    """Weights of normals that differ little."""
    return np.exp((cosine - 1) * np.float32(_ALIKE**-2))


def _alike_or_opposite(cosine: np.ndarray) -> np.ndarray:
    """The same, in either direction."""
    return np.copysign(_alike(np.abs(cosine)), cosine)


def _not_opposed(cosine: np.ndarray) -> np.ndarray:
    """All but those on the other side of a thin sheet, which face the other way."""
    return (cosine > _OPPOSED).astype(np.float32)


def _joined_moments(middles: np.ndarray, moments: np.ndarray, at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(3, n) mean and (6, n) float32 covariances of neighbourhoods taken together. middles: (3, M), moments: (M, 8)
    float32 of each, the last two 0; at: (m, n) which of them, the last one's middle near the others'."""
    centre = middles[:, at[-1]]
    away = [(column.take(at) - c).astype(np.float32) for column, c in zip(middles, centre, strict=True)]
    mean, between = covariances(away)
    within = moments.take(at, axis=0).sum(axis=0).T[: len(PAIRS)]
    return centre + mean, between + within / np.float32(len(at))
