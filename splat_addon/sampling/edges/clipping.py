# SPDX-License-Identifier: GPL-3.0-or-later
"""Cuts surfels at the borders of their surface: each gets the clip lines (`clip_lines`) that its mesh requires.

Flow: `borders` -> which surfels meet which edges, as the ellipse sees them (`meetings`) -> one line, or the two that
keep what lies within the border best. Where they keep more than that, the surfel becomes smaller (`overhang`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from ...clip_lines import CLIP_FIELDS, are_reflex, pack_lines
from ...runs import order_of
from ...workers import in_order
from ..ldc.grid import Grid
from ..table import SampleTable
from .borders import Borders
from .meetings import BEYOND, Images, Meetings, meetings
from .overhang import TIMES, made_smaller
from .ragged_borders import ALL, BOTH, EITHER, FIRST, two_lines

#: A border that deviates from a line by less than this, in half-axes, is on the line.
_SAME_LINE = 0.06

#: An edge that the centre lies a little beyond counts as farther by this, in half-axes: at an open seam with another
#: sheet, the edge of the surfel's own sheet comes first.
_BEYOND_IS_FARTHER = np.float32(0.1)

#: If a splat meets more edges than this, the farther ones are ignored when looking for its corner.
_MOST_EDGES = 6

#: A face that is like another one by this much more, as a cosine, belongs to that one.
_MORE_ALIKE = 0.01

#: The line that keeps the whole ellipse.
_NO_LINE = np.array([[1], [0], [1]], np.float32)

#: Bits of what meetings of a surfel are ordered by: how near the edge is, and how far its line.
_DISTANCE_BITS, _LINE_BITS = 18, 8


@dataclass(frozen=True, eq=False)
class Clipping:
    """surfels: (n,) that lines were found for. packed: (2, n, 2) int16, their `CLIP_FIELDS`. met: which of them meet
    which sides of borders, the nearest first. lines: (2, 3, m) at which that surfel ends, of unit direction, and
    reflex: (m,) bool (`clip_lines`).
    """

    surfels: np.ndarray
    packed: np.ndarray
    met: Meetings
    lines: np.ndarray
    reflex: np.ndarray


def clippings(
    arrays: SampleTable,
    images: Images,
    borders: Borders,
    grid: Grid,
    at_centres: bool = True,
    times: int = TIMES,
) -> Iterator[Clipping]:
    """Find the clip lines of surfels, of a few at a time.

    arrays: by field of `Surfels`, positions relative to the grid's middle. images: which of them each sees.
    at_centres: whether they lie at the centres of cells. times: how often they may become smaller (`overhang`), in
    place in `arrays`.
    """
    clip = partial(_clippings, arrays=arrays, borders=borders, across=_across(borders), times=times)
    jobs = (partial(clip, meet) for meet in meetings(arrays, images, borders, grid, at_centres))
    return (part for parts in in_order(jobs) for part in parts)


def _clippings(
    meet: Callable[[], Meetings], arrays: SampleTable, borders: Borders, across: np.ndarray, times: int
) -> list[Clipping]:
    """Run a job of `meetings` and find the lines of its surfels. across: (B,), from `_across`."""
    met = meet()
    if not len(met):
        return []
    rows = _nearest_first(met, _one_side_of_each(met, arrays, borders))
    rows, starts, owner = _of_own_surface(met, rows)
    met = met.take(rows)
    ends = _ends_in_circle(met)
    is_own = _on_this_side(met, ends, starts, owner, borders, across) & ~_out_of_sight(met, ends, starts, owner)
    if not is_own.all():
        met = met.take(np.flatnonzero(is_own))
    return _ended(met, arrays["scales"], times)


def _ended(met: Meetings, scales: np.ndarray, times: int) -> list[Clipping]:
    """The lines at which surfels end. Those that stick out become smaller in place, up to `times` times."""
    if not len(met):
        return []
    ends, (_, starts, owner) = _ends_in_circle(met), _groups(met.surfel)
    lines, sticks_out = _lines(met, ends, starts, owner)
    smaller = []
    if times and sticks_out.any():
        changes = sticks_out.take(owner)
        smaller = _ended(made_smaller(met.take(np.flatnonzero(changes)), scales), scales, times - 1)
        met, stays = met.take(np.flatnonzero(~changes)), np.flatnonzero(~sticks_out)
        # The others' lines do not depend on them.
        lines, (_, starts, owner) = lines.take(stays, axis=2), _groups(met.surfel)
    return [_packed(met, lines, starts, owner), *smaller] if len(met) else smaller


def _packed(met: Meetings, lines: np.ndarray, starts: np.ndarray, owner: np.ndarray) -> Clipping:
    """lines: (2, 3, n) of the n surfels. starts, owner: from `_groups` of the meetings' surfels."""
    packed = np.stack([pack_lines(line.T) for line in lines])
    packed[packed[..., 1] == 0] = 0
    reflex = are_reflex(*packed)
    return Clipping(met.surfel.take(starts), packed, met, lines.take(owner, axis=2), reflex.take(owner))


