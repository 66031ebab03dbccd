# SPDX-License-Identifier: GPL-3.0-or-later
"""Which small cubes of space hold a surface, and the rays that find the first one (Amanatides and Woo 1987).

A cube is full if any point of a surface is in it, so that surfaces are closed whatever their points' sizes: nothing
leaks through a wall.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

#: Blocks of 2^k cubes along a side, up to this k, are passed in one step where they are empty.
_LARGEST_BLOCK = 4
#: The number of the outermost cubes, which end rays.
OUTSIDE = 255
#: Of a cube, how far beyond a side a place is taken to be, so that rounding does not repeat a step; and the least of a
#: direction's numbers.
_BEYOND, _LEAST = 1e-3, 1e-6
#: Rays that are followed together.
PORTION = 1 << 14


@dataclass(frozen=True, eq=False)
class Voxels:
    """low: (3,) float64 corner of the grid. edge: of a cube. blocks: (x, y, z) uint8, 0 for a full cube, and otherwise
    1 more than the k of the largest empty block of 2^k cubes that it is in; OUTSIDE for the outermost ones, which are
    empty."""

    low: np.ndarray
    edge: float
    blocks: np.ndarray

    def numbers(self, positions: np.ndarray) -> np.ndarray:
        """(n,) int64 numbers of the cubes of (n, 3) positions, from `low`, in the flat order of `blocks`."""
        return np.ravel_multi_index(np.floor(positions / self.edge).astype(np.int64).T, self.blocks.shape)

    def first_full(self, starts: np.ndarray, directions: np.ndarray, lengths: np.ndarray | None = None) -> np.ndarray:
        """(n,) int32 number of the first full cube that each ray meets; -1 if there is none. The cube that a ray starts
        in counts, and all must start in the grid.

        starts: (n, 3) from `low`. directions: (n, 3), unit. lengths: (n,) how far rays go; None: to the end.
        """
        found = np.full(len(starts), -1, np.int32)
        followed, blocks, done = None, self.blocks.ravel(), 0
        while done < len(starts) or followed is not None:
            if done < len(starts) and (followed is None or len(followed) < PORTION // 2):
                some = slice(done, done + PORTION)
                left = None if lengths is None else lengths[some] / self.edge
                numbers = np.arange(len(starts), dtype=np.int32)[some]
                fresh = _Rays.beginning(starts[some] / self.edge, directions[some], left, numbers)
                followed = fresh if followed is None else followed.joined(fresh)
                done += PORTION
            followed = followed.stepped(blocks, self.blocks.shape, found)
        return found


@dataclass(frozen=True, eq=False)
class _Rays:
    """n rays on their way, in cubes. at, toward, inverse, ahead, nudge: (3, n) float32, where they are, the direction,
    its inverse, 1 where it is positive, and a bit of it. left: (n,) how far they go. numbers: (n,)."""

    at: np.ndarray
    toward: np.ndarray
    inverse: np.ndarray
    ahead: np.ndarray
    nudge: np.ndarray
    left: np.ndarray | None
    numbers: np.ndarray

    def __len__(self) -> int:
        return len(self.numbers)

    @classmethod
    def beginning(cls, starts, directions, lengths, numbers) -> _Rays:
        toward = np.ascontiguousarray(directions.T, np.float32)
        toward = np.where(np.abs(toward) > _LEAST, toward, np.float32(_LEAST))
        ahead = (toward > 0).astype(np.float32)
        left = None if lengths is None else lengths.astype(np.float32)
        at = np.ascontiguousarray(starts.T, np.float32)
        return cls(at, toward, 1 / toward, ahead, (2 * ahead - 1) * np.float32(_BEYOND), left, numbers)

    def joined(self, others: _Rays) -> _Rays:
        own, theirs = vars(self).values(), vars(others).values()
        return _Rays(
            *(None if a is None else np.concatenate([a, b], axis=-1) for a, b in zip(own, theirs, strict=True))
        )

    def stepped(self, blocks: np.ndarray, shape: tuple[int, ...], found: np.ndarray) -> _Rays | None:
        """The rays that go on, each at the end of the block that it is in; None if none do."""
        beyond = self.at + self.nudge
        x, y, z = beyond.astype(np.int32)
        number = (x * np.int32(shape[1]) + y) * np.int32(shape[2]) + z
        block = blocks[number]
        ends = block == 0
        if ends.any():
            found[self.numbers[ends]] = number[ends]
        ends |= block == OUTSIDE
        size = _SIZES[block]
        step = ((np.floor(beyond / size) + self.ahead) * size - self.at) * self.inverse
        step = np.minimum(np.minimum(step[0], step[1]), step[2])
        left = None
        if self.left is not None:
            left = self.left - step
            ends |= self.left <= 0
        moved = _Rays(
            self.at + self.toward * step, self.toward, self.inverse, self.ahead, self.nudge, left, self.numbers
        )
        if not ends.any():
            return moved
        rows = np.flatnonzero(~ends)
        kept = (None if array is None else array.take(rows, axis=-1) for array in vars(moved).values())
        return _Rays(*kept) if len(rows) else None


#: The edge of a block, by its number in `blocks`.
_SIZES = np.ones(256, np.float32)
_SIZES[1 : _LARGEST_BLOCK + 2] = 2.0 ** np.arange(_LARGEST_BLOCK + 1)


def make_voxels(low: np.ndarray, edge: float, shape: tuple[int, int, int], full: np.ndarray) -> Voxels:
    """The grid whose cubes with these numbers are full. shape: of the grid, multiples of 16."""
    is_full = np.zeros(shape, bool)
    is_full.ravel()[full] = True
    blocks, level = (~is_full).astype(np.uint8), is_full.copy()
    for axis in range(3):
        for grid, value in ((blocks, OUTSIDE), (level, True)):
            np.moveaxis(grid, axis, 0)[[0, -1]] = value
    for k in range(1, _LARGEST_BLOCK + 1):
        x, y, z = (n // 2 for n in level.shape)
        level = level.reshape(x, 2, y, 2, z, 2).any(axis=(1, 3, 5))
        side = 1 << k
        parts = blocks.reshape(x, side, y, side, z, side)
        np.copyto(parts, k + 1, where=~level[:, None, :, None, :, None])
    return Voxels(np.asarray(low, np.float64), float(edge), blocks)
