# SPDX-License-Identifier: GPL-3.0-or-later
"""Points that are close together on all surfaces of a scene, whatever these consist of."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace

import numpy as np

from ...vectors import unit
from ..scene import Placed, Scene
from .appearance import appearance_of, are_opaque
from .chooser import Chooser
from .places import Places, places_in, thinned

#: Points that are made at once, about.
_AT_ONCE = 1 << 20


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


def points_of(scene: Scene, solid: np.ndarray, chooser: Chooser) -> Iterator[Points]:
    """Points of everything in the scene, at most a cube apart; of these, those that are chosen. solid: as of
    `are_solid`."""
    table, edge = scene.table, chooser.edge
    kind_of, matrices, light_sets = table.kind_of, table.matrices, table.light_sets
    for kind in np.unique(kind_of).tolist():
        rows = np.flatnonzero((kind_of == kind) & ~table.are_flattened)
        if not len(rows):
            continue
        placed = table.every_kind[kind]
        largest = rows[table.stretches[rows].argmax()]
        places = places_in(placed, matrices[largest, :3, :3], edge)
        if not (opaque := are_opaque(placed, places)).all():
            places = places.taken(opaque)
        if len(rows) > 1:
            places = thinned(places, edge / float(table.stretches[largest]))
        step = max(_AT_ONCE // max(len(places), 1), 1)
        for first in range(0, len(rows), step):
            some = rows[first : first + step]
            yield _placed_points(placed, places, matrices[some], light_sets[some], solid[some], chooser)


def _placed_points(
    placed: Placed, places: Places, matrices: np.ndarray, light_sets: np.ndarray, solid: np.ndarray, chooser: Chooser
) -> Points:
    """The points of instances with these (m, 3, 4) matrices."""
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
    albedo, emission, translucency = appearance_of(placed, own)
    if emission.any():
        emission *= np.where(solid, _shown(places, linear, chooser.edge), 1)[instances, None].astype(np.float32)
    have_backs = ~solid[instances]
    if getattr(placed.shape, "hidden_back", None) is not None:
        have_backs &= placed.shape.hidden_back[own.rows[:, 0]] < 0.5
    sets, normals = light_sets[instances].astype(np.uint8), unit(normals).astype(np.float32)
    return Points(positions + shift[instances], normals, albedo, emission, translucency, sets, have_backs)


def _shown(places: Places, linear: np.ndarray, edge: float) -> np.ndarray:
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