def clip_fields(parts: Iterable[Clipping], count: int) -> SampleTable:
    """The fields among `CLIP_FIELDS` that any of `count` surfels needs."""
    fields = {name: np.zeros((count, 2), np.int16) for name in CLIP_FIELDS}
    for part in parts:
        for values, found in zip(fields.values(), part.packed, strict=True):
            values[part.surfels] = found
    return {name: values for name, values in fields.items() if values[:, 1].any()}


def _one_side_of_each(met: Meetings, arrays: SampleTable, borders: Borders) -> np.ndarray:
    """The meetings, without those for which another side of the same edge fits the surfel better."""
    keys = met.surfel * (int(borders.edges.max()) + 1) + borders.edges.take(met.side)
    order = order_of(keys)
    keys = keys.take(order)
    is_shared = np.zeros(len(keys), bool)
    np.equal(keys[1:], keys[:-1], out=is_shared[1:])
    is_shared[:-1] |= is_shared[1:]
    if not is_shared.any():
        return order
    alone, shared = order.compress(~is_shared), order.compress(is_shared)
    _, starts, group = _groups(keys.compress(is_shared))
    unlike = _unlikeness(met, shared, arrays, borders)
    # The first of those that are least unlike.
    likest = np.flatnonzero(unlike == np.minimum.reduceat(unlike, starts).take(group))
    return np.concatenate([alone, shared.take(likest.compress(_groups(group.take(likest))[0]))])


def _unlikeness(met: Meetings, rows: np.ndarray, arrays: SampleTable, borders: Borders) -> np.ndarray:
    """(r,) difference between the surfel and the face of the side, for these r rows of the meetings."""
    surfel, side = met.surfel.take(rows), met.side.take(rows)
    result = 2 - 2 * met.facing.take(rows) + 0.01 * (met.line[2].take(rows) < 0)
    for values, of_side in ((arrays["normals"], borders.shading), (arrays["colors"], borders.colors)):
        difference = values.take(surfel, axis=0) - of_side.take(side, axis=0)
        for column in difference.T:
            result += column * column
    result += 4 * (arrays["materials"].take(surfel) != borders.materials.take(side))
    return result


def _nearest_first(met: Meetings, rows: np.ndarray) -> np.ndarray:
    """The (m,) rows of meetings, ordered by surfel, and for each surfel by how near the edge is.

    At an end that two edges share, the one whose line is farther off decides on which side the centre is, and comes
    first.
    """
    surfel, off, distance = met.surfel.take(rows), met.line[2].take(rows), met.distance.take(rows)
    distance += ((off < 0) & (off >= BEYOND)) * _BEYOND_IS_FARTHER
    near = np.minimum(distance * (1 << _DISTANCE_BITS), (1 << _DISTANCE_BITS) - 1).astype(np.int64)
    line = np.minimum(np.abs(off), 1) * ((1 << _LINE_BITS) - 1)
    near <<= _LINE_BITS
    near |= ((1 << _LINE_BITS) - 1) - line.astype(np.int64)
    near |= surfel << (_DISTANCE_BITS + _LINE_BITS)
    return rows.take(order_of(near))


