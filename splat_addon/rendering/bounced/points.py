# SPDX-License-Identifier: GPL-3.0-or-later
"""Points that are close together on all surfaces of a scene, whatever these consist of."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING

import numpy as np

from ...clip_lines import kept
from ...images import Image
from ...quaternions import axes_columns
from ...surfels import Surfels
from ...vectors import unit
from ..scene import Scene
from ..scene.material import SurfaceTexture
from ..scene.polygons import Polygons
from ..scene.scene import Placed

if TYPE_CHECKING:
    from .chooser import Chooser

#: Distance of points on large surfels and triangles; the most of a surfel's radius that one point stands for; both in
#: cubes.
_APART, _LARGEST = 0.6, 0.55
#: Of a surfel's half-axes, how far points go: beyond are others.
_COVERS = 0.75
#: Points of one shape, about.
_MOST_POINTS = 1 << 22
#: Points that are made at once, about.
_AT_ONCE = 1 << 20
#: What is less opaque than this lets all light through.
_OPAQUE = 0.5


@dataclass(frozen=True, eq=False)
class Points:
    """n places on surfaces. positions: (n, 3) float64 world. normals: (n, 3) float32, unit. albedo, emission: (n, 3)
    float32. translucency: (n, 1) float32 share of diffuse light that leaves on the other side. light_sets: (n,) uint8.
    have_backs: (n,) bool, whether the other side is a surface too."""

    positions: np.ndarray
    normals: np.ndarray
    albedo: np.ndarray
    emission: np.ndarray
    translucency: np.ndarray
    light_sets: np.ndarray
    have_backs: np.ndarray

    def __len__(self) -> int:
        return len(self.positions)

    def taken(self, rows: np.ndarray) -> Points:
        return Points(*(getattr(self, f.name)[rows] for f in fields(self)))


def joined(parts: list[Points]) -> Points:
    """All of them."""
    return Points(*(np.concatenate([getattr(part, f.name) for part in parts]) for f in fields(Points)))


def with_backs(points: Points) -> Points:
    """The points, and their other sides where these are surfaces."""
    behind = points.taken(points.have_backs)
    return joined([points, replace(behind, normals=-behind.normals)])


@dataclass(frozen=True, eq=False)
class _Places:
    """Points of a shape. positions, normals: (3, n) float32, object units. rows: (n, k) surfels or corners. weights:
    (n, k) of these."""

    positions: np.ndarray
    normals: np.ndarray
    rows: np.ndarray
    weights: np.ndarray

    def taken(self, rows) -> _Places:
        return _Places(self.positions[:, rows], self.normals[:, rows], self.rows[rows], self.weights[rows])

    def __len__(self) -> int:
        return self.positions.shape[1]


def points_of(scene: Scene, solid: np.ndarray, chooser: Chooser) -> Iterator[Points]:
    """Points of everything in the scene, at most a cube apart; of these, those that are chosen. solid: as of
    `are_solid`."""
    table, edge = scene.table, chooser.edge
    for kind in np.unique(table.kind_of).tolist():
        rows = np.flatnonzero((table.kind_of == kind) & ~table.are_flattened)
        if not len(rows):
            continue
        placed = table.every_kind[kind]
        largest = rows[table.stretches[rows, 0].argmax()]
        places = places_in(placed, table.matrices[largest, :3, :3], edge)
        if not (opaque := are_opaque(placed, places)).all():
            places = places.taken(opaque)
        if len(rows) > 1:
            places = _thinned(places, edge / float(table.stretches[largest, 0]))
        step = max(_AT_ONCE // max(len(places), 1), 1)
        for first in range(0, len(rows), step):
            some = rows[first : first + step]
            yield _placed_points(placed, places, table.matrices[some], table.light_sets[some], solid[some], chooser)


def _placed_points(
    placed: Placed, places: _Places, matrices: np.ndarray, light_sets: np.ndarray, solid: np.ndarray, chooser: Chooser
) -> Points:
    """The points of instances with these (m, 4, 4) matrices."""
    linear, count = matrices[:, :3, :3], max(len(places), 1)
    shift = linear @ np.asarray(placed.shape.origin) + matrices[:, :3, 3]
    scaled = linear / np.abs(linear).max(axis=(1, 2), keepdims=True)  # products of tiny numbers would vanish
    turned = np.linalg.inv(scaled).swapaxes(1, 2) * np.sign(np.linalg.det(scaled))[:, None, None]
    turned /= np.abs(turned).max(axis=(1, 2), keepdims=True)
    at = _transformed(places.positions, linear / chooser.edge, (shift - chooser.low) / chooser.edge)
    instances, rows = np.divmod(chooser.fresh(at, _transformed(places.normals, turned)), count)
    own = places.taken(rows)
    positions, normals = (
        np.einsum("njk,kn->nj", of_instances[instances], columns)
        for of_instances, columns in ((linear, own.positions), (turned, own.normals))
    )
    albedo, emission, translucency = _surfaces(placed, own)
    if emission.any():
        emission *= np.where(solid, _shown(places, linear, chooser.edge), 1)[instances, None].astype(np.float32)
    have_backs = ~solid[instances]
    if getattr(placed.shape, "hidden_back", None) is not None:
        have_backs &= placed.shape.hidden_back[own.rows[:, 0]] < 0.5
    sets, normals = light_sets[instances].astype(np.uint8), unit(normals).astype(np.float32)
    return Points(positions + shift[instances], normals, albedo, emission, translucency, sets, have_backs)


def _shown(places: _Places, linear: np.ndarray, edge: float) -> np.ndarray:
    """(m,) the area that a box around points shows on average, in instances with these (m, 3, 3) matrices, as a
    share of what the cubes that it is in show: small lamps fill larger ones."""
    extent = np.ptp(places.positions, axis=1) * np.linalg.norm(linear, axis=1)
    x, y, z = extent.T
    wide, deep, high = (extent + edge).T
    return (x * y + y * z + z * x) / (wide * deep + deep * high + high * wide)


def _transformed(columns: np.ndarray, linear: np.ndarray, shift: np.ndarray | None = None) -> np.ndarray:
    """(3, m n) float32: (3, n) columns by (m, 3, 3) matrices, moved by (m, 3)."""
    x, y, z = columns
    by = linear.astype(np.float32)[..., None]
    made = np.empty((3, len(linear), len(x)), np.float32)
    for k, row in enumerate(made):
        np.multiply(by[:, k, 0], x, out=row)
        row += by[:, k, 1] * y
        row += by[:, k, 2] * z
        if shift is not None:
            row += shift[:, k, None].astype(np.float32)
    return made.reshape(3, -1)


def places_in(placed: Placed, linear: np.ndarray, edge: float) -> _Places:
    """linear: (3, 3), of its largest instance."""
    of_shape = _of_surfels if isinstance(placed.shape, Surfels) else _of_triangles
    return of_shape(placed.shape, linear.T.astype(np.float32), edge)


def _thinned(places: _Places, edge: float) -> _Places:
    """One point of each small cube and side."""
    cubes = np.floor(places.positions / (_APART * edge)).astype(np.int64)
    sides = np.rint(places.normals * 2).astype(np.int64)
    keys = np.concatenate([cubes, sides]).T
    return places.taken(np.unique(keys, axis=0, return_index=True)[1])


def _of_surfels(surfels: Surfels, linear: np.ndarray, edge: float) -> _Places:
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
    return _Places(columns, normals, rows[:, None], np.ones((len(rows), 1), np.float32))


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


def _of_triangles(polygons: Polygons, linear: np.ndarray, edge: float) -> _Places:
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
    return _Places(np.ascontiguousarray(positions.T), normals[own].T, 3 * own[:, None] + order, weights)


def _mean(values: np.ndarray, places: _Places) -> np.ndarray:
    """(n, c) values of surfels or corners at points."""
    if places.rows.shape[1] == 1:
        return values[places.rows[:, 0]]
    return np.einsum("nk,nkc->nc", places.weights, values[places.rows])


def _texture_colors(
    placed: Placed, places: _Places, materials: np.ndarray
) -> Iterator[tuple[np.ndarray, np.ndarray, SurfaceTexture]]:
    """Rows of points that a texture covers, (m, 4) what it shows there, and the texture."""
    if not placed.is_textured:
        return
    uvs = _mean(placed.shape.uvs, places)
    slots = np.minimum(materials, len(placed.textures) - 1)
    for slot in np.unique(slots).tolist():
        if (texture := placed.textures[slot]) is not None:
            rows = np.flatnonzero(slots == slot)
            yield rows, _looked_up(texture.image, uvs[rows]), texture


def _looked_up(image: Image, uvs: np.ndarray) -> np.ndarray:
    return image.pyramid.lookup(uvs.T, np.zeros(len(uvs), np.intp))


def are_opaque(placed: Placed, places: _Places) -> np.ndarray:
    """(n,) bool: points that block light."""
    opaque = np.ones(len(places), bool)
    if placed.lets_through:
        opaque &= placed.shape.colors[places.rows[:, 0], 3] >= _OPAQUE
    if getattr(placed, "is_cut_out", False):
        for rows, colors, texture in _texture_colors(placed, places, placed.shape.materials[places.rows[:, 0]]):
            if texture.is_cut_out:
                opaque[rows[colors[:, 3] < _OPAQUE]] = False
    return opaque


def _surfaces(placed: Placed, places: _Places) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(n, 3) albedo and emission of points, and (n, 1) translucency."""
    shape = placed.shape
    materials = np.minimum(shape.materials[places.rows[:, 0]], len(placed.materials) - 1)
    albedo = _mean(shape.colors, places)[:, :3].copy()
    for rows, colors, texture in _texture_colors(placed, places, shape.materials[places.rows[:, 0]]):
        albedo[rows] = colors[:, :3] * np.float32(texture.factor)
    if shape.emission is not None:
        emission = _mean(shape.emission, places)
    else:
        emission = np.array([material.emission for material in placed.materials], np.float32)[materials]
    if placed.is_holdout:
        albedo, emission = np.zeros_like(albedo), np.zeros_like(emission)
    translucency = np.array([[material.finish.translucency] for material in placed.materials], np.float32)[materials]
    return np.clip(albedo, 0, 1), np.maximum(emission, 0), translucency
