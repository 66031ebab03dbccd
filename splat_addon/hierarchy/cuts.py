# SPDX-License-Identifier: GPL-3.0-or-later
"""The cut through a hierarchy that a view draws: blocks whose error in pixels is within a tolerance while their
parents' is not, except blocks outside the picture and blocks that only face away.

The test uses a block's largest error and nearest depth, which bound all blocks under it: if a block is fine enough, so
are its children, so every place is drawn once, at one level (Dachsbacher et al. 2003).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..runs import ranges
from .blocks import Blocks
from .building import Hierarchy


@dataclass(frozen=True, eq=False)
class Split:
    """Where an object that is polygons near the eye is surfels.

    model_view: (3, 4) from the object's space to the view's, world units. begin: distance from the eye at which surfels
    begin, judged by their centres. end: distance at which polygons end. Merged surfels must lie wholly beyond it, so
    that the surfels that meet the polygons are the finest.
    """

    model_view: np.ndarray
    begin: float
    end: float


@dataclass(frozen=True, eq=False)
class Sight:
    """A view of one object, in the object's space, relative to the surfels' origin.

    planes: (k, 4): n . p + d >= 0 inside the picture. depth: (4,): n . p + d is the distance along the view, in world
    units. pixels: the most pixels that an object unit covers, at distance 1 of a perspective view or anywhere in a
    parallel one. near: the smallest distance that counts, world units. eye: (4,) homogeneous; w = 0 for the direction
    towards the eye of a parallel view. hides_backs: whether backs are invisible. tolerance: in pixels; 0 draws the
    surfels themselves. is_depth_only: colours and normals are not seen, so that their errors do not count. split: None
    for an object that is surfels everywhere.
    """

    planes: np.ndarray
    depth: np.ndarray
    pixels: float
    near: float
    eye: np.ndarray
    hides_backs: bool
    tolerance: float
    is_depth_only: bool = False
    split: Split | None = None

    @property
    def key(self) -> bytes:
        """A key that is equal for equal views."""
        single = self.pixels, self.near, self.hides_backs, self.tolerance, self.is_depth_only
        numbers = (self.planes, self.depth, self.eye, single)
        if self.split:
            numbers += self.split.model_view, (self.split.begin, self.split.end)
        return b"".join(np.asarray(n, np.float64).tobytes() for n in numbers)

    @property
    def is_parallel(self) -> bool:
        return self.eye[3] == 0


class Boxes(NamedTuple):
    """The boxes of n blocks. middle, half: (3, n) float64, the latter half their extent."""

    middle: np.ndarray
    half: np.ndarray

    @classmethod
    def of(cls, blocks: Blocks, rows: np.ndarray) -> Boxes:
        low, high = (np.take(corner, rows, axis=0).T.astype(np.float64) for corner in (blocks.low, blocks.high))
        return cls((low + high) / 2, (high - low) / 2)

    def some(self, are: np.ndarray) -> Boxes:
        """The boxes where `are`, (n,) bool, is true."""
        return Boxes(self.middle[:, are], self.half[:, are])


def entries_of(hierarchy: Hierarchy, rows: np.ndarray) -> np.ndarray | None:
    """(n,) int32 indices of the surfels and nodes of some blocks, neighbours together; None: all surfels, in any
    order."""
    first, last = hierarchy.blocks.first[rows], hierarchy.blocks.last[rows]
    if (last <= hierarchy.surfels).all() and int((last - first).sum()) == hierarchy.surfels:
        return None
    return hierarchy.entries[ranges(first, last - first)]


def cut_blocks(blocks: Blocks, sight: Sight) -> np.ndarray:
    """(n,) int32, the indices of the blocks that are drawn."""
    front, drawn = np.arange(int(blocks.roots)), []
    first = _judged(blocks, np.arange(min(len(blocks), _AT_ONCE)), sight)
    while len(front):
        # children follow their parents, so that the last of a front is its largest number
        is_known = front[-1] < len(first[0])
        is_seen, is_fine = (known[front] for known in first) if is_known else _judged(blocks, front, sight)
        begin, end = blocks.first_child[front], blocks.last_child[front]
        is_fine = is_fine | (begin == end)
        drawn.append(front[is_seen & is_fine])
        is_coarse = is_seen & ~is_fine
        front = ranges(begin[is_coarse], (end - begin)[is_coarse])
    return np.concatenate(drawn).astype(np.int32) if drawn else np.zeros(0, np.int32)


#: Blocks of the coarsest levels that are judged at once, whether they are asked for or not: levels of few blocks take
#: as long.
_AT_ONCE = 288


def _judged(blocks: Blocks, rows: np.ndarray, sight: Sight) -> tuple[np.ndarray, np.ndarray]:
    """(n,) bool: which blocks may be seen, and which are fine enough."""
    boxes = Boxes.of(blocks, rows)
    # errors of unseen blocks, too: leaving their boxes out would take longer
    is_seen = may_be_seen(blocks, rows, boxes, sight)
    is_fine = pixels_of_errors(blocks, rows, boxes, sight) <= sight.tolerance
    if sight.split:
        near, far = distances(boxes, sight)
        is_seen &= far >= sight.split.begin
        is_fine &= near > sight.split.end
    return is_seen, is_fine


def pixels_of_errors(blocks: Blocks, rows: np.ndarray, boxes: Boxes, sight: Sight) -> np.ndarray:
    """(n,) largest error of each block in pixels, at its nearest point."""
    off, extent, shown = blocks.errors[rows].T
    error = np.maximum(off, extent)
    if not sight.is_depth_only:
        error = np.maximum(error, shown)
    error = error.astype(np.float64) * sight.pixels
    if sight.is_parallel:
        return error
    nearest = sight.depth[:3] @ boxes.middle + sight.depth[3] - np.abs(sight.depth[:3]) @ boxes.half
    # merged surfels must not touch the near plane, where methods may treat splats differently
    error = np.where((nearest > sight.near) | (error == 0), error, np.inf)
    return error / np.maximum(nearest, sight.near)


def distances(boxes: Boxes, sight: Sight) -> tuple[np.ndarray, np.ndarray]:
    """(n,) bounds on the distances of each block's points from the eye, along the view if it is parallel."""
    matrix = sight.split.model_view
    middle, half = matrix[:, :3] @ boxes.middle + matrix[:, 3:], np.abs(matrix[:, :3]) @ boxes.half
    if sight.is_parallel:
        return -middle[2] - half[2], -middle[2] + half[2]
    away = np.abs(middle)
    return np.linalg.norm(np.maximum(away - half, 0), axis=0), np.linalg.norm(away + half, axis=0)


