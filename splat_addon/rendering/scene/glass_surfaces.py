# SPDX-License-Identifier: GPL-3.0-or-later
"""The surfaces of glass as a tree of boxes, in which shaders find what a ray meets.

The tree is complete: node k has the children 2 k and 2 k + 1, so that it is walked without a stack and without links.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...quaternions import quaternion_axes
from ...surfels import Surfels
from .material import reflectance
from .placed import Placed

#: Triangles or discs in a leaf.
LEAF = 4
#: Two to this power blocks of four texels are a row of the texture.
ROW_BITS = 9
#: More are left out: their texture would take a quarter of a gigabyte.
MOST_PRIMITIVES = 1 << 21
#: Square of the sine of a triangle's angle, at least; of one that is thinner nothing is met.
_THINNEST = 1e-10
#: Thickness of sheets, as a share of the diagonal of an object's box.
_SHEET = 1e-3
#: A box of nothing begins here and ends at the negative of it.
_OUTSIDE = 1e30


@dataclass(frozen=True, eq=False)
class GlassSurfaces:
    """N triangles or discs of glass.

    origin: (3,) float64, what places are relative to. corners: (N, 3, 3) float32 of a triangle, or a disc's middle and
    half-axes. normals: (N, 3, 3) for shading, a disc's three times. are_discs: (N,) bool. tints: (N, 3) what a crossing
    keeps of light. iors, roughness: (N,). cast: (N,) bool, shadows. order: (L,) primitives, leaf by leaf, -1 for none.
    low, high: (2 L / LEAF, 6) the boxes of the tree, and of their own normals; row 0 is nothing. without: how many had
    no room.
    """

    origin: np.ndarray
    corners: np.ndarray
    normals: np.ndarray
    are_discs: np.ndarray
    tints: np.ndarray
    iors: np.ndarray
    roughness: np.ndarray
    cast: np.ndarray
    order: np.ndarray
    low: np.ndarray
    high: np.ndarray
    without: int

    @classmethod
    def of(cls, glass: list[tuple[Placed, np.ndarray]]) -> GlassSurfaces:
        """glass: objects, with which of their surfels or corners are of glass."""
        parts, count, without, origin = [], 0, 0, _origin_of([placed for placed, _ in glass])
        for placed, which in glass:
            found = int(np.count_nonzero(which)) // (1 if isinstance(placed.shape, Surfels) else 3)
            if count + found > MOST_PRIMITIVES:
                without += found
                continue
            count += found
            parts.append(_primitives(placed, which, origin))
        arrays = [np.concatenate(column) for column in zip(*(parts or [_NOTHING]), strict=True)]
        return cls(origin, *arrays, *_tree(*_boxes(*arrays[:3])), without)

    @property
    def leaves(self) -> int:
        """Number of leaves, and of the first of them."""
        return len(self.low) // 2

    def texels(self) -> np.ndarray:
        """(h, w, 4) float32: blocks of four texels. Each node has one with the boxes of its two children; then come the
        places of the leaves' primitives, and behind them what else these have."""
        boxes = np.stack([self.low, self.high], axis=1)
        boxes[:, 0, 3], boxes[:, 1, 3] = _packed(self.low[:, 3:], np.floor), _packed(self.high[:, 3:], np.ceil)
        boxes = boxes[..., :4].reshape(-1, 4, 4)
        rows = np.flatnonzero(self.order >= 0)
        places, rest = len(boxes) + rows, len(boxes) + len(self.order) + rows
        blocks = len(boxes) + 2 * len(self.order)
        made = np.zeros((-(-blocks >> ROW_BITS) << ROW_BITS, 4, 4), np.float32)
        of = self.order[rows]
        planes, sizes = _planes(self.corners[of], self.normals[of, 0], self.are_discs[of])
        made[: len(boxes)] = boxes
        made[places, :3], made[places, 3, :3] = planes, self.normals[of, 0]
        made[places, 3, 3] = np.where(self.are_discs[of], sizes / 2, 0.0)
        made[rest, :2, :3], made[rest, 2, :3] = self.normals[of, 1:], self.tints[of]
        made[rest, 0, 3], made[rest, 1, 3], made[rest, 2, 3] = self.iors[of], self.roughness[of], self.cast[of]
        return made.reshape(-1, 4 << ROW_BITS, 4)


