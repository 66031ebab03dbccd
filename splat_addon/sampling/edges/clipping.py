# SPDX-License-Identifier: GPL-3.0-or-later
"""Cuts surfels at the borders of their surface: each gets the lines of `clip_lines` that its mesh asks for.

Flow: `borders` -> which surfels lie near which edges (`edge_neighbours`) -> each edge as its surfel's plane sees it,
with the ellipse as the unit circle -> one line, or the two that keep what lies within the border best.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from ...clip_lines import CLIP_FIELDS, are_reflex, pack_lines, unpack_lines
from ...surfels import quaternion_axes
from .borders import Borders
from .edge_neighbours import edge_neighbours

#: Least cosine between a surfel's plane and a face that its border belongs to: of one smooth piece of surface.
_SAME_PIECE = np.cos(np.radians(40))

#: How far off a face's plane a surfel of the same piece of surface may be: this share of its distance from the edge,
#: and of its size.
_OFF_PLANE, _OFF_ANYHOW = 0.35, 0.1

#: A border within this of a line, in half-axes, is that line.
_SAME_LINE = 0.06

#: Where a corner is judged: rings of places in the unit circle, and how much each weighs.
_RINGS = ((0.3, 6), (0.6, 10), (0.85, 16), (0.98, 24))


@dataclass(frozen=True, eq=False)
class _Sides:
    """m meetings of a surfel with a side of an edge, ordered by surfel. surfel, side: (m,). start, end: (m, 2) in the
    unit circle. line: (m, 3) of unit direction. distance: (m,) of the edge from the centre."""

    surfel: np.ndarray
    side: np.ndarray
    start: np.ndarray
    end: np.ndarray
    line: np.ndarray
    distance: np.ndarray

    def take(self, rows: np.ndarray) -> _Sides:
        return _Sides(*(getattr(self, f.name)[rows] for f in fields(self)))


@dataclass(frozen=True, eq=False)
class Clipping:
    """fields: `CLIP_FIELDS` of the surfels, those that are needed. surfel, side: (m,) which surfels meet which sides of
    the borders. lines: (m, 2, 3) at which that surfel ends, of unit direction, and reflex: (m,) bool (`clip_lines`)."""

    fields: dict[str, np.ndarray]
    surfel: np.ndarray
    side: np.ndarray
    lines: np.ndarray
    reflex: np.ndarray


def clip(arrays: dict[str, np.ndarray], borders: Borders, origin: np.ndarray) -> Clipping:
    """Where surfels end.

    arrays: by field of `Surfels`, positions relative to `origin`.
    """
    count = len(arrays["positions"])
    sides = _sides(arrays, borders, origin) if len(borders) and count else None
    if sides is None or not len(sides.surfel):
        return Clipping({}, *np.zeros((2, 0), np.intp), np.zeros((0, 2, 3)), np.zeros(0, bool))
    is_first = np.append(True, sides.surfel[1:] != sides.surfel[:-1])
    first = np.flatnonzero(is_first)
    surfel, lines = sides.surfel[first], sides.line[first]
    second = np.zeros((len(first), 3))
    second[:, 2] = 1
    owner = np.cumsum(is_first) - 1
    is_corner = _needs_more(sides, lines[owner])
    corners = np.unique(owner[is_corner])
    if len(corners):
        rows = np.flatnonzero(np.isin(owner, corners))
        lines[corners], second[corners] = _corners(sides.take(rows), np.searchsorted(corners, owner[rows]))
    result, both = {}, [pack_lines(values) for values in (lines, second)]
    for name, packed in zip(CLIP_FIELDS, both, strict=True):
        packed[packed[:, 1] == 0] = 0
        if packed.any():
            result[name] = np.zeros((count, 2), np.int16)
            result[name][surfel] = packed
    lines, reflex = np.stack([unpack_lines(packed) for packed in both], axis=1), are_reflex(*both)
    return Clipping(result, sides.surfel, sides.side, lines[owner], reflex[owner])


def _sides(arrays: dict[str, np.ndarray], borders: Borders, origin: np.ndarray) -> _Sides:
    """Of each surfel the sides of edges that reach into its ellipse, the nearest first."""
    surfel, side = edge_neighbours(arrays["positions"], np.maximum(*arrays["scales"].T), borders, origin)
    axes = quaternion_axes(arrays["rotations"][surfel])
    x, y, z = (axis.astype(np.float64) for axis in axes)
    center = arrays["positions"][surfel] + origin
    sizes = arrays["scales"][surfel].astype(np.float64)
    to_start, to_end = borders.start[side] - center, borders.end[side] - center
    inward, normal = borders.inward[side], borders.normals[side]
    start, end = (np.stack([_dot(t, x) / sizes[:, 0], _dot(t, y) / sizes[:, 1]], axis=1) for t in (to_start, to_end))
    nearest, distance = _nearest_on_segment(start, end)
    line = np.stack([_dot(inward, x) * sizes[:, 0], _dot(inward, y) * sizes[:, 1], -_dot(to_start, inward)], axis=1)
    length = np.hypot(line[:, 0], line[:, 1])
    line /= np.maximum(length, 1e-300)[:, None]
    off = np.abs(_dot(to_start, normal))
    aside = np.linalg.norm(to_start + (to_end - to_start) * nearest[:, None], axis=1)
    facing = np.abs(_dot(z, normal))
    meets = (distance < 1) & (facing >= _SAME_PIECE) & (off <= _OFF_PLANE * aside + _OFF_ANYHOW * sizes.min(axis=1))
    meets &= length > 0
    likeness = _unlikeness(arrays, surfel, z, borders, side) + 0.01 * (line[:, 2] < 0)
    rows = _most_alike(np.flatnonzero(meets), surfel, borders.edges[side], likeness)
    # At an end that two edges share, the one whose line is farther off says on which side the centre is.
    order = np.lexsort((-np.abs(line[rows, 2]), np.round(distance[rows], 6), surfel[rows]))
    rows = rows[order]
    sides = _Sides(surfel[rows], side[rows], start[rows], end[rows], line[rows], distance[rows])
    return sides.take(np.flatnonzero(_is_own(sides)))


def _is_own(sides: _Sides) -> np.ndarray:
    """(m,) bool: whether the surfel lies within its nearest border; else it is of a piece of surface that only looks
    like that border's."""
    is_first = np.append(True, sides.surfel[1:] != sides.surfel[:-1])
    owner = np.cumsum(is_first) - 1
    return (sides.line[is_first, 2] >= -0.05)[owner]


