# SPDX-License-Identifier: GPL-3.0-or-later
"""Estimates normals of bare points: the direction in which a point and its neighbours vary least.

Hoppe et al. 1992, section 3.2. The sign is undetermined; `orientation` chooses it.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

#: Points per batch, few enough for temporaries to stay in the processor's cache.
CHUNK = 8192

#: If the sine of the angle between rows of the shifted matrix is below this, its kernel is found by an iterative
#: solver.
_DOUBTFUL = 1e-6


def plane_normals(
    positions: np.ndarray, neighbours: np.ndarray, report: Callable[[float], None] = lambda share: None
) -> np.ndarray:
    """(N, 3) float64 unit normals of the planes that fit each point and its neighbours best, in either direction.

    positions: (N, 3) float64. neighbours: (n, k) indices of the first n points' neighbours; n may be below N.
    report: called with the finished share.
    Collinear neighbours have no unique plane; any direction perpendicular to the line is returned.
    """
    normals = np.empty((len(neighbours), 3))
    columns = np.ascontiguousarray(positions.T)
    for start in range(0, len(neighbours), CHUNK):
        part = slice(start, min(start + CHUNK, len(neighbours)))
        normals[part] = least_directions(_covariances(columns, neighbours[part], part))
        report(part.stop / len(neighbours))
    return normals


def thicknesses(positions: np.ndarray, neighbours: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """(n,) share of the variance of a point and its neighbours that is across their best plane: 0 to 1/3.

    positions: (N, 3) float64. neighbours: (N, k) indices. rows: (n,) the points.
    """
    columns, shares = np.ascontiguousarray(positions.T), np.empty(len(rows))
    for start in range(0, len(rows), CHUNK):
        part = rows[start : start + CHUNK]
        moments = _covariances(columns, neighbours[part], part)
        x, y, z = least_directions(moments).T
        shares[start : start + CHUNK] = sum(moments * (x * x, y * y, z * z, 2 * y * z, 2 * x * z, 2 * x * y))
    return shares


def _covariances(columns: np.ndarray, neighbours: np.ndarray, part: slice | np.ndarray) -> np.ndarray:
    """(6, n) covariances xx, yy, zz, yz, xz, xy of each point with its neighbours, scaled to a trace of about 1."""
    away = [column[neighbours] - column[part, None] for column in columns]
    members = neighbours.shape[1] + 1
    means = [a.sum(axis=1) / members for a in away]

    def moment(i, j):
        return np.einsum("nk,nk->n", away[i], away[j]) / members - means[i] * means[j]

    moments = np.stack([moment(*pair) for pair in ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))])
    trace = moments[:3].sum(axis=0)
    return moments / np.where(trace > 0, trace, 1)


def least_directions(moments: np.ndarray) -> np.ndarray:
    """(n, 3) unit eigenvectors of the least eigenvalue of symmetric 3 x 3 matrices.

    The eigenvalue comes from Smith's trigonometric formula (1961), the vector is the longest cross product of two rows
    of the matrix minus the eigenvalue; this takes a tenth of LAPACK's time for small matrices. If all three cross
    products are short, because two eigenvalues are nearly equal, LAPACK is used.
    """
    xx, yy, zz, yz, xz, xy = moments
    shift = (xx + yy + zz) / 3
    a, b, c = xx - shift, yy - shift, zz - shift
    size = np.sqrt((a * a + b * b + c * c + 2 * (yz * yz + xz * xz + xy * xy)) / 6)
    determinant = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz)
    with np.errstate(invalid="ignore", divide="ignore"):
        cosine = np.nan_to_num(np.clip(determinant / (2 * size**3), -1, 1))
    least = 2 * size * np.cos(np.arccos(cosine) / 3 + 2 * np.pi / 3)
    rows = np.stack([np.stack([a - least, xy, xz]), np.stack([xy, b - least, yz]), np.stack([xz, yz, c - least])])
    crosses = np.stack([np.cross(rows[i], rows[j], axis=0) for i, j in ((0, 1), (1, 2), (2, 0))])
    squares = np.einsum("ijn,ijn->in", crosses, crosses)
    longest = squares.argmax(axis=0)
    every = np.arange(len(longest))
    vectors, square = crosses[longest, :, every], squares[longest, every]
    doubtful = np.flatnonzero(~(square > _DOUBTFUL**2 * size**4) | (square == 0))
    vectors = vectors / np.sqrt(np.where(square > 0, square, 1))[:, None]
    if len(doubtful):
        matrices = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])[:, :, doubtful].transpose(2, 0, 1)
        vectors[doubtful] = np.linalg.eigh(matrices)[1][:, :, 0]
    return vectors


def tangent_frames(normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Two (N, 3) unit vectors that make a right-handed frame with unit normals (Duff et al. 2017)."""
    x, y, z = normals.T
    sign = np.copysign(1.0, z)
    a = -1 / (sign + z)
    b = x * y * a
    return np.stack([1 + sign * x * x * a, sign * b, -sign * x], 1), np.stack([b, sign + y * y * a, -y], 1)
