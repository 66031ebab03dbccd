# SPDX-License-Identifier: GPL-3.0-or-later
"""The bounced light of a scene, and the texels that shaders look it up in."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..scene import Scene
from .chooser import Chooser
from .gathering import RAYS, bounced, lit_by_lamps, seen_from, smoother
from .points import points_of
from .surfaces import Surfaces, make_surfaces
from .table import Table, make_table

#: Cubes in a scene's grid, and merged surfels, about.
MOST_VOXELS, MOST_SURFELS = 1 << 21, 8000
#: Cubes beside what is in the grid. It begins at an odd place, because sides of things are often at even ones.
_BESIDE, _ODD = 3, np.array([0.377, 0.411, 0.433])
#: The largest empty blocks.
_MULTIPLE = 16


@dataclass(frozen=True, eq=False)
class BouncedLight:
    """low: (3,) float64 world, corner of the cells. cell: their edge. cells: (m, 3) whole numbers of merged surfels'
    cells; sides: (m,) 0 to 5. irradiance: (m, 3) over pi, of all light but lamps'. open: (m,) share of the world in the
    half-space over it, weighted by the cosine. linked: (p,) each, pairs of rows of one side in cells beside each other
    that share their light; None for all."""

    low: np.ndarray
    cell: float
    cells: np.ndarray
    sides: np.ndarray
    irradiance: np.ndarray
    open: np.ndarray
    linked: tuple[np.ndarray, np.ndarray] | None = None

    @cached_property
    def table(self) -> Table:
        return make_table(self.cells, self.sides, self.irradiance, self.open, self.linked)

    def texels(self) -> np.ndarray:
        """(rows, 1024, 4) float32, as of `Table`."""
        return self.table.texels


def bounced_light(
    scene: Scene,
    solid: np.ndarray,
    bounces: int,
    rays: int = RAYS,
    voxels: int = MOST_VOXELS,
    surfels: int = MOST_SURFELS,
) -> BouncedLight:
    """The light that the scene's surfaces send to one another; of no cells if it has none. Lamps light them, with
    shadows.

    solid: (n,) bool, as of `are_solid`. bounces: how often light is reflected. rays: in all. voxels, surfels: how
    finely space and surfaces are divided.
    """
    surfaces = surfaces_of(scene, solid, voxels, surfels)
    if surfaces is None:
        none = np.zeros((0, 3))
        return BouncedLight(np.zeros(3), 1.0, none.astype(int), np.zeros(0, int), none, np.zeros(0))
    seen = seen_from(surfaces, sky_of(scene), rays)
    light = bounced(surfaces, seen, lit_by_lamps(surfaces, scene.lights), bounces)
    smooth = smoother(surfaces, seen)
    is_open, is_known = smooth(np.stack([seen.open, seen.counts > 0], axis=1)).T
    known, grid = np.flatnonzero(is_known > 0), surfaces.voxels
    of_surfels = (each[known] for each in (surfaces.cells, surfaces.sides, light, is_open))
    row_of = np.full(len(surfaces), -1)
    row_of[known] = np.arange(len(known))
    linked = row_of[np.stack(surfaces.neighbours)]
    return BouncedLight(grid.low, surfaces.cell * grid.edge, *of_surfels, tuple(linked[:, (linked >= 0).all(axis=0)]))


def surfaces_of(scene: Scene, solid: np.ndarray, voxels: int, surfels: int) -> Surfaces | None:
    """The surfaces of a scene; None if there are none."""
    low, edge, shape = grid_of(scene, voxels)
    if not edge > 0:
        return None
    chooser = Chooser(low, edge, shape)
    points = [some for some in points_of(scene, solid, chooser) if len(some)]
    return make_surfaces(low, edge, shape, points, surfels) if points else None


def grid_of(scene: Scene, voxels: int) -> tuple[np.ndarray, float, tuple[int, int, int]]:
    """The corner, the edge of a cube and the numbers of cubes of a grid around everything; an edge of 0 if there is
    nothing."""
    corners = scene.table.firm.world_corners.reshape(-1, 3)
    corners = corners[np.isfinite(corners).all(axis=1)]
    if not len(corners):
        return np.zeros(3), 0.0, (0, 0, 0)
    low, high = corners.min(axis=0), corners.max(axis=0)
    extent = np.maximum(high - low, 1e-3 * (high - low).max())
    if not extent.max() > 0:
        return low, 0.0, (0, 0, 0)
    edge = float(np.cbrt(np.prod(extent) / voxels))
    while True:
        cubes = np.ceil(extent / edge).astype(int) + 2 * _BESIDE + 1
        shape = tuple((-(-cubes // _MULTIPLE) * _MULTIPLE).tolist())
        if np.prod(shape) <= 1.1 * voxels:
            return low - (_BESIDE + _ODD) * edge, edge, shape
        edge *= 1.03


def sky_of(scene: Scene) -> Callable[[np.ndarray], np.ndarray]:
    """The world's radiance (n, 3) in directions (n, 3)."""
    world = np.array(scene.world)
    if scene.environment is None:
        return lambda directions: np.broadcast_to(world, directions.shape)
    pixels, rotation = scene.environment.lighting_pixels(scene.picture_sun), scene.environment.rotation
    rows, columns = pixels.shape[:2]

    def sky(directions: np.ndarray) -> np.ndarray:
        x, y, z = (directions @ rotation.T).T
        column = np.floor((0.5 - np.arctan2(y, x) / (2 * np.pi)) * columns).astype(int) % columns
        row = np.floor((0.5 + np.arctan2(z, np.hypot(x, y)) / np.pi) * rows).astype(int)
        return world * pixels[np.clip(row, 0, rows - 1), column]

    return sky
