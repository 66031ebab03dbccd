# SPDX-License-Identifier: GPL-3.0-or-later
"""Estimates normals of bare points: the direction in which a point and its neighbours vary least.

Hoppe et al. 1992, section 3.2. The sign is undetermined; `orientation` chooses it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...workers import in_portions

#: Points per batch, few enough for temporaries to stay in the processor's cache.
CHUNK = 8192

#: Entries of a symmetric matrix in the order of `least_directions`.
PAIRS = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))

#: If the sine of the angle between rows of the shifted matrix is below this power of the arithmetic's precision, its
#: kernel is found by an iterative solver.
_DOUBTFUL = 0.4


@dataclass(frozen=True, eq=False)
class LocalPlanes:
    """The planes that fit N points and their neighbours best.

    normals: (N, 3) float64 unit, in either direction. middles: (3, N) float64 mean of the members, relative to the
    point. moments: (6, N) float64 covariances xx, yy, zz, yz, xz, xy of the members. variances: (N,) that across the
    plane. members: their number.
    """

    normals: np.ndarray
    middles: np.ndarray
    moments: np.ndarray
    variances: np.ndarray
    members: int

    def roughness(self) -> np.ndarray:
        """(N,) root mean square distance of the members from the plane, per degree of freedom."""
        return np.sqrt(self.variances * (self.members / max(self.members - 3, 1)))

    def heights(self) -> np.ndarray:
        """(N,) distance of each point from the plane through the mean of its neighbours."""
        off = np.abs(np.einsum("nc,cn->n", self.normals, self.middles))
        return off * (self.members / (self.members - 1))


def local_planes(
    positions: np.ndarray,
    neighbours: np.ndarray,
    rows: np.ndarray | None = None,
    report: Callable[[float], None] = lambda share: None,
) -> LocalPlanes:
    """positions: (N, 3) float64. neighbours: (n, k) indices of the first n points' neighbours; n may be below N.
    rows: the points whose planes are found; None: the first n. report: called with the finished share.
    Collinear neighbours have no unique plane; any one through the line is returned.
    """
    middles, moments = local_moments(positions, neighbours, rows, lambda share: report(0.6 * share))
    normals, variances = np.empty((moments.shape[1], 3)), np.empty(moments.shape[1])

    def job(part: slice):
        normals[part], variances[part] = least_planes(moments[:, part])

    in_portions(len(normals), CHUNK, job, lambda share: report(0.6 + 0.4 * share))
    return LocalPlanes(normals, middles, moments, variances, neighbours.shape[1] + 1)


def local_moments(
    positions: np.ndarray,
    neighbours: np.ndarray,
    rows: np.ndarray | None = None,
    report: Callable[[float], None] = lambda share: None,
) -> tuple[np.ndarray, np.ndarray]:
    """(3, N) middles and (6, N) moments as in `LocalPlanes`, from the arguments of `local_planes`."""
    count = len(neighbours) if rows is None else len(rows)
    middles, moments = np.empty((3, count)), np.empty((6, count))
    columns = np.ascontiguousarray(positions.T)

    def job(part: slice):
        own = part if rows is None else rows[part]
        middles[:, part], moments[:, part] = _moments(columns, neighbours[own], own)

    in_portions(count, CHUNK, job, report)
    return middles, moments


def thicknesses(moments: np.ndarray) -> np.ndarray:
    """(N,) share of the variance that is across the plane that fits best, 0 to 1/3, from (6, N) moments."""
    whole = moments[:3].sum(axis=0)
    return np.maximum(_least_values(moments / np.where(whole > 0, whole, 1))[0], 0)


def least_around(values: np.ndarray, neighbours: np.ndarray) -> np.ndarray:
    """(N,) the least value of each point and its neighbours."""
    least = values.copy()

    def job(part: slice):
        near = values.take(neighbours[part].T.astype(np.intp, order="C"))
        np.minimum(values[part], near.min(axis=0), out=least[part])

    in_portions(len(values), CHUNK, job)
    return least


def least_planes(moments: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(n, 3) unit normals of the planes that fit (6, n) covariances best, and (n,) the variances across them."""
    whole = moments[:3].sum(axis=0)
    normals = least_directions(moments / np.where(whole > 0, whole, 1))
    x, y, z = normals.T
    across = sum(moments * (x * x, y * y, z * z, 2 * y * z, 2 * x * z, 2 * x * y))
    return normals, np.maximum(across, 0)