def may_be_seen(blocks: Blocks, rows: np.ndarray, boxes: Boxes, sight: Sight) -> np.ndarray:
    """(n,) bool: whether the box intersects the view volume, and the cone of normals contains a direction towards the
    eye."""
    middle, half = boxes
    planes, offsets = sight.planes[:, :3], sight.planes[:, 3:]
    seen = (planes @ middle + offsets + np.abs(planes) @ half >= 0).all(axis=0)
    if sight.hides_backs:
        away = _away(middle, sight)
        distance = np.maximum(np.linalg.norm(away, axis=0), 1e-300)
        radius = 0.0 if sight.is_parallel else np.linalg.norm(half, axis=0)
        angle = np.arccos(np.clip(np.einsum("kn,nk->n", away, blocks.axes[rows]) / distance, -1, 1))
        # every normal of the cone points away from every point of the box
        angle = angle + blocks.angles[rows]
        seen &= ~((angle < np.pi / 2) & (distance * np.cos(angle) > radius))
    return seen


def are_facing(blocks: Blocks, rows: np.ndarray, sight: Sight) -> np.ndarray:
    """(n,) bool: whether the middle of a block's normals faces the eye from the middle of its box."""
    away = _away(Boxes.of(blocks, rows).middle, sight)
    return np.einsum("kn,nk->n", away, blocks.axes[rows]) < 0


def _away(middle: np.ndarray, sight: Sight) -> np.ndarray:
    """(3, n) directions from the eye."""
    eye = sight.eye[:3, None]
    return -np.broadcast_to(eye, middle.shape) if sight.is_parallel else middle - eye
