# SPDX-License-Identifier: GPL-3.0-or-later
"""Clip lines of merged surfels: where the surfels of a family end at the same one or two lines, their parent does.

A node's lines are planes across its own: (4 k, n) "lines", four numbers each, unit normal and distance, with
normal . (x - position) + distance >= 0 for what is kept, object units; zeros for no line. k is the number of clip
fields that the surfels have. "cut_off": (n,) the distance by which the ellipse extends beyond what its lines keep; if a
parent cannot keep the lines, so much protrudes.

Of two lines, what is inside both is kept. So a line belongs to the parent only if it leaves what the other children
show. A family with a reflex corner, or with more lines than there are fields, has no lines.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np

from ..clip_lines import CLIP_FIELDS, are_reflex, pack_lines
from .families import dot, for_children
from .nodes import Nodes

#: Maximum distance, in cells, of lines from one that they become, and of what that takes away from other children.
_APART = np.float32(0.1)
#: Minimum cosine between lines that become one.
_ALIKE = np.float32(0.95)
#: Half-axes, the width of a strip that one row of merged surfels fills; their cells are 1.11 wide.
_ONE_ROW = np.float32(1.2)


@dataclass(frozen=True, eq=False)
class Lines:
    """The lines of m parents. planes: (k, 4, m), relative to the parents' positions; zeros for no line. bend: (m,) how
    far the children end from them. are_kept: (m,) bool, whether they stand for all lines of the children."""

    planes: np.ndarray
    bend: np.ndarray
    are_kept: np.ndarray

    def narrow_strips(self, radii: np.ndarray) -> np.ndarray:
        """(m,) the widths of strips between two lines that face each other and leave room for one surfel; else 0.

        How bright a strip is depends on how many rows of surfels it had and where, which one cannot say.
        """
        if len(self.planes) < 2:
            return np.zeros_like(self.bend)
        first, second = self.planes
        width = first[3] + second[3]
        return np.where((dot(first[:3], second[:3]) < 0) & (width < _ONE_ROW * radii), width, 0)


def as_planes(lines: np.ndarray) -> np.ndarray:
    """(k, 4, ...) of (4 k, ...) lines."""
    return lines.reshape(len(lines) // 4, 4, *lines.shape[1:])


def merged_lines(children: Nodes, offsets: np.ndarray, normal: np.ndarray, cell: float) -> Lines:
    """offsets: (3, c, m) positions of the children relative to their parents. normal: (3, m) of the parents' planes."""
    lines = as_planes(children["lines"])
    count, limit = offsets.shape[-1], np.float32(cell) * _APART
    planes, bend = np.zeros((len(lines), 4, count), np.float32), np.zeros(count, np.float32)
    are_kept = np.ones(count, bool)
    left = _Given.of(lines, children, offsets, normal)
    for plane in planes:
        if not len(left.parents):
            break
        apart = left.apart_from(left.planes[:, left.starts])
        mean = left.mean(apart <= limit)
        apart = left.apart_from(mean)
        are_same = apart <= limit
        rows = left.parents[left.starts]
        mean = mean * np.logical_or.reduceat(are_same, left.starts)
        plane[:, rows] = mean
        bend[rows] = np.maximum(bend[rows], np.maximum.reduceat(np.where(are_same, apart, 0), left.starts))
        bend[rows] = np.maximum(bend[rows], _lost(mean, rows, children, offsets, left.some(are_same)))
        left = left.some(~are_same)
    are_kept[left.parents] = False
    are_kept &= bend <= limit
    return Lines(planes * are_kept, bend * are_kept, are_kept)


