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

from dataclasses import dataclass

import numpy as np

from ..clip_lines import CLIP_FIELDS, are_reflex, pack_lines
from .families import dot, for_children
from .nodes import Nodes

#: Maximum distance, in cells, of lines from one that they become, and of what that takes away from other children.
_APART = np.float32(0.1)
#: Minimum cosine between lines that become one.
_ALIKE = np.float32(0.95)


@dataclass(frozen=True, eq=False)
class Lines:
    """The lines of m parents. planes: (k, 4, m), relative to the parents' positions; zeros for no line. bend: (m,) how
    far the children end from them. are_kept: (m,) bool, whether they stand for all lines of the children."""

    planes: np.ndarray
    bend: np.ndarray
    are_kept: np.ndarray


def merged_lines(children: Nodes, offsets: np.ndarray, normal: np.ndarray, cell: float) -> Lines:
    """offsets: (3, c, m) positions of the children relative to their parents. normal: (3, m) of the parents' planes."""
    lines = children["lines"].reshape(-1, 4, *offsets.shape[1:])
    kinds, count = len(lines), offsets.shape[-1]
    planes, bend = np.zeros((kinds, 4, count), np.float32), np.zeros(count, np.float32)
    are_kept = np.ones(count, bool)
    some = np.flatnonzero(lines.any(axis=(0, 1, 2)))
    if len(some):
        found = _found(
            _across(lines[..., some], normal[:, some]),
            offsets[..., some],
            [axis[..., some] for axis in children.axes],
            np.float32(cell) * _APART,
        )
        planes[..., some], bend[some], are_kept[some] = found.planes, found.bend, found.are_kept
    return Lines(planes, bend, are_kept)


def _found(lines: np.ndarray, offsets: np.ndarray, axes: list[np.ndarray], limit: np.float32) -> Lines:
    """lines: (k, 4, c, m) of the children. limit: distance up to which they become one."""
    planes, left = np.zeros((len(lines), 4, lines.shape[-1]), np.float32), lines.any(axis=1)
    bend = np.zeros(lines.shape[-1], np.float32)
    for plane in planes:
        # the first that is left, then the mean of those that are like it
        number = left.reshape(-1, left.shape[-1]).argmax(axis=0)
        are_same = np.zeros_like(left)
        are_same.reshape(-1, left.shape[-1])[number, np.arange(len(number))] = True
        for _ in range(2):
            are_same &= left
            plane[...] = _mean(lines, are_same, offsets)
            apart = _apart(plane, lines, offsets, axes)
            are_same = left & (apart <= limit)
        has = are_same.any(axis=(0, 1))
        plane *= has
        apart = np.where(are_same, apart, 0).max(axis=(0, 1))
        lost = np.where(are_same.any(axis=0), 0, _beyond(plane, offsets, axes)).max(axis=0)
        bend = np.maximum(bend, np.where(has, np.maximum(apart, lost), 0))
        left &= ~are_same
    are_kept = ~left.any(axis=(0, 1)) & (bend <= limit)
    return Lines(planes * are_kept, bend * are_kept, are_kept)


def _across(lines: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """(k, 4, c, m) lines of the children as lines in their parents' planes."""
    height = np.einsum("iacm,am->icm", lines[:, :3], normal)
    across = lines.copy()
    across[:, :3] -= height[:, None] * normal[None, :, None]
    return across / np.maximum(np.sqrt((across[:, :3] ** 2).sum(axis=1)), np.float32(1e-6))[:, None]


def _mean(lines: np.ndarray, are_in: np.ndarray, offsets: np.ndarray) -> np.ndarray:
    """(4, m) the mean of the lines that are chosen, (k, c, m) bool; zeros of none."""
    at_parent = np.concatenate([lines[:, :3], (lines[:, 3] - (lines[:, :3] * offsets).sum(axis=1))[:, None]], axis=1)
    total = (at_parent * are_in[:, None]).sum(axis=(0, 2))
    return total / np.maximum(np.sqrt((total[:3] ** 2).sum(axis=0)), np.float32(1e-6))


def _apart(plane: np.ndarray, lines: np.ndarray, offsets: np.ndarray, axes: list[np.ndarray]) -> np.ndarray:
    """(k, c, m) the largest distance of a parent's line from those of its children, where these are."""
    turned = np.sqrt(((lines[:, :3] - plane[None, :3, None]) ** 2).sum(axis=1))
    turned = np.where(turned < np.sqrt(2 - 2 * _ALIKE), turned, np.inf)
    radius = np.sqrt(np.maximum(*(dot(axis, axis) for axis in axes)))
    here = dot(for_children(plane[:3]), offsets) + for_children(plane[3])
    return np.abs(lines[:, 3] - here) + turned * radius


def _beyond(plane: np.ndarray, offsets: np.ndarray, axes: list[np.ndarray]) -> np.ndarray:
    """(c, m) how far the children's ellipses extend beyond a parent's line."""
    along = for_children(plane[:3])
    support = np.sqrt(dot(along, axes[0]) ** 2 + dot(along, axes[1]) ** 2)
    return np.maximum(support - dot(along, offsets) - for_children(plane[3]), 0)


def cut_off(planes: np.ndarray, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """(m,) float32 as in `Nodes`. first, second: (3, m) half-axes."""
    supports = np.sqrt(sum(np.einsum("kam,am->km", planes[:, :3], axis) ** 2 for axis in (first, second)))
    depths = np.where(supports > 0, np.maximum(supports - planes[:, 3], 0), 0)
    longest = np.sqrt(np.maximum(*((axis**2).sum(axis=0) for axis in (first, second))))
    is_any = ((depths > 0).sum(axis=0) > 1) | (depths.max(axis=0) > longest)
    return np.where(is_any, 2 * longest, depths.max(axis=0)).astype(np.float32)


def clip_fields(lines: np.ndarray, axes: np.ndarray) -> dict[str, np.ndarray]:
    """The clip fields of `Surfels` from (4 k, n) lines. axes: (2, 3, n) half-axis vectors."""
    planes = lines.reshape(-1, 4, lines.shape[-1]).astype(np.float64)
    packed = []
    for plane in planes:
        in_half_axes = np.stack([*(np.einsum("an,an->n", plane[:3], axis) for axis in axes), plane[3]], axis=1)
        in_half_axes[~plane.any(axis=0)] = 1.0, 0.0, 1.0
        packed.append(pack_lines(in_half_axes))
    if len(packed) == 2:
        # both in the order of a convex corner
        turned = are_reflex(*packed)[:, None]
        packed = [np.where(turned, packed[1 - k], packed[k]) for k in (0, 1)]
    return dict(zip(CLIP_FIELDS, packed, strict=False))
