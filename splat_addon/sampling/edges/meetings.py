# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds where borders cross splats: each edge of the same piece of surface, relative to the splat.

A place on a border is seen along the axis of the surfel's image, and given in half-axes of its splat, in which this is
the unit circle.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import NamedTuple

import numpy as np

from ...quaternions import axes_columns, quaternion_axes
from ..ldc.grid import Grid
from ..table import SampleTable
from .borders import Borders
from .image_neighbours import Neighbours, image_neighbours

#: Rows of surfels by the axis of the image that sees them: a slice or their numbers.
Images = list[tuple[int, slice | np.ndarray]]

#: A face is considered in the images whose axis has at least this share of its normal.
_LEAST_SHARE = 0.4

#: Least cosine between a surfel's plane and a face that its border belongs to: of one smooth piece of surface.
_SAME_PIECE = np.float32(np.cos(np.radians(40)))

#: How far off a face's plane a surfel of the same piece of surface may be: this share of its distance from the edge,
#: and of its size.
_OFF_PLANE, _OFF_ANYHOW = np.float32(0.35), np.float32(0.1)

#: A surfel this far beyond an edge, in half-axes, and not beyond its ends, is of another piece of surface.
BEYOND = np.float32(-0.05)

#: A surfel that lies at no cell's centre is at most this far from one, in cells.
_OFF_CENTRE = np.sqrt(0.5)


@dataclass(frozen=True, eq=False)
class Meetings:
    """m meetings of a surfel with a side of an edge.

    surfel, side: (m,) intp. number: (m,) intp, of the surfel among those `seen`. start, end: (2, m) float32 in the unit
    circle, with the surface at the left. line: (3, m) float32 of unit direction, above 0 on the surface. distance: (m,)
    float32, of the edge from the centre. facing: (m,) float32 cosine between both planes, without its sign.
    """

    surfel: np.ndarray
    number: np.ndarray
    side: np.ndarray
    start: np.ndarray
    end: np.ndarray
    line: np.ndarray
    distance: np.ndarray
    facing: np.ndarray
    seen: SeenSurfels

    def __len__(self) -> int:
        return len(self.surfel)

    def take(self, rows: np.ndarray) -> Meetings:
        given = {name: of.take(rows, axis=-1) for name, of in vars(self).items() if name != "seen"}
        return replace(self, **given)


def by_facing(arrays: SampleTable) -> Images:
    """Each surfel in the image along the axis that it faces most."""
    facing = np.abs(quaternion_axes(arrays["rotations"])[2]).argmax(axis=1)
    return [(axis, np.flatnonzero(facing == axis)) for axis in range(3)]


def meetings(
    arrays, images: Images, borders: Borders, grid: Grid, at_centres: bool = True
) -> Iterator[Callable[[], Meetings]]:
    """Yields jobs that find the meetings of surfels with the sides of borders: all of a surfel's are found by one.

    arrays: by field of `Surfels`, positions relative to the grid's middle. at_centres: whether the surfels lie at the
    centres of cells.
    """
    ends = np.stack([borders.start, borders.end]) - grid.surfel_origin
    ends = np.ascontiguousarray(np.moveaxis(ends, 2, 1) / grid.spacing, np.float32)
    normals = np.ascontiguousarray(borders.normals.T, np.float32)
    for axis, rows in images:
        faces = np.flatnonzero(np.abs(normals[axis]) >= _LEAST_SHARE)
        order = [(axis + k) % 3 for k in (1, 2, 0)]
        sides = _Sides(
            faces, ends[:, order].take(faces, axis=2), borders.edges.take(faces), normals[order].take(faces, axis=1)
        )
        yield from _in_image(arrays, axis, rows, sides, grid, at_centres)


class _Sides(NamedTuple):
    """n sides of borders that an image sees, in its own order of axes: across, up and along its axis.

    numbers: (n,) among all sides. ends: (2, 3, n) float32, in cells from the grid's middle. edges: (n,) of which edge.
    normals: (3, n) float32 of their faces.
    """

    numbers: np.ndarray
    ends: np.ndarray
    edges: np.ndarray
    normals: np.ndarray


def _in_image(
    arrays: SampleTable, axis: int, rows: slice | np.ndarray, sides: _Sides, grid: Grid, at_centres: bool
) -> Iterator[Callable[[], Meetings]]:
    """Yields jobs that find where the sides that an image sees meet the surfels that it sees. rows: of the latter."""
    ends, normals = sides.ends, sides.normals
    positions, scales, rotations = (arrays[name][rows] for name in ("positions", "scales", "rotations"))
    # The smaller half-axis lies across the image's axis, the larger one is foreshortened to it.
    reaches = scales[:, 1] if isinstance(rows, slice) else _reaches(scales, rotations, axis)
    reach = float(reaches.max(initial=0)) / grid.spacing
    search = reach if at_centres else reach + _OFF_CENTRE
    rises = -normals[:2] / normals[2]
    planes = np.stack([*rises, ends[0, 2] - (ends[0, :2] * rises).sum(axis=0)])
    farthest = np.sqrt(3) * reach * (_OFF_PLANE + _OFF_ANYHOW) / _LEAST_SHARE
    inverse_spacing = np.float32(1 / grid.spacing)

    def met(find: Callable[[], Neighbours]) -> Meetings:
        near, surfel, side, above = find()
        # Only now that few are left, gather their attributes.
        is_left = np.zeros(len(near), bool)
        is_left[surfel] = True
        near, number = near.compress(is_left), np.cumsum(is_left) - 1
        seen = SeenSurfels(axis, *(of.take(near, axis=0) for of in (positions, scales, rotations)), inverse_spacing)
        numbers = near + rows.start if isinstance(rows, slice) else rows.take(near)
        found = _met(seen, numbers, number.take(surfel), side, above, ends[:, :2], normals)
        return replace(found, side=sides.numbers.take(found.side))

    found = image_neighbours(positions, axis, ends[:, :2], sides.edges, planes, search, farthest, grid)
    return (partial(met, find) for find in found)


