# SPDX-License-Identifier: GPL-3.0-or-later
"""Cuts surfels at the borders of their surface: each gets the clip lines (`clip_lines`) that its mesh requires.

Flow: `borders` -> which surfels meet which edges, as the ellipse sees them (`meetings`) -> one line, or the two that
keep what lies within the border best.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...clip_lines import CLIP_FIELDS, are_reflex, pack_lines
from ..ldc.grid import Grid
from .borders import Borders
from .meetings import BEYOND, Images, Meetings, meetings
from .ragged_borders import two_lines

#: A border that deviates from a line by less than this, in half-axes, is on the line.
_SAME_LINE = 0.06

#: An edge that the centre lies a little beyond counts as farther by this, in half-axes: at an open seam with another
#: sheet, the edge of the surfel's own sheet comes first.
_BEYOND_IS_FARTHER = np.float32(0.1)

#: What two lines keep: the first one's side, that of both, that of either, or all.
_FIRST, _BOTH, _EITHER, _ALL = range(4)

#: If a splat meets more edges than this, the farther ones are ignored when looking for its corner.
_MOST_EDGES = 6

#: The line that keeps the whole ellipse.
_NO_LINE = np.array([[1], [0], [1]], np.float32)

#: Bits of what meetings of a surfel are ordered by: how near the edge is, and how far its line.
_DISTANCE_BITS, _LINE_BITS = 18, 8


@dataclass(frozen=True, eq=False)
class Clipping:
    """fields: `CLIP_FIELDS` of the surfels, those that are needed. met: which surfels meet which sides of borders, the
    nearest first. lines: (2, 3, m) at which that surfel ends, of unit direction, and reflex: (m,) bool (`clip_lines`).
    """

    fields: dict[str, np.ndarray]
    met: Meetings
    lines: np.ndarray
    reflex: np.ndarray


def clip(
    arrays: dict[str, np.ndarray], images: Images, borders: Borders, grid: Grid, at_centres: bool = True
) -> Clipping:
    """Find the clip lines of surfels.

    arrays: by field of `Surfels`, positions relative to the grid's middle. images: which of them each image sees.
    at_centres: whether they lie at the centres of cells.
    """
    met = meetings(arrays, images, borders, grid, at_centres)
    if not len(met):
        return Clipping({}, met, np.zeros((2, 3, 0), np.float32), np.zeros(0, bool))
    met = met.take(_one_side_of_each(met, arrays, borders))
    met, starts, owner = _of_own_surface(met.take(_nearest_first(met)))
    lines = _lines(met, starts, owner)
    packed = [pack_lines(line.T) for line in lines]
    fields, count = {}, len(arrays["positions"])
    for name, values in zip(CLIP_FIELDS, packed, strict=True):
        if values[:, 1].any():
            values[values[:, 1] == 0] = 0
            fields[name] = np.zeros((count, 2), np.int16)
            fields[name][met.surfel.take(starts)] = values
    reflex = are_reflex(*packed)
    return Clipping(fields, met, lines.take(owner, axis=2), reflex.take(owner))


def _one_side_of_each(met: Meetings, arrays: dict[str, np.ndarray], borders: Borders) -> np.ndarray:
    """The meetings without those for which another side of the same edge matches the surfel better."""
    keys = met.surfel * (borders.edges.max() + 1) + borders.edges.take(met.side)
    order = np.argsort(keys)
    keys = keys.take(order)
    is_shared = np.zeros(len(keys), bool)
    np.equal(keys[1:], keys[:-1], out=is_shared[1:])
    is_shared[:-1] |= is_shared[1:]
    if not is_shared.any():
        return np.arange(len(keys))
    alone, shared = order.compress(~is_shared), order.compress(is_shared)
    group, unlike = keys.compress(is_shared), _unlikeness(met.take(shared), arrays, borders)
    ranked = np.lexsort((unlike, group))
    is_first = np.append(True, group[ranked][1:] != group[ranked][:-1])
    return np.concatenate([alone, shared[ranked[is_first]]])


def _unlikeness(met: Meetings, arrays: dict[str, np.ndarray], borders: Borders) -> np.ndarray:
    """(m,) difference between a surfel and the face of a side."""
    surfel, side = met.surfel, met.side
    result = 2 - 2 * met.facing + 0.01 * (met.line[2] < 0)
    for values, of_side in ((arrays["normals"], borders.shading), (arrays["colors"], borders.colors)):
        difference = values.take(surfel, axis=0) - of_side.take(side, axis=0)
        for column in difference.T:
            result += column * column
    result += 4 * (arrays["materials"].take(surfel) != borders.materials.take(side))
    return result


def _nearest_first(met: Meetings) -> np.ndarray:
    """The order of surfels, and of each one's meetings by how near the edge is.

    At an end that two edges share, the one whose line is farther off says on which side the centre is.
    """
    is_beyond = (met.line[2] < 0) & (met.line[2] >= BEYOND)
    distance = np.where(is_beyond, met.distance + _BEYOND_IS_FARTHER, met.distance)
    near = np.minimum(distance * (1 << _DISTANCE_BITS), (1 << _DISTANCE_BITS) - 1).astype(np.int64)
    line = np.minimum(np.abs(met.line[2]), 1) * ((1 << _LINE_BITS) - 1)
    near <<= _LINE_BITS
    near |= ((1 << _LINE_BITS) - 1) - line.astype(np.int64)
    bits = len(met).bit_length()
    if int(met.surfel.max()).bit_length() + _DISTANCE_BITS + _LINE_BITS + bits > 63:
        return np.lexsort((near, met.surfel))
    # Sorted together with their numbers in the lowest bits, because an argsort takes several times as long.
    keys = met.surfel << (_DISTANCE_BITS + _LINE_BITS)
    keys |= near
    keys <<= bits
    keys |= np.arange(len(met))
    keys.sort()
    return keys & ((1 << bits) - 1)


def _of_own_surface(met: Meetings) -> tuple[Meetings, np.ndarray, np.ndarray]:
    """The meetings of surfels that lie within their nearest border; else it is of a piece of surface that only looks
    like that border's. Also the first meeting of each surfel, and the (m,) number of each one's surfel among these."""
    is_first = np.append(True, met.surfel[1:] != met.surfel[:-1])
    starts = np.flatnonzero(is_first)
    owner = np.cumsum(is_first) - 1
    is_own = met.line[2].take(starts) >= BEYOND
    if is_own.all():
        return met, starts, owner
    met = met.take(np.flatnonzero(is_own.take(owner)))
    is_first = np.append(True, met.surfel[1:] != met.surfel[:-1])[: len(met)]
    return met, np.flatnonzero(is_first), np.cumsum(is_first) - 1


def _lines(met: Meetings, starts: np.ndarray, owner: np.ndarray) -> np.ndarray:
    """(2, 3, n) lines of n surfels, in the order that says which corner they make; (1, 0, 1) for none.

    The nearest border is the first. Where one other leaves it, that is the second: into what the first keeps, as it
    does at a convex corner, or out of it, as at a reflex one. Of several the best is looked for.
    """
    first = met.line.take(starts, axis=1)
    second = np.repeat(_NO_LINE, len(starts), axis=1)
    off, place = _off_line(met, first.take(owner, axis=1))
    others = np.flatnonzero(off > _SAME_LINE)
    counts = np.bincount(owner.take(others), minlength=len(starts))
    single = others.compress(counts.take(owner.take(others)) == 1)
    kind = np.where(place.take(single) < 0, _EITHER, _BOTH)
    rank = np.arange(len(met)) - starts.take(owner)
    several = np.flatnonzero((counts > 1).take(owner) & (rank < _MOST_EDGES))
    if len(several):
        few = met.take(several)
        best, kinds = two_lines(few.start, few.end, few.line, (np.cumsum(counts > 1) - 1).take(owner.take(several)))
        single, kind = np.append(single, several.take(best)), np.append(kind, kinds)
    owners = owner.take(single)
    one, other = first.take(owners, axis=1), met.line.take(single, axis=1)
    turn = one[0] * other[1] - one[1] * other[0]
    swap = np.where(kind == _BOTH, turn < 0, turn > 0)
    for line, there in ((first, np.where(swap, other, one)), (second, np.where(swap, one, other))):
        there[:, kind == _ALL] = _NO_LINE
        line[:, owners] = there
    alone = owners.compress(kind == _FIRST)
    first[:, alone], second[:, alone] = one.compress(kind == _FIRST, axis=1), _NO_LINE
    return np.stack([first, second])


def _off_line(met: Meetings, line: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(m,) how far what lies of an edge in the circle is off a line at most, and (m,) on which side of it, signed."""
    (x, y), (u, v) = met.start, met.end - met.start
    a, b, c = u * u + v * v, x * u + y * v, x * x + y * y - 1
    root = np.sqrt(np.maximum(b * b - a * c, 0))
    a = np.maximum(a, np.float32(1e-30))
    off = np.zeros(len(met), np.float32)
    for share in ((-b - root) / a, (-b + root) / a):
        np.clip(share, 0, 1, out=share)
        value = line[0] * (x + u * share) + line[1] * (y + v * share) + line[2]
        np.copyto(off, value, where=np.abs(value) > np.abs(off))
    return np.abs(off), off
