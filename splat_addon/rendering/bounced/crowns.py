# SPDX-License-Identifier: GPL-3.0-or-later
"""How much of the world's light reaches leaves within a crown, which a picture in which it has few pixels cannot tell.

Leaves are taken for a turbid medium: of light along a path, exp(-path G a) passes, where a is the leaf area per volume
and G, the mean cosine of leaves turned at random, is 1/2 (Monsi and Saeki 1953; Ross, "The Radiation Regime and
Architecture of Plant Stands", 1981). It is computed once for a shape, and averaged in cells of the world.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...hierarchy.nodes import MERGED_OVERLAP
from ...large_surfels import SAMPLE_SIZE
from ...surfels import Surfels
from ...vectors import unit
from ..scene import Placed, Scene
from .appearance import are_opaque
from .light import BouncedLight
from .places import places_in
from .sides import SIDES

#: Cells of a shape, and of the world, about.
_OF_SHAPE, _OF_WORLD = 1 << 12, 1 << 17
#: Directions in which light is followed, and steps in a cell.
_DIRECTIONS, _STEPS = 48, 2
#: The mean cosine between a direction and leaves.
_COSINE = 0.5


@dataclass(frozen=True, eq=False)
class Crown:
    """m cells of a shape that have leaves. low: (3,) corner of its grid, and edge of a cell, in its object's units
    relative to its origin. cells: (m, 3) whole numbers. areas: (m,) of leaves, of one side. open: (m, 6) share of an
    even sky over surfaces that look towards each side."""

    low: np.ndarray
    edge: float
    cells: np.ndarray
    areas: np.ndarray
    open: np.ndarray

    def pooled(self, times: int) -> Crown:
        """With cells that are so many times larger."""
        cells, row = np.unique(self.cells // times, axis=0, return_inverse=True)
        areas, of_sides = _sums(row.ravel(), len(cells), self.areas, self.open)
        return Crown(self.low, self.edge * times, cells, areas, of_sides)


def is_crown(placed: Placed) -> bool:
    """Whether images cut leaves out of it."""
    return bool(getattr(placed, "is_cut_out", False) or placed.has_holes)


def crowns_of(scene: Scene) -> BouncedLight:
    """The share of the world's light that is left within crowns; it has no light."""
    table, crowns = scene.table, []
    for kind, placed in enumerate(table.every_kind):
        rows = np.flatnonzero((table.kind_of == kind) & ~table.are_flattened)
        if len(rows) and is_crown(placed) and (made := crown_of(placed)) is not None:
            crowns.append((made, placed, rows))
    while sum(len(crown.cells) * len(rows) for crown, _, rows in crowns) > _OF_WORLD:
        pooled = [(crown.pooled(2), placed, rows) for crown, placed, rows in crowns]
        if all(len(after.cells) == len(before.cells) for (after, *_), (before, *_) in zip(pooled, crowns, strict=True)):
            break
        crowns = pooled
    edge = max((crown.edge * float(np.median(table.stretches[rows])) for crown, _, rows in crowns), default=0.0)
    if not edge > 0:
        none = np.zeros((0, 3))
        return BouncedLight(np.zeros(3), 1.0, none.astype(int), np.zeros(0, int), none, np.zeros(0))
    parts = [_in_world(*one, table.matrices) for one in crowns]
    places, areas, of_sides = (np.concatenate(each) for each in zip(*parts, strict=True))
    low = places.min(axis=0) - 1.5 * edge  # so that the middles of a lone crown are those of the cells
    cells, row = np.unique(np.floor((places - low) / edge).astype(np.int64), axis=0, return_inverse=True)
    _, of_sides = _sums(row.ravel(), len(cells), areas, of_sides)
    every, sides = np.repeat(cells, SIDES, axis=0), np.tile(np.arange(SIDES), len(cells))
    return BouncedLight(low, edge, every, sides, np.zeros((len(every), 3)), of_sides.ravel())