def _met(
    seen: SeenSurfels, numbers: np.ndarray, surfel, side, above, ends: np.ndarray, normals: np.ndarray
) -> Meetings:
    """The pairs that do meet. numbers: (s,) of the seen surfels."""
    off = np.abs(above * normals[2].take(side))
    facing = sum(n.take(side) * own.take(surfel) for n, own in zip(normals, seen.normal, strict=True))
    alike = np.flatnonzero(np.abs(facing) >= _SAME_PIECE)
    surfel, side, facing, off = (values.take(alike) for values in (surfel, side, facing, off))
    start, end = seen.in_circles(surfel, *(of.take(side, axis=1) for of in ends.swapaxes(0, 1)))
    # The face lies at the left of its edge where it is seen from the side that its normal points to.
    turned = facing < 0
    _swap(start, end, turned)
    share, distance = nearest_on_segment(start, end)
    line = line_along(start, end)
    meets = distance < 1
    meets &= off <= (_OFF_PLANE * distance + _OFF_ANYHOW) * seen.size.take(surfel)
    meets &= (line[2] >= BEYOND) | (share == 0) | (share == 1)
    at = np.flatnonzero(meets)
    values = surfel, side, start, end, line, distance, np.abs(facing)
    surfel, *others = (of.take(at, axis=-1) for of in values)
    return Meetings(numbers.take(surfel), surfel, *others, seen)


class SeenSurfels:
    """s surfels as the image along an axis sees them, in cells.

    normal: (3, s), across, up and along its axis. place: (2, s) from the grid's middle. inverse: (4, s), row by row,
    from cells to half-axes. size: (s,) the larger half-axis.
    """

    def __init__(self, axis: int, positions, scales, rotations, inverse_spacing: np.float32):
        order = [(axis + k) % 3 for k in (1, 2, 0)]
        scales = np.ascontiguousarray(scales.T) * inverse_spacing
        x, y, z = axes_columns(rotations, 0, 1, 2)
        self.axis, self.normal = axis, z[order]
        self.place = np.ascontiguousarray(positions.T[order[:2]]) * inverse_spacing
        (xu, xv), (yu, yv) = (half_axis[order[:2]] * size for half_axis, size in zip((x, y), scales, strict=True))
        determinant = xu * yv - yu * xv
        self.inverse = np.stack([yv, -yu, -xv, xu])
        self.inverse /= np.where(np.abs(determinant) > 1e-12, determinant, np.float32(1e-12))
        self.size = np.maximum(*scales)

    def in_circles(self, surfel: np.ndarray, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """(k, 2, m) (k, m) places across and up in the image, in the half-axes of the (m,) surfels."""
        u, v = u - self.place[0].take(surfel), v - self.place[1].take(surfel)
        a, b, c, d = (row.take(surfel) for row in self.inverse)
        places = np.empty((len(u), 2, len(surfel)), np.float32)
        np.add(a * u, b * v, out=places[:, 0])
        np.add(c * u, d * v, out=places[:, 1])
        return places


def _reaches(scales: np.ndarray, rotations: np.ndarray, axis: int) -> np.ndarray:
    """(n,) how far the ellipses reach from their centres, seen along an axis, object units."""
    order = [(axis + k) % 3 for k in (1, 2)]
    (a, b), (c, d) = (of[order] * size for of, size in zip(axes_columns(rotations, 0, 1), scales.T, strict=True))
    # the larger singular value
    return (np.hypot(a + d, b - c) + np.hypot(a - d, b + c)) / 2


def _swap(one: np.ndarray, other: np.ndarray, where: np.ndarray) -> None:
    """Exchange (2, m) float32 values in place where (m,) is True. Bits are exchanged by arithmetic, because numpy's
    choices take several times as long where they follow no pattern."""
    a, b = one.view(np.int32), other.view(np.int32)
    difference = a ^ b
    difference &= -where.astype(np.int32)
    a ^= difference
    b ^= difference


def nearest_on_segment(start: np.ndarray, end: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(m,) fraction of the way along a segment in the plane at which it is nearest to (0, 0), and (m,) its distance
    there."""
    (x, y), (u, v) = start, end - start
    share = -(x * u + y * v)
    share /= np.maximum(u * u + v * v, np.float32(1e-30))
    np.clip(share, 0, 1, out=share)
    return share, np.hypot(x + u * share, y + v * share)


def line_along(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """(3, m) lines of unit direction through two places each, above 0 at the left."""
    u, v = end - start
    scale = 1 / np.maximum(np.sqrt(u * u + v * v), np.float32(1e-30))
    a, b = -v * scale, u * scale
    return np.stack([a, b, -(a * start[0] + b * start[1])])