def _planes(corners, normals, are_discs) -> tuple[np.ndarray, np.ndarray]:
    """(n, 3, 4) rows that map a place to its height over a triangle or disc and to its coordinates there (Baldwin and
    Weber, "Fast Ray-Triangle Intersections by Coordinate Transformation", JCGT 2016), 0 for one without an area; (n,)
    the longer of its sides from its first corner, or half-axes."""
    corners = np.asarray(corners, np.float64)
    first, (sides, flat) = corners[:, 0], _sides(corners, normals, are_discs)
    squares, area = (sides**2).sum(axis=2), (flat**2).sum(axis=1)
    made = np.zeros((len(corners), 3, 4))
    is_open = area > _THINNEST * squares.prod(axis=1)
    flat, sides, area = flat[is_open], sides[is_open], area[is_open, None]
    rows = np.stack([flat / np.sqrt(area), np.cross(sides[:, 1], flat) / area, np.cross(flat, sides[:, 0]) / area], 1)
    made[is_open, :, :3], made[is_open, :, 3] = rows, -(rows @ first[is_open, :, None])[..., 0]
    return made, np.sqrt(squares.max(axis=1))


def _sides(corners, normals, are_discs) -> tuple[np.ndarray, np.ndarray]:
    """(n, 2, 3) sides from the first corner, or half-axes, and (n, 3) their product, on the side of a disc's normal."""
    sides = corners[:, 1:] - np.where(are_discs, 0.0, 1.0)[:, None, None] * corners[:, :1]
    flat = np.cross(sides[:, 0], sides[:, 1])
    return sides, flat * np.where(are_discs & ((flat * normals).sum(axis=1) < 0), -1.0, 1.0)[:, None]


def _packed(facing: np.ndarray, rounded) -> np.ndarray:
    """(n,) three numbers from -1 to 1 as bytes of one that float32 holds exactly."""
    return rounded((np.clip(facing, -1, 1) + 1) * 127.5) @ (1, 256, 65536)


def _origin_of(placed: list[Placed]) -> np.ndarray:
    if not placed:
        return np.zeros(3)
    one = placed[0]
    middle = one.shape.origin + np.mean(one.shape.local_bounds, axis=0)
    return one.matrix_world[:3, :3] @ middle + one.matrix_world[:3, 3]


_NOTHING = (
    *(np.zeros((0, 3, 3)) for _ in range(2)), np.zeros(0, bool), np.zeros((0, 3)), *(np.zeros(0) for _ in range(2)),
    np.zeros(0, bool),
)  # fmt: skip


def _primitives(placed: Placed, which: np.ndarray, origin: np.ndarray) -> tuple[np.ndarray, ...]:
    """The arrays of one object."""
    shape, linear = placed.shape, placed.matrix_world[:3, :3]
    rows, is_disc = np.flatnonzero(which), isinstance(shape, Surfels)
    away = linear @ shape.origin + placed.matrix_world[:3, 3] - origin
    if is_disc:
        x, y = (
            axis * shape.scales[rows, k : k + 1] for k, axis in enumerate(quaternion_axes(shape.rotations[rows], 2)[:2])
        )
        corners = np.stack([shape.positions[rows] @ linear.T + away, x @ linear.T, y @ linear.T], axis=1)
        normals = np.repeat(_bent(shape.normals[rows], linear)[:, None], 3, axis=1)
        slots, colors = shape.materials[rows], shape.colors[rows, :3]
    else:
        rows = rows.reshape(-1, 3)
        corners = shape.positions[rows] @ linear.T + away
        normals = _bent(shape.normals[rows.ravel()], linear).reshape(-1, 3, 3)
        slots, colors = shape.materials[rows[:, 0]], shape.colors[rows, :3].mean(axis=1)
    materials = [placed.materials[min(slot, len(placed.materials) - 1)] for slot in np.unique(slots)]
    numbers = np.array([(m.finish.tint_power, _ior(m), m.roughness) for m in materials])
    power, ior, roughness = numbers[np.searchsorted(np.unique(slots), slots)].T
    if shape.roughness is not None:
        roughness = shape.roughness[rows if is_disc else rows[:, 0]]
    tints = np.maximum(colors, 0.0) ** power[:, None]
    if not is_disc and np.linalg.det(linear) < 0:
        corners, normals = corners[:, [0, 2, 1]], normals[:, [0, 2, 1]]
    are_discs, cast = (np.full(len(corners), value) for value in (is_disc, placed.casts_shadow))
    made = corners, normals, are_discs, tints, ior, roughness, cast
    thin = np.array([m.finish.is_thin for m in materials])[np.searchsorted(np.unique(slots), slots)]
    return _with_backs(made, np.flatnonzero(thin)) if thin.any() else made