def _in_world(crown: Crown, placed: Placed, rows: np.ndarray, matrices: np.ndarray) -> tuple[np.ndarray, ...]:
    """Of all cells of some instances: (n, 3) their middles, (n,) areas of leaves, and (n, 6) shares."""
    linear, count = matrices[rows, :3, :3], len(crown.cells)
    middles = crown.low + (crown.cells + 0.5) * crown.edge + np.asarray(placed.shape.origin)
    places = middles @ linear.swapaxes(1, 2) + matrices[rows, None, :3, 3]
    volumes = np.abs(np.linalg.det(linear)) ** (2 / 3)
    facing = unit(linear)  # rows of the matrix: the world's axes in the object's space
    pairs = crown.open.reshape(count, 3, 2)
    of_sides = np.empty((len(rows), count, 3, 2))
    for sign in range(2):
        towards = (facing < 0) ^ bool(sign)  # (k, world's axis, object's axis)
        for axis in range(3):
            squares = facing[:, axis] ** 2
            of_sides[:, :, axis, sign] = sum(
                squares[:, k, None] * np.where(towards[:, axis, k, None], pairs[:, k, 1], pairs[:, k, 0])
                for k in range(3)
            )
    areas = volumes[:, None] * crown.areas
    return places.reshape(-1, 3), areas.ravel(), of_sides.reshape(-1, SIDES)


def _sums(row: np.ndarray, count: int, areas: np.ndarray, of_sides: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(count,) sums of areas (n,), and (count, 6) means of shares (n, 6), weighted by area."""
    total = np.bincount(row, areas, count)
    means = [np.bincount(row, areas * side, count) / total for side in of_sides.T]
    return total, np.stack(means, axis=1)


def crown_of(placed: Placed) -> Crown | None:
    """None if it has no leaves."""
    low, high = (np.asarray(bound, np.float64) for bound in placed.shape.local_bounds)
    extent = np.maximum(high - low, 1e-3 * (high - low).max(initial=0))
    edge = float(np.cbrt(np.prod(extent) / _OF_SHAPE))
    if not edge > 0:
        return None
    places = places_in(placed, np.eye(3), edge)
    areas = _areas(placed, places)
    kept = areas > 0
    at = np.floor((places.positions.T[kept].astype(np.float64) - low) / edge).astype(np.int64)
    shape = tuple((np.ceil(extent / edge).astype(int) + 1).tolist())
    at = np.clip(at, 0, np.array(shape) - 1)
    total = np.bincount(np.ravel_multi_index(at.T, shape), areas[kept], int(np.prod(shape))).reshape(shape)
    cells = np.argwhere(total > 0)
    if not len(cells):
        return None
    return Crown(low, edge, cells, total[tuple(cells.T)], _open(total * (_COSINE / edge**2), cells))


def _areas(placed: Placed, places) -> np.ndarray:
    """(n,) area of leaves, of one side, that points stand for."""
    shape, rows = placed.shape, places.rows[:, 0]
    if isinstance(shape, Surfels):
        overlap = MERGED_OVERLAP if placed.is_merged else SAMPLE_SIZE
        areas = shape.scales.prod(axis=1) / overlap**2 * shape.colors[:, 3]
    else:
        corners, rows = shape.positions.reshape(-1, 3, 3), rows // 3
        areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
    shares = areas[rows] / np.bincount(rows)[rows]
    return shares if isinstance(shape, Surfels) else shares * are_opaque(placed, places)


def _open(depths: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """(m, 6) shares of an even sky that reach the middles of cells (m, 3). depths: optical, of a path of one cell."""
    padded, total = np.pad(depths, 1), np.zeros((len(cells), SIDES))
    last = np.array(padded.shape) - 1
    weights = np.zeros(SIDES)
    for direction in _directions():
        depth = np.zeros(len(cells))
        for step in range(1, _STEPS * sum(depths.shape)):  # what is nearer is the leaf itself
            at = np.floor(cells + 1.5 + direction * ((step + 0.5) / _STEPS)).astype(np.int64)
            is_within = ((at >= 0) & (at <= last)).all(axis=1)
            if not is_within.any():
                break
            depth += padded[tuple(np.clip(at, 0, last).T)] * is_within / _STEPS
        cosines = np.maximum(np.stack([direction, -direction], axis=1).ravel(), 0)
        total += np.exp(-depth)[:, None] * cosines
        weights += cosines
    return total / weights


def _directions() -> Iterator[np.ndarray]:
    """(3,) unit directions that fill the sphere evenly (a Fibonacci lattice)."""
    turn = np.pi * (3 - np.sqrt(5))
    for number in range(_DIRECTIONS):
        height = 1 - (2 * number + 1) / _DIRECTIONS
        yield np.array([np.cos(turn * number), np.sin(turn * number), 0]) * np.sqrt(1 - height**2) + (0, 0, height)