@dataclass(frozen=True, eq=False)
class _Given:
    """n lines of children in the planes of their parents, those of a family one after another. parents, numbers: (n,)
    of the families, and of the children in them. planes: (4, n), relative to the parents' positions. distances: (n,)
    from the children's centres. offsets: (3, n) of these. radii: (n,) of their ellipses."""

    parents: np.ndarray
    numbers: np.ndarray
    planes: np.ndarray
    distances: np.ndarray
    offsets: np.ndarray
    radii: np.ndarray

    @classmethod
    def of(cls, lines: np.ndarray, children: Nodes, offsets: np.ndarray, normal: np.ndarray) -> _Given:
        """lines: (k, 4, c, m) of the children."""
        parents, numbers = np.nonzero(children["cut_off"].T)
        own = lines[:, :, numbers, parents]
        which, kinds = np.nonzero(own[:, :3].any(axis=1).T)
        parents, numbers, own = parents[which], numbers[which], own[kinds, :, which].T
        offsets, radii = offsets[:, numbers, parents], children["radii"][numbers, parents]
        across = normal[:, parents]
        own[:3] -= dot(own[:3], across) * across
        own /= np.maximum(np.sqrt(dot(own[:3], own[:3])), np.float32(1e-6))
        distances = own[3].copy()
        own[3] -= dot(own[:3], offsets)
        return cls(parents, numbers, own, distances, offsets, radii)

    @cached_property
    def starts(self) -> np.ndarray:
        """Where the lines of each family begin."""
        return np.flatnonzero(np.diff(self.parents, prepend=-1))

    def some(self, are_in: np.ndarray) -> _Given:
        """The lines that are chosen."""
        return _Given(*(getattr(self, field.name)[..., are_in] for field in fields(self)))

    def apart_from(self, plane: np.ndarray) -> np.ndarray:
        """(n,) the largest distances from a line of each family, (4, families), within the children's ellipses."""
        plane = np.repeat(plane, np.diff(self.starts, append=len(self.parents)), axis=1)
        turned = np.sqrt(np.maximum(2 - 2 * dot(self.planes[:3], plane[:3]), 0))
        apart = np.abs(self.distances - dot(plane[:3], self.offsets) - plane[3]) + turned * self.radii
        return np.where(turned < np.sqrt(2 - 2 * _ALIKE), apart, np.inf)

    def mean(self, are_in: np.ndarray) -> np.ndarray:
        """(4, families) the mean of the lines that are chosen."""
        total = np.add.reduceat(self.planes * are_in, self.starts, axis=1)
        return total / np.maximum(np.sqrt(dot(total[:3], total[:3])), np.float32(1e-6))


def _lost(plane: np.ndarray, rows: np.ndarray, children: Nodes, offsets: np.ndarray, whose: _Given) -> np.ndarray:
    """(families,) how far children extend beyond a line of their parent, those excepted `whose` line it is."""
    first, second = children.some(rows, ("first_axis", "second_axis")).axes
    along = for_children(plane[:3])
    support = np.sqrt(dot(along, first) ** 2 + dot(along, second) ** 2)
    beyond = np.maximum(support - dot(along, np.take(offsets, rows, axis=-1)) - for_children(plane[3]), 0)
    beyond[whose.numbers, np.searchsorted(rows, whose.parents)] = 0
    return beyond.max(axis=0)


def clip_fields(lines: np.ndarray, axes: np.ndarray) -> dict[str, np.ndarray]:
    """The clip fields of `Surfels` from (4 k, n) lines. axes: (2, 3, n) half-axis vectors."""
    packed = []
    for plane in as_planes(lines).astype(np.float64):
        in_half_axes = np.stack([*(np.einsum("an,an->n", plane[:3], axis) for axis in axes), plane[3]], axis=1)
        in_half_axes[~plane.any(axis=0)] = 1.0, 0.0, 1.0
        packed.append(pack_lines(in_half_axes))
    if len(packed) == 2:
        # both in the order of a convex corner
        turned = are_reflex(*packed)[:, None]
        packed = [np.where(turned, packed[1 - k], packed[k]) for k in (0, 1)]
    return dict(zip(CLIP_FIELDS, packed, strict=False))
