# SPDX-License-Identifier: GPL-3.0-or-later
"""The surfaces of a scene for bounced light: the cubes that they fill, and the merged surfels that send and receive.

A merged surfel stands for all points in a cell of several cubes whose normals are nearest to one of six sides.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ...vectors import unit
from .points import Points, joined, with_backs
from .sides import SIDES, facing_sides, side_of
from .voxels import Voxels, make_voxels

#: Cubes along the side of a cell: as few as keep the merged surfels below their number.
_CELLS = (3, 4, 6, 8, 12, 16, 24, 32)
#: How many of a merged surfel's points may be its middle one.
_CANDIDATES = 6
#: Between which of two merged surfels' points, by their share of all, and how much farther above surfaces, in cubes, it
#: is looked whether anything is there: a wall is, and a pole or a rug is not.
_SHARES, _LIFTS = (0.5, 0.1, 0.3, 0.7, 0.9), (0.0, 1.5)
#: What a ray that leaves the scene counts for beside one that does not.
_OUTDOORS = 0.1


@dataclass(frozen=True, eq=False)
class Surfaces:
    """voxels: what is full. cell: cubes along the side of a cell. points: ordered by merged surfel; those of one begin
    at `first` (m + 1,). cells: (m, 3) of each merged surfel, and `sides` (m,). starts: (n, 3) where the points' rays
    begin, relative to `voxels.low`. are_free: (n,) bool, whether that is outside of everything and sees others of the
    merged surfel: of what is on both sides of a wall, only one part counts. numbers: (cells, 6)
    int32 merged surfels of the cells in flat order, -1 for none. present: (cubes,) uint8, a bit for each side that a
    cube has, so that what is met beside an edge is not taken for what is behind it.
    """

    voxels: Voxels
    cell: int
    points: Points
    first: np.ndarray
    cells: np.ndarray
    sides: np.ndarray
    starts: np.ndarray
    are_free: np.ndarray
    numbers: np.ndarray
    present: np.ndarray

    def __len__(self) -> int:
        return len(self.cells)

    def mean(self, values: np.ndarray) -> np.ndarray:
        """(m, c) means of values (n, c) of points."""
        return np.add.reduceat(values, self.first[:-1], axis=0, dtype=np.float64) / np.diff(self.first)[:, None]

    def hit(self, cubes: np.ndarray, directions: np.ndarray) -> np.ndarray:
        """(n,) int32 merged surfels that rays meet in these cubes: of the sides that face the ray, the one that faces
        it most; -1 where none does."""
        cells = self._flat_cells(np.stack(np.unravel_index(cubes, self.voxels.blocks.shape), axis=1) // self.cell)
        facing, present = facing_sides(directions), self.present[cubes]
        found, best = np.full(len(cubes), -1, np.int32), np.zeros(len(cubes), np.float32)
        for axis in range(3):
            side = facing[:, axis]
            size = np.where(present >> side & 1, np.abs(directions[:, axis]), 0)
            is_better = size > best
            found[is_better], best[is_better] = self.numbers[cells, side][is_better], size[is_better]
        return found

    def _flat_cells(self, cells: np.ndarray) -> np.ndarray:
        return np.ravel_multi_index(cells.T, cells_of(self.voxels.blocks.shape, self.cell))

    @cached_property
    def neighbours(self) -> tuple[np.ndarray, np.ndarray]:
        """Pairs of merged surfels of one side in cells beside each other, with nothing between: (p,) of each."""
        first, second = self._beside()
        free = np.flatnonzero(self.are_free)
        begins = np.searchsorted(free, self.first)
        counts = np.diff(begins)
        some = np.flatnonzero((counts[first] > 0) & (counts[second] > 0))
        first, second, seen = first[some], second[some], np.zeros(len(some), bool)
        for share in _SHARES:
            rows = begins[:-1] + (counts * share).astype(int)
            for lift in _LIFTS:
                left = np.flatnonzero(~seen)
                ends = free[rows[first[left]]], free[rows[second[left]]]
                places = (self.starts[own] + lift * self.voxels.edge * self.points.normals[own] for own in ends)
                seen[left] = self.voxels.first_full(*_between(*places)) < 0
        return first[seen], second[seen]

    @property
    def opposite(self) -> np.ndarray:
        """(m,) merged surfels of the opposite sides in the same cells, -1 for none."""
        return self.numbers[self._flat_cells(self.cells), self.sides ^ 1]

    def _beside(self) -> tuple[np.ndarray, np.ndarray]:
        """Pairs of merged surfels of one side in cells beside each other: (p,) of each."""
        shape = np.array(cells_of(self.voxels.blocks.shape, self.cell))
        pairs = []
        for number in range(14, 27):
            step = np.array(np.unravel_index(number, (3, 3, 3))) - 1
            beside = self.cells + step
            rows = np.flatnonzero(((beside >= 0) & (beside < shape)).all(axis=1))
            found = self.numbers[self._flat_cells(beside[rows]), self.sides[rows]]
            pairs.append(np.stack([rows[found >= 0], found[found >= 0]]))
        return tuple(np.concatenate(pairs, axis=1))


def cells_of(shape: tuple[int, ...], cell: int) -> tuple[int, ...]:
    """The number of cells along each axis of a grid of cubes."""
    return tuple(-(-n // cell) for n in shape)


def make_surfaces(
    low: np.ndarray, edge: float, shape: tuple[int, int, int], points: list[Points], most: int
) -> Surfaces:
    """points: at least one of each cube and side that has any. most: merged surfels, about."""
    fronts = joined(points)
    every = with_backs(fronts)
    at = np.floor((every.positions - low) / edge).astype(np.int64)
    cubes = np.ravel_multi_index(at.T, shape)
    voxels = make_voxels(low, edge, shape, cubes[: len(fronts)])
    sides, present = side_of(every.normals), np.zeros(np.prod(shape), np.uint8)
    for side in range(SIDES):
        present[cubes[sides == side]] |= np.uint8(1 << side)
    for cell in _CELLS:
        keys = np.ravel_multi_index((at // cell).T, cells_of(shape, cell)) * SIDES + sides
        numbers = np.full(np.prod(cells_of(shape, cell)) * SIDES, -1, np.int32)
        numbers[keys] = 0
        if np.count_nonzero(numbers == 0) <= most:
            break
    # of a cell with fronts, backs do not count: they are inside of what is there
    have_fronts = np.zeros(len(numbers), bool)
    have_fronts[keys[: len(fronts)]] = True
    is_back = np.arange(len(every)) >= len(fronts)
    order = np.flatnonzero(~(is_back & have_fronts[keys]))
    order = order[np.argsort(keys[order], kind="stable")]
    ordered = keys[order]
    begins = np.flatnonzero(np.concatenate([[True], ordered[1:] != ordered[:-1]]))
    numbers[ordered[begins]] = np.arange(len(begins))
    every = every.taken(order)
    starts = every.positions - low + every.normals * (1.01 * edge * np.abs(every.normals).sum(axis=1, keepdims=True))
    are_free = voxels.blocks.ravel()[voxels.numbers(starts)] > 0
    first = np.append(begins, len(ordered))
    own = at[order[begins]] // cell
    numbers, sides = numbers.reshape(-1, SIDES), sides[order[begins]]
    made = Surfaces(voxels, cell, every, first, own, sides, starts, are_free, numbers, present)
    return replace(made, are_free=_together(made))


def _between(starts: np.ndarray, ends: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rays from (n, 3) places to others: the places, unit directions (n, 3) and lengths (n,)."""
    way = ends - starts
    lengths = np.linalg.norm(way, axis=1)
    return starts, way / np.maximum(lengths, 1e-30)[:, None], lengths


