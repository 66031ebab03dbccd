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
from .normals import CHUNK, LocalPlanes, covariances, least_around, least_planes, thicknesses

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
    middles, thick = planes.middles + positions.T, thicknesses(planes.moments)
    moments = planes.moments.astype(np.float32)
    normals, heights, is_thick = planes.normals.copy(), np.empty((len(rows), 3)), np.empty(len(rows), bool)

    def widened(part: slice):
        own = rows[part]
        near = np.concatenate([neighbours[own].T, own[None]])
        mean, joined = _joined_moments(middles, moments, near)
        normals[own], _ = least_planes(joined)
        heights[part] = mean.T - positions[own]
        is_thick[part] = thick[near].min(axis=0) > _THICK

    in_portions(len(rows), CHUNK // 4, widened, lambda share: report(0.5 * share))
    _average(normals, neighbours[:, :_AROUND], rows, report=lambda share: report(0.5 + 0.5 * share))
    return normals[rows], heights, is_thick


def _average(
    normals: np.ndarray,
    neighbours: np.ndarray,
    rows: np.ndarray,
    *,
    report: Callable[[float], None] = lambda share: None,
    are_on_sides: bool = False,
):
    """Give some of (N, 3) unit normals, in place, the mean of themselves and those of their neighbours that are alike,
    in either direction unless they are on their sides. neighbours: (N, k) indices."""
    columns, made = np.ascontiguousarray(normals.T, np.float32), np.empty((len(rows), 3))

    def averaged(part: slice):
        own = rows[part]
        at = np.ascontiguousarray(neighbours[own].T)
        near = [column[at] for column in columns]
        cosine = sum(n * column[own] for n, column in zip(near, columns, strict=True))
        likeness = cosine if are_on_sides else np.abs(cosine)
        weight = np.exp((likeness - 1) / np.float32(_ALIKE**2))
        weight = weight if are_on_sides else np.copysign(weight, cosine)
        made[part] = unit(normals[own] + np.stack([np.einsum("kn,kn->n", weight, n) for n in near], axis=1))

    in_portions(len(rows), CHUNK, averaged, report)
    normals[rows] = made


def _joined_moments(middles: np.ndarray, moments: np.ndarray, at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(3, n) mean and (6, n) covariances of neighbourhoods taken together. middles: (3, M), moments: (6, M) of each;
    at: (m, n) which of them, the last one's middle near the others'."""
    centre = middles[:, at[-1]]
    mean, between = covariances([column[at] - c for column, c in zip(middles, centre, strict=True)])
    return centre + mean, between + np.stack([row[at].sum(axis=0) for row in moments]) / len(at)


def of_surroundings(normals: np.ndarray, neighbours: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """(n, 3) mean directions around some points, whose own normals are not to be trusted, so that they are lit as their
    surroundings. normals: (N, 3) unit, on their sides."""
    made = normals.copy()
    for _ in range(_ROUNDS_OF_ALIKE):
        _average(made, neighbours[:, :_AROUND], rows, are_on_sides=True)
    for _ in range(_ROUNDS):
        near = made[neighbours[rows]]
        # those on the other side of a thin sheet face the other way
        faces_alike = np.einsum("nkc,nc->nk", near, made[rows]) > _OPPOSED
        made[rows] = unit(np.einsum("nkc,nk->nc", near, faces_alike.astype(np.float64)) + made[rows])
    return made[rows]
