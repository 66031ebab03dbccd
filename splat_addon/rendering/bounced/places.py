# SPDX-License-Identifier: GPL-3.0-or-later
"""Places that are close together on a shape: on its surfels, or on its triangles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...clip_lines import kept
from ...quaternions import axes_columns
from ...surfels import Surfels
from ...vectors import unit
from ..scene import Placed
from ..scene.polygons import Polygons

#: Distance of points on large surfels and triangles; the most of a surfel's radius that one point stands for; both in
#: cubes.
_APART, _LARGEST = 0.6, 0.55
#: Of a surfel's half-axes, how far points go: beyond are others.
_COVERS = 0.75
#: Points of one shape, about.
_MOST_POINTS = 1 << 22


@dataclass(frozen=True, eq=False)
class Places:
    """Points of a shape. positions, normals: (3, n) float32, object units. rows: (n, k) surfels or corners. weights:
    (n, k) of these."""

    positions: np.ndarray
    normals: np.ndarray
    rows: np.ndarray
    weights: np.ndarray

    def taken(self, rows) -> Places:
        return Places(self.positions[:, rows], self.normals[:, rows], self.rows[rows], self.weights[rows])

    def __len__(self) -> int:
        return self.positions.shape[1]


def places_in(placed: Placed, linear: np.ndarray, edge: float) -> Places:
    """Places on all of a shape, less than a cube apart. linear: (3, 3), of its largest instance. edge: of a cube, world
    units."""
    of_shape = _of_surfels if isinstance(placed.shape, Surfels) else _of_triangles
    return of_shape(placed.shape, linear.T.astype(np.float32), edge)


def thinned(places: Places, edge: float) -> Places:
    """One point of each small cube and side."""
    cubes = np.floor(places.positions / (_APART * edge)).astype(np.int64)
    sides = np.rint(places.normals * 2).astype(np.int64)
    keys = np.concatenate([cubes, sides]).T
    return places.taken(np.unique(keys, axis=0, return_index=True)[1])


def _of_surfels(surfels: Surfels, linear: np.ndarray, edge: float) -> Places:
    """linear: (3, 3) from rows in object units to the world's."""
    normals = axes_columns(surfels.rotations, 2)[0]
    stretch = float(np.linalg.norm(linear, 2))
    is_large = surfels.radius * stretch > _LARGEST * edge
    if is_large.any():
        small = np.flatnonzero(~is_large)
        parts = (surfels.positions[small], small), _spread(surfels, np.flatnonzero(is_large), linear, _APART * edge)
        positions, rows = (np.concatenate(each) for each in zip(*parts, strict=True))
        normals = normals[:, rows]
    else:
        positions, rows = surfels.positions, np.arange(len(surfels))
    columns = np.ascontiguousarray(positions.T)
    return Places(columns, normals, rows[:, None], np.ones((len(rows), 1), np.float32))


def _spread(surfels: Surfels, large: np.ndarray, linear: np.ndarray, apart: float) -> tuple[np.ndarray, np.ndarray]:
    """Positions on large surfels, and the surfel of each."""
    axes = [axis.T * scale[:, None] for axis, scale in zip(
        axes_columns(surfels.rotations[large], 0, 1), surfels.scales[large].T, strict=True)]  # fmt: skip
    lengths = np.stack([np.linalg.norm(axis @ linear, axis=1) for axis in axes], axis=1)
    counts = _counts(2 * _COVERS * lengths / apart)
    rows, places = _grids(counts)
    at = np.stack([((k + 0.5) / counts[rows, j] * 2 - 1) * _COVERS for j, k in enumerate(places)], axis=1)
    at = at.astype(np.float32)
    is_kept = (at**2).sum(axis=1) <= 1
    if surfels.is_clipped:
        cut = np.flatnonzero(surfels.is_cut()[large][rows])
        is_kept[cut] &= kept(at[cut], *surfels.take(large[rows[cut]]).clip_lines())
    at, rows = at[is_kept], rows[is_kept]
    own = large[rows]
    return surfels.positions[own] + axes[0][rows] * at[:, :1] + axes[1][rows] * at[:, 1:], own


def _counts(wanted: np.ndarray) -> np.ndarray:
    """(n, 2) whole numbers of points along two sides. What lies over one another so often that there would be too many
    points in all has fewer."""
    counts = np.maximum(np.ceil(wanted), 1)
    too_many = np.sqrt(counts.prod(axis=1).sum() / _MOST_POINTS)
    return (np.maximum(np.ceil(wanted / too_many), 1) if too_many > 1 else counts).astype(np.int64)


def _grids(counts: np.ndarray) -> tuple[np.ndarray, tuple[np.ndarray, np.ndarray]]:
    """The places of (n, 2) grids of these sizes one after the other: the number of the grid, and the two indices."""
    total = counts.prod(axis=1)
    rows = np.repeat(np.arange(len(counts)), total)
    number = np.arange(total.sum()) - np.repeat(np.cumsum(total) - total, total)
    return rows, np.divmod(number, counts[rows, 1])


def _of_triangles(polygons: Polygons, linear: np.ndarray, edge: float) -> Places:
    """Points in even steps along the two shorter sides of each triangle, up to the third."""
    corners = polygons.positions.reshape(-1, 3, 3)
    sides = np.linalg.norm((corners[:, [1, 2, 0]] - corners[:, [2, 0, 1]]) @ linear, axis=2)  # opposite to each corner
    with np.errstate(invalid="ignore", divide="ignore"):
        normals = unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    usable = np.flatnonzero(np.isfinite(normals).all(axis=1))
    apex = sides[usable].argmax(axis=1)
    ends = (apex + 1) % 3, (apex + 2) % 3
    # the side to one end lies opposite to the other
    lengths = np.stack([sides[usable, ends[1]], sides[usable, ends[0]]], axis=1)
    counts = _counts(lengths / (_APART * edge))
    rows, places = _grids(counts)
    u, v = ((k + 0.5).astype(np.float32) / counts[rows, j].astype(np.float32) for j, k in enumerate(places))
    room = 1 - v
    kept = np.flatnonzero(u - room <= 0.5 / counts[rows, 0])
    rows, u, v = rows[kept], np.minimum(u, room)[kept], v[kept]
    own, order = usable[rows], np.stack([apex, *ends], axis=1)[rows]
    first, *others = (corners[usable, k] for k in (apex, *ends))
    along = [other - first for other in others]
    positions = first[rows] + along[0][rows] * u[:, None] + along[1][rows] * v[:, None]
    weights = np.stack([1 - u - v, u, v], axis=1)
    return Places(np.ascontiguousarray(positions.T), normals[own].T, 3 * own[:, None] + order, weights)