def _of_own_surface(met: Meetings, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The meetings, by row, of surfels that lie within their nearest border; a surfel beyond it is of another piece of
    surface that only looks like that border's. Also the first meeting of each surfel, and the (m,) number of each one's
    surfel among these."""
    _, starts, owner = _groups(met.surfel.take(rows))
    is_own = met.line[2].take(rows.take(starts)) >= BEYOND
    if is_own.all():
        return rows, starts, owner
    rows = rows.compress(is_own.take(owner))
    return rows, *_groups(met.surfel.take(rows))[1:]


def _on_this_side(
    met: Meetings, ends: np.ndarray, starts: np.ndarray, owner: np.ndarray, borders: Borders, across: np.ndarray
) -> np.ndarray:
    """(m,) bool: False for edges that lie past the surfel's nearest crease and belong to the face there.

    The face of such an edge is more like the one past the crease than like the one before it. Between two parallel
    creases there is a narrow face, over which the surfel would otherwise reach. across: (B,), from `_across`.
    """
    number = np.arange(len(met))
    crease = np.minimum.reduceat(np.where(across.take(met.side) >= 0, number, len(met)), starts)
    has_crease = crease < len(met)
    others = np.flatnonzero(has_crease.take(owner) & (number != starts.take(owner)))
    crease = crease.take(owner.take(others))
    first, normals = met.side.take(crease), borders.normals.take(met.side.take(others), axis=0)
    before, past = (borders.normals.take(of, axis=0) for of in (first, across.take(first)))
    like_before, like_past = (np.abs(np.einsum("ij,ij->i", normals, of)) for of in (before, past))
    alike = np.flatnonzero(like_past > like_before + _MORE_ALIKE)
    others, line = others.take(alike), met.line.take(crease.take(alike), axis=1)
    result = np.ones(len(met), bool)
    result[others] = _off_line(ends.take(others, axis=2), line)[1] >= 0
    return result


def _out_of_sight(met: Meetings, ends: np.ndarray, starts: np.ndarray, owner: np.ndarray) -> np.ndarray:
    """(m,) bool: True for edges that the surfel's nearest one hides from its centre.

    Its surface ends before them: they are of another sheet, or of the other side of a narrow face.
    """
    start, line = met.start.take(starts, axis=1), met.line.take(starts, axis=1)
    way = met.end.take(starts, axis=1) - start
    way /= np.maximum((way * way).sum(axis=0), np.float32(1e-30))
    along_start = (start * way).sum(axis=0).take(owner)
    way, line = way.take(owner, axis=1), line.take(owner, axis=1)
    hidden = np.ones(len(met), bool)
    for x, y in ends:
        toward = line[0] * x + line[1] * y
        # The way from the centre to this end crosses the nearest edge's line at this share of it.
        share = np.maximum(line[2], 0) / np.maximum(-toward, np.float32(1e-12))
        along = (x * way[0] + y * way[1]) * share - along_start
        hidden &= (toward + line[2] < -_SAME_LINE) & (along >= 0) & (along <= 1)
    return hidden


def _ends_in_circle(met: Meetings) -> np.ndarray:
    """(2, 2, m) float32: both ends of the part of each edge that lies in the circle."""
    (x, y), (u, v) = met.start, met.end - met.start
    a, b, c = u * u + v * v, x * u + y * v, x * x + y * y - 1
    root = np.sqrt(np.maximum(b * b - a * c, 0))
    a = np.maximum(a, np.float32(1e-30))
    shares = (np.clip((way - b) / a, 0, 1) for way in (-root, root))
    return np.stack([np.stack([x + u * share, y + v * share]) for share in shares])


def _across(borders: Borders) -> np.ndarray:
    """(B,) the side of the other face of each edge; -1 where there is none or more than one."""
    _, starts, group = _groups(borders.edges)
    counts = np.diff(np.append(starts, len(borders)))
    number = np.arange(len(borders))
    return np.where(counts.take(group) == 2, 2 * starts.take(group) + 1 - number, -1)


def _groups(ordered: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Runs of equal values: (n,) bool, whether a run starts there; the runs' starts; and (n,) the number of the run."""
    is_first = np.ones(len(ordered), bool)
    np.not_equal(ordered[1:], ordered[:-1], out=is_first[1:])
    return is_first, np.flatnonzero(is_first), np.cumsum(is_first) - 1


def _lines(met: Meetings, ends: np.ndarray, starts: np.ndarray, owner: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(2, 3, n) lines of n surfels, in the order that says which corner they make; (1, 0, 1) for none. And (n,) bool,
    whether they keep some of what lies beyond the border.

    The nearest border is the first. Where one other leaves it, that is the second: into what the first keeps, as it
    does at a convex corner, or out of it, as at a reflex one. Of several the best is looked for.
    """
    first = met.line.take(starts, axis=1)
    second = np.repeat(_NO_LINE, len(starts), axis=1)
    nearest = first.take(owner, axis=1)
    off, place = _off_line(ends, nearest)
    # Two edges that face each other on one line bound a narrow face if the centre is between them. At a seam of two
    # sheets it is not.
    is_opposite = (off <= _SAME_LINE) & (nearest[0] * met.line[0] + nearest[1] * met.line[1] < 0) & (met.line[2] > 0)
    others = np.flatnonzero((off > _SAME_LINE) | is_opposite)
    counts = np.bincount(owner.take(others), minlength=len(starts))
    single = others.compress(counts.take(owner.take(others)) == 1)
    kind = np.where((place < 0).take(single) & ~is_opposite.take(single), EITHER, BOTH)
    rank = np.arange(len(met)) - starts.take(owner)
    sticks_out = np.zeros(len(starts), bool)
    several = np.flatnonzero((counts > 1).take(owner) & (rank < _MOST_EDGES))
    if len(several):
        few = met.take(several)
        number = (np.cumsum(counts > 1) - 1).take(owner.take(several))
        best, kinds, sticks_out[counts > 1] = two_lines(few.start, few.end, few.line, number)
        single, kind = np.append(single, several.take(best)), np.append(kind, kinds)
    owners = owner.take(single)
    one, other = first.take(owners, axis=1), met.line.take(single, axis=1)
    turn = one[0] * other[1] - one[1] * other[0]
    swap = np.where(kind == BOTH, turn < 0, turn > 0)
    for line, there in ((first, np.where(swap, other, one)), (second, np.where(swap, one, other))):
        there[:, kind == ALL] = _NO_LINE
        line[:, owners] = there
    alone = owners.compress(kind == FIRST)
    first[:, alone], second[:, alone] = one.compress(kind == FIRST, axis=1), _NO_LINE
    return np.stack([first, second]), sticks_out


def _off_line(ends: np.ndarray, line: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(m,) largest distance of the part of an edge in the circle from a line, and (m,) the same with the sign
    of its side. ends: (2, 2, m), of that part.
    """
    off = np.zeros(line.shape[1], np.float32)
    for x, y in ends:
        value = line[0] * x + line[1] * y + line[2]
        np.copyto(off, value, where=np.abs(value) > np.abs(off))
    return np.abs(off), off
