# SPDX-License-Identifier: GPL-3.0-or-later
"""The ellipse of a bare point: in its tangent plane, over the region that is nearer to it than to its neighbours.

Splats that cover their own Voronoi regions leave no hole between them. The region is represented by its extent in 16
directions; its second moments give the ellipse's axes, and its largest extent the minimum size.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable

import numpy as np

from ...workers import in_portions
from .creases import Creases
from .normals import CHUNK, tangent_frames

#: Directions in which a region's extent is measured; an even number, so that each has an opposite.
DIRECTIONS = 16

#: A direction is open (at a border or a gap) if no neighbour lies within this cosine of it (60 degrees).
_OPEN_COSINE = 0.5

#: A neighbour that is steeper than this above the tangent plane, or whose normal differs by more than this cosine, lies
#: on another sheet and is ignored.
_STEEPEST_SLOPE = 2.0
_SAME_SHEET_COSINE = 0.3

#: A region's extent is limited to this many spacings; anything farther is a gap in the scan. A 1 by 8 rectangle has an
#: extent of 2.5 (with the spacing of `_spacings`); the regions of random points seldom exceed 1.5.
_LONGEST = 2.5

#: The same at creases, where nothing but random gaps is between a point and its line.
_LONGEST_AT_LINES = 1.5

#: The spacing around a point is the smallest estimate from this many neighbours or more, so that a small group of stray
#: points is not mistaken for a sparse surface.
_FEWEST = 4

#: Maximum ratio of an ellipse's axes, in case a point's neighbours lie on one line.
_MAX_STRETCH = 8.0

#: The surface bears a large splat if neighbours lie on all sides, without a gap of more than this, in radians, and
#: their root mean square distance from its plane is at most this share of that from its middle.
_WIDEST_GAP, _FLAT = 2.0, 0.25


def tangent_ellipses(
    positions: np.ndarray,
    normals: np.ndarray,
    neighbours: np.ndarray,
    splat_size: float,
    creases: Creases | None = None,
    report: Callable[[float], None] = lambda share: None,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The ellipses' longer axes, (N, 3) float64 unit vectors, their half-axes, (N, 2) float64, and which of them are
    known.

    positions, normals: (N, 3) float64, normals unit. neighbours: (n, k) indices of the first n points' neighbours.
    splat_size: half-axis in units of the spacing, which is the edge of a square or rectangular region. An ellipse that
        would not cover its region is enlarged until it does. Ellipses are known, (n,) bool, if the point has a
        neighbour beside it.
    creases: the lines up to which regions go on. Neighbours on their other sides do not bound a region.
    report: called with the finished share.
    """
    count = len(neighbours)
    axes, half_axes, known = np.empty((count, 3)), np.empty((count, 2)), np.empty(count, bool)
    columns, normal_columns = np.ascontiguousarray(positions.T), np.ascontiguousarray(normals.T, np.float32)
    least_alike = np.full(count, _SAME_SHEET_COSINE)
    if creases is not None:
        least_alike[creases.points] = creases.cosine

    def job(part: slice):
        near, own = neighbours[part].T.astype(np.intp, order="C"), normal_columns[:, part]
        frame = (*tangent_frames(normals[part]), normals[part])
        away, scale = _offsets(columns, near, part)
        along_u, along_v, height = (_along(away, w.T.astype(np.float32)) for w in frame)
        square = along_u * along_u + along_v * along_v
        bounds = _along([column.take(near) for column in normal_columns], own) > least_alike[part]
        bounds &= height * height <= np.float32(_STEEPEST_SLOPE**2) * square
        spacing, known[part] = _spacings(square, bounds)
        to_spacing = (1 / spacing).astype(np.float32)
        spacing = spacing * scale
        if creases is not None:
            rows, spacings, ends = _ends(creases, part, frame)
            spacing[rows] = np.minimum(spacing[rows], spacings)
            to_spacing = (scale / spacing).astype(np.float32)
        reach, is_open = _reaches(along_u * to_spacing, along_v * to_spacing, bounds)
        reach = np.minimum(reach, _LONGEST)
        if creases is not None:
            reach[:, rows] = _up_to_lines(reach[:, rows], is_open[:, rows], ends / spacing[rows])
        angle, ellipses = _ellipses(reach, splat_size)
        half_axes[part] = ellipses * spacing[:, None]
        axes[part] = frame[0] * np.cos(angle)[:, None] + frame[1] * np.sin(angle)[:, None]

    in_portions(count, CHUNK, job, report)
    return axes, half_axes, known