def _unlikeness(arrays, surfel: np.ndarray, normals: np.ndarray, borders: Borders, side: np.ndarray) -> np.ndarray:
    """(m,) how much a surfel differs from the face of a side."""
    facing = _dot(normals, borders.normals[side])
    result = 2 - 2 * np.abs(facing)
    result += ((arrays["normals"][surfel] - borders.shading[side]) ** 2).sum(axis=1)
    result += ((arrays["colors"][surfel] - borders.colors[side]) ** 2).sum(axis=1)
    result += 4 * (arrays["materials"][surfel] != borders.materials[side])
    return result


def _most_alike(rows: np.ndarray, surfel: np.ndarray, edge: np.ndarray, unlikeness: np.ndarray) -> np.ndarray:
    """Of `rows` those whose side is most like the surfel among the sides of the same edge."""
    order = rows[np.lexsort((unlikeness[rows], edge[rows], surfel[rows]))]
    is_first = np.ones(len(order), bool)
    is_first[1:] = (surfel[order][1:] != surfel[order][:-1]) | (edge[order][1:] != edge[order][:-1])
    return order[is_first]


def _nearest_on_segment(start: np.ndarray, end: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(m,) share of the way at which a segment of the plane is nearest to (0, 0), and (m,) its distance there."""
    along = end - start
    share = np.clip(-_dot(start, along) / np.maximum(_dot(along, along), 1e-300), 0, 1)
    place = start + along * share[:, None]
    return share, np.hypot(*place.T)


def _needs_more(sides: _Sides, first: np.ndarray) -> np.ndarray:
    """(m,) bool: whether what lies of an edge in the circle is off its surfel's first line."""
    along = sides.end - sides.start
    a, b, c = _dot(along, along), _dot(sides.start, along), _dot(sides.start, sides.start) - 1
    root = np.sqrt(np.maximum(b * b - a * c, 0))
    a = np.maximum(a, 1e-300)
    off = np.zeros(len(along))
    for share in ((-b - root) / a, (-b + root) / a):
        place = sides.start + along * np.clip(share, 0, 1)[:, None]
        np.maximum(off, np.abs(_dot(place, first[:, :2]) + first[:, 2]), out=off)
    return off > _SAME_LINE


def _corners(sides: _Sides, owner: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Two (n, 3) lines for each of n surfels, the sides of which are given, by their `owner`, ascending.

    A place in the circle belongs to the surface if it is inside of the edge that is nearest to it. One line, or two of
    which the nearest is one, as a convex or a reflex corner: taken is what is right about most of the places.
    """
    places, weights = _places()
    starts = np.flatnonzero(np.append(True, owner[1:] != owner[:-1]))
    inside, distance = _inside_of_each(sides, places)
    nearest = np.minimum.reduceat(distance, starts, axis=0)
    is_nearest = distance == nearest[owner]
    belongs = np.logical_and.reduceat(inside | ~is_nearest, starts, axis=0)
    keeps = inside
    first = keeps[starts][owner]
    belongs = belongs[owner]
    shown = first, first & keeps, first | keeps, np.ones_like(first)
    wrongs = np.stack([(kind != belongs).astype(np.float32) @ weights for kind in shown], axis=1)
    # One line where a second gains nothing.
    wrongs[:, 0] -= 1e-4
    flat, group = wrongs.reshape(-1), np.repeat(owner, len(shown))
    order = np.lexsort((flat, group))
    best = order[np.append(True, group[order][1:] != group[order][:-1])]
    row, kind = np.divmod(best, len(shown))
    one, other = sides.line[starts], sides.line[row]
    turn = one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
    # The order says which corner it is.
    swap = np.where(kind == 1, turn < 0, turn > 0) & (kind != 0)
    first, second = (np.where(s[:, None], a, b) for s, a, b in ((swap, other, one), (swap, one, other)))
    first[kind == 3] = second[(kind == 0) | (kind == 3)] = (1.0, 0.0, 1.0)
    return first, second


def _places() -> tuple[np.ndarray, np.ndarray]:
    """(p, 2) places in the unit circle, and (p,) how much of the splat is about each."""
    places, weights = [], []
    for radius, count in _RINGS:
        angle = (np.arange(count) + 0.5) * 2 * np.pi / count
        places.append(np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1))
        weights.append(np.full(count, radius * np.exp(-2 * radius**2) / count))
    weights = np.concatenate(weights)
    return np.concatenate(places), (weights / weights.sum()).astype(np.float32)


def _inside_of_each(sides: _Sides, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(m, p) bool, whether each place is inside of each edge's line, and (m, p) how far the edge is from it.

    At an end that two edges share, both are as far, and the one whose line is farther off is right: it counts as a
    little nearer.
    """
    (x, y), (u, v) = (a.T.astype(np.float32)[..., None] for a in (sides.start, sides.end - sides.start))
    a, b, c = sides.line.T.astype(np.float32)[..., None]
    px, py = places.T.astype(np.float32)
    to_x, to_y = px - x, py - y
    share = to_x * (u / np.maximum(u * u + v * v, np.float32(1e-30)))
    share += to_y * (v / np.maximum(u * u + v * v, np.float32(1e-30)))
    np.clip(share, 0, 1, out=share)
    to_x -= u * share
    to_y -= v * share
    across = a * px + b * py + c
    to_x *= to_x
    to_y *= to_y
    to_x += to_y
    np.sqrt(to_x, out=to_x)
    to_x -= np.float32(1e-4) * np.abs(across)
    return across >= 0, to_x


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("ij,ij->i", a, b)