def _with_backs(made: tuple[np.ndarray, ...], rows: np.ndarray) -> tuple[np.ndarray, ...]:
    """The arrays of an object in which these rows are sheets: each is parted into a front and a back."""
    corners, normals, are_discs = (np.array(array) for array in made[:3])
    sides, facing = _sides(corners[rows], normals[rows, 0], are_discs[rows])
    facing /= np.maximum(np.linalg.norm(facing, axis=1, keepdims=True), 1e-30)
    middles = corners[:, 0]
    half = _SHEET / 2 * np.linalg.norm(np.ptp(middles, axis=0)) + _SHEET * np.sqrt((sides**2).sum(axis=2)).max() / 2
    moved = np.where(are_discs[rows, None, None], (1, 0, 0), (1, 1, 1)).reshape(-1, 3, 1) * half * facing[:, None]
    back, turned = corners[rows] - moved, normals[rows][:, [0, 2, 1]] * -1
    corners[rows] += moved
    back = np.where(are_discs[rows, None, None], back, back[:, [0, 2, 1]])
    fronts = corners, normals, *made[2:]
    return tuple(
        np.concatenate([one, other])
        for one, other in zip(fronts, (back, turned, *(a[rows] for a in made[2:])), strict=True)
    )


def _ior(material) -> float:
    """Never below 1, as shaders know it from the reflectance."""
    root = reflectance(material.ior) ** 0.5
    return (1 + root) / (1 - root)


def _bent(normals: np.ndarray, linear: np.ndarray) -> np.ndarray:
    """(n, 3) normals in the world; 0 where the map is flat."""
    cofactors = np.array([np.cross(linear[:, 1], linear[:, 2]), np.cross(linear[:, 2], linear[:, 0]),
                          np.cross(linear[:, 0], linear[:, 1])])  # fmt: skip
    made = normals @ cofactors * (np.sign(np.linalg.det(linear)) or 1.0)
    return made / np.maximum(np.linalg.norm(made, axis=1, keepdims=True), 1e-30)


def _boxes(corners, normals, are_discs) -> tuple[np.ndarray, np.ndarray]:
    """(N, 6) low and high corners of boxes around the primitives, and their own normals twice."""
    low, high = corners.min(axis=1), corners.max(axis=1)
    discs = corners[are_discs]
    reach = np.sqrt((discs[:, 1:] ** 2).sum(axis=1))
    low[are_discs], high[are_discs] = discs[:, 0] - reach, discs[:, 0] + reach
    _, facing = _sides(corners, normals[:, 0], are_discs)
    facing /= np.maximum(np.linalg.norm(facing, axis=1, keepdims=True), 1e-300)
    return np.concatenate([low, facing], axis=1), np.concatenate([high, facing], axis=1)


def _tree(low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """order, low and high as in `GlassSurfaces`: halves are parted across the longest side of their middles' box."""
    leaves = 1
    while leaves * LEAF < len(low):
        leaves *= 2
    order = np.full(leaves * LEAF, -1)
    order[: len(low)] = np.arange(len(low))
    # what is not there comes last, wherever it is parted
    middles = np.concatenate([(low + high)[:, :3] / 2, np.full((1, 3), np.inf)])
    nodes = 1
    while nodes < leaves:
        each = order.reshape(nodes, -1)
        places = middles[each]
        is_there = np.isfinite(places)
        extent = np.where(is_there, places, -np.inf).max(axis=1) - np.where(is_there, places, np.inf).min(axis=1)
        axis = np.nan_to_num(extent, nan=0.0, neginf=0.0).argmax(axis=1)
        keys = np.take_along_axis(places, axis[:, None, None], axis=2)[..., 0]
        order = np.take_along_axis(each, np.argsort(keys, axis=1, kind="stable"), axis=1).ravel()
        nodes *= 2
    ends = []
    for values, nothing, of in ((low, _OUTSIDE, np.min), (high, -_OUTSIDE, np.max)):
        level = of(np.concatenate([values, np.full((1, 6), nothing)])[order].reshape(leaves, LEAF, 6), axis=1)
        levels = [level]
        while len(level) > 1:
            level = of(level.reshape(-1, 2, 6), axis=1)
            levels.append(level)
        ends.append(np.concatenate([np.full((1, 6), nothing), *levels[::-1]]))
    return order, *ends