def are_borne(positions: np.ndarray, normals: np.ndarray, neighbours: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """(n,) bool: which of some points the surface bears as large splats: not those at its edges, or in foliage."""
    away = positions[neighbours[rows]] - positions[rows, None]
    frame = (*tangent_frames(normals[rows]), normals[rows])
    u, v, height = (np.einsum("nkc,nc->nk", away, axis) for axis in frame)
    angles = np.sort(np.arctan2(v, u), axis=1)
    gaps = np.diff(angles, axis=1, append=angles[:, :1] + 2 * np.pi)
    is_flat = (height**2).sum(axis=1) <= _FLAT**2 * (u * u + v * v).sum(axis=1)
    return (gaps.max(axis=1) < _WIDEST_GAP) & is_flat


def _offsets(columns: np.ndarray, near: np.ndarray, part: slice) -> tuple[list[np.ndarray], np.ndarray]:
    """x, y and z, (k, n) float32 each, of neighbours relative to their points, in units of (n,), about the distance of
    the farthest, which keeps small and large ones within the range of float32."""
    away = [column.take(near) - column[part] for column in columns]
    scale = np.maximum.reduce([np.abs(a[-1]) for a in away])
    return [np.divide(a, scale, dtype=np.float32, casting="same_kind") for a in away], scale


def _along(vectors: list[np.ndarray], directions: np.ndarray) -> np.ndarray:
    """(k, n) products of vectors, given as x, y and z, with (3, n) directions."""
    made = vectors[0] * directions[0]
    for component, direction in zip(vectors[1:], directions[1:], strict=True):
        made += component * direction
    return made


def _spacings(square: np.ndarray, bounds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(n,) spacing: the edge of a square with the average area per point in a disc around it, and whether there is a
    neighbour.

    A disc that reaches to the j-th neighbour holds j + 1 points. square: (k, n) squared distances, nearest first.
    bounds: (k, n).
    """
    farthest, counts = np.where(bounds, square, np.float32(0)), bounds.astype(np.float32)
    # numpy accumulates along the first axis at a tenth of the speed
    for before, row in itertools.pairwise(farthest):
        np.maximum(row, before, out=row)
    for before, row in itertools.pairwise(counts):
        row += before
    areas = farthest / (counts + np.float32(1))
    areas[:-1][counts[:-1] < _FEWEST] = np.inf
    known = farthest[-1] > 0
    return np.where(known, np.sqrt(np.pi * areas.min(axis=0).astype(np.float64)), 1), known


def _reaches(u: np.ndarray, v: np.ndarray, bounds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(D, n) distance to the region's border in each direction, and (D, n) bool, whether nothing bounds it there.

    u, v: (k, n) float32 neighbours in the tangent plane, in spacings. bounds: (k, n) which of them count. The border
        towards a neighbour at d is the bisector, which direction e meets at |d|^2 / (2 d.e). An open direction takes
        the distance of the opposite direction, so that a splat at a border does not bulge outwards.
    """
    square = u * u + v * v
    # Inverse distance, so that neighbours sideways or behind give 0 or less and the largest value wins.
    inverse = 1 / np.sqrt(np.where(bounds & (square > 0), square, np.float32(np.inf)))
    u, v, inverse = u * inverse, v * inverse, 2 * inverse
    half = DIRECTIONS // 2
    reach, cosine = np.empty((DIRECTIONS, u.shape[1]), np.float32), np.empty((DIRECTIONS, u.shape[1]), np.float32)
    for row, angle in enumerate(np.arange(half) * np.float32(2 * np.pi / DIRECTIONS)):
        along = np.cos(angle) * u
        along += np.sin(angle) * v
        cosine[row], cosine[row + half] = along.max(axis=0), -along.min(axis=0)
        along *= inverse
        reach[row], reach[row + half] = along.max(axis=0), -along.min(axis=0)
    with np.errstate(divide="ignore", over="ignore"):
        reach = np.where(cosine >= _OPEN_COSINE, 1 / np.maximum(reach, 0), np.inf)
    is_open = np.isinf(reach)
    reach = np.where(is_open, np.roll(reach, half, axis=0), reach)
    return np.where(np.isinf(reach), 0.5, reach), is_open


def _ends(creases: Creases, part: slice, frame) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The rows of a part's points at creases, their spacings, and (D, rows) distance at which their surface ends in
    each direction, object units; infinite where it does not. frame: the part's tangents and normals, (n, 3) each."""
    found = slice(*np.searchsorted(creases.points, (part.start, part.stop)))
    rows = creases.points[found] - part.start
    angles = np.arange(DIRECTIONS) * (2 * np.pi / DIRECTIONS)
    u, v = (np.einsum("nlc,nc->nl", creases.inward[found], axis[rows]) for axis in frame[:2])
    outward = -(np.cos(angles)[:, None, None] * u + np.sin(angles)[:, None, None] * v)
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = np.where(outward > 0, np.maximum(creases.distances[found], 0) / outward, np.inf)
    return rows, creases.spacings[found], ends.min(axis=2)


def _up_to_lines(reach: np.ndarray, is_open: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """(D, n) reaches that go on to the surface's end where no neighbour bounds them before."""
    reach = np.where(is_open & np.isfinite(ends), np.maximum(reach, ends), reach)
    return np.minimum(reach, _LONGEST_AT_LINES)


def _ellipses(reach: np.ndarray, splat_size: float) -> tuple[np.ndarray, np.ndarray]:
    """(n,) angle of the longer axis in the tangent plane, and (n, 2) half-axes, from (D, n) reaches.

    Second moments of the region over its area: the integral of r^4 / 4 e e^T over r^2 / 2. A rectangle has edge^2 / 12
    along each edge, so sqrt(12 moment) is the spacing. A lopsided region is treated as one of the same width centred on
    the point; only the minimum size considers each side separately.
    """
    angles = np.arange(DIRECTIONS) * (2 * np.pi / DIRECTIONS)
    cosine, sine = np.float32(np.cos(angles)), np.float32(np.sin(angles))
    width = (reach + np.roll(reach, DIRECTIONS // 2, axis=0)) / 2
    second = width * width
    fourth = second * second
    area = 2 * second.sum(axis=0)
    xx, yy, xy = ((w @ fourth) / area for w in (cosine**2, sine**2, cosine * sine))
    angle = np.arctan2(2 * xy, xx - yy) / 2
    half, spread = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
    spacing = np.sqrt(12 * np.stack([half + spread, np.maximum(half - spread, 0)]))
    spacing[1] = np.maximum(spacing[1], spacing[0] / _MAX_STRETCH)
    half_axes = splat_size * spacing
    along = cosine[:, None] * np.cos(angle) + sine[:, None] * np.sin(angle)
    across = sine[:, None] * np.cos(angle) - cosine[:, None] * np.sin(angle)
    with np.errstate(divide="ignore", invalid="ignore"):
        squares = reach * reach * ((along / half_axes[0]) ** 2 + (across / half_axes[1]) ** 2)
    return angle, (half_axes * np.sqrt(np.maximum(squares.max(axis=0), 1))).T