def _moments(columns: np.ndarray, neighbours: np.ndarray, part: slice | np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(3, n) means and (6, n) covariances of each point with its neighbours, relative to it."""
    at = neighbours.T.astype(np.intp, order="C")
    away = [column.take(at) - column[part] for column in columns]
    return covariances(away, at_middle=1)


def covariances(away: list[np.ndarray], at_middle: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """(3, n) means and (6, n) covariances xx, yy, zz, yz, xz, xy of points. away: x, y and z, (m, n) each, of m points
    in n groups; at_middle: number of further ones at 0."""
    members = len(away[0]) + at_middle
    means = np.stack([a.sum(axis=0) for a in away]) / members
    moments = [np.einsum("kn,kn->n", away[i], away[j]) / members - means[i] * means[j] for i, j in PAIRS]
    return means, np.stack(moments)


def least_directions(moments: np.ndarray) -> np.ndarray:
    """(n, 3) unit eigenvectors of the least eigenvalue of symmetric 3 x 3 matrices.

    The eigenvalue comes from Smith's trigonometric formula (1961), the vector is the longest cross product of two rows
    of the matrix minus the eigenvalue; this takes a tenth of LAPACK's time for small matrices. If all three cross
    products are short, because two eigenvalues are nearly equal, LAPACK is used.
    """
    xx, yy, zz, yz, xz, xy = moments
    least, size = _least_values(moments)
    a, b, c = xx - least, yy - least, zz - least
    rows = (a, xy, xz), (xy, b, yz), (xz, yz, c)
    crosses = np.empty((3, 3, len(least)), moments.dtype)
    for cross, p, q in zip(crosses, rows, (*rows[1:], rows[0]), strict=True):
        for row, (i, j) in zip(cross, ((1, 2), (2, 0), (0, 1)), strict=True):
            np.multiply(p[i], q[j], out=row)
            row -= p[j] * q[i]
    squares = np.einsum("ijn,ijn->in", crosses, crosses)
    vectors, square = crosses[0].copy(), squares[0].copy()
    for cross, others in zip(crosses[1:], squares[1:], strict=True):
        is_longer = others > square
        np.copyto(vectors, cross, where=is_longer)
        np.copyto(square, others, where=is_longer)
    doubtful = np.flatnonzero(~(square > np.finfo(moments.dtype).eps ** (2 * _DOUBTFUL) * size**4) | (square == 0))
    vectors /= np.sqrt(np.where(square > 0, square, 1))
    if len(doubtful):
        matrices = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])[:, :, doubtful].transpose(2, 0, 1)
        vectors[:, doubtful] = np.linalg.eigh(matrices.astype(np.float64))[1][:, :, 0].T
    return vectors.T


def _least_values(moments: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(n,) least eigenvalues of symmetric 3 x 3 matrices, and (n,) the size of the eigenvalues' deviations from their
    mean."""
    xx, yy, zz, yz, xz, xy = moments
    shift = (xx + yy + zz) / 3
    a, b, c = xx - shift, yy - shift, zz - shift
    yz2, xz2, xy2 = yz * yz, xz * xz, xy * xy
    size = np.sqrt((a * a + b * b + c * c + 2 * (yz2 + xz2 + xy2)) / 6)
    determinant = a * (b * c - yz2) - xy2 * c + 2 * (xy * yz * xz) - b * xz2
    with np.errstate(invalid="ignore", divide="ignore"):
        cosine = np.nan_to_num(np.clip(determinant / (2 * size * size * size), -1, 1))
    return shift + 2 * size * np.cos(np.arccos(cosine) / 3 + 2 * np.pi / 3), size


def tangent_frames(normals: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Two (N, 3) unit vectors that make a right-handed frame with unit normals (Duff et al. 2017)."""
    x, y, z = normals.T
    sign = np.copysign(1.0, z)
    a = -1 / (sign + z)
    b = x * y * a
    return np.stack([1 + sign * x * x * a, sign * b, -sign * x], 1), np.stack([b, sign + y * y * a, -y], 1)