def _together(surfaces: Surfaces) -> np.ndarray:
    """(n,) bool, which free starts of a merged surfel see one of them. Of parts inside and outside of a room, the one
    inside is taken: light that leaks into the dark is seen sooner than shade below eaves."""
    starts, first = surfaces.starts, surfaces.first
    free, sizes = np.flatnonzero(surfaces.are_free), np.diff(first)
    if not len(free):
        return surfaces.are_free
    own = np.repeat(np.arange(len(sizes)), sizes)[free]
    begins, counts = np.searchsorted(own, np.arange(len(sizes))), np.bincount(own, minlength=len(sizes))
    best, chosen, seen = np.zeros(len(sizes)), first[:-1].copy(), np.zeros(len(starts), bool)
    have_any = counts > 0
    for number in range(_CANDIDATES):
        row = (begins + counts * (2 * number + 1) // (2 * _CANDIDATES))[have_any]
        value = np.zeros(len(sizes))
        value[have_any] = _indoors(surfaces, free[row])
        is_better = value > best
        best[is_better], chosen[is_better] = value[is_better], free[row][is_better[have_any]]
    seen[free] = surfaces.voxels.first_full(*_between(starts[chosen[own]], starts[free])) < 0
    return seen


def _indoors(surfaces: Surfaces, rows: np.ndarray) -> np.ndarray:
    """(n,) how far points are in a room, above 0: the share of their rays that end at a side of what is there, and a
    little of those that leave the scene, less that of rays that are within things."""
    around = np.concatenate([np.eye(3), -np.eye(3)]) * 0.8
    directions = unit(surfaces.points.normals[rows, None] + around).reshape(-1, 3)
    cubes = surfaces.voxels.first_full(np.repeat(surfaces.starts[rows], len(around), axis=0), directions)
    is_met = cubes >= 0
    value = np.where(is_met, 0.0, _OUTDOORS)
    value[is_met] = np.where(surfaces.hit(cubes[is_met], directions[is_met]) >= 0, 1.0, -1.0)
    return np.maximum(value.reshape(len(rows), -1).mean(axis=1), _OUTDOORS**2)
