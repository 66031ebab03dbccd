# SPDX-License-Identifier: GPL-3.0-or-later
"""Decides which side of the surface each normal is on, consistently within each connected part.

Hoppe et al. 1992, section 3.3, with the flip criterion of Xie et al. 2003 at sharp edges: the choice is propagated
along a tree in the neighbour graph, where tangent planes agree most. The tree is grown by Boruvka's rounds instead of
Prim's queue: in each round every part joins the one with which its edges together agree most, all at once in numpy.
Most edges leave no doubt; what they join is found first. Bodies also follow what is seen of them from outside.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...runs import order_of, ranges, sorted_with_order
from ...workers import in_portions

#: Neighbours that the graph connects; more would cost time and bridge thin gaps.
GRAPH_NEIGHBOURS = 8

#: Edges with this agreement or more leave no doubt. Those to the nearest neighbours are not looked at for that: they
#: are short and therefore often steep.
_NO_DOUBT, _SHORT = 0.75, 4

#: A part is a body if its points are seen this clearly from one side, on average: bodies from 0.6 to 1, terrain and
#: range maps, which are seen from both sides, below 0.35.
_BODY = 0.5

#: Edges per batch.
_CHUNK = 1 << 15


def consistent_signs(
    positions: np.ndarray,
    normals: np.ndarray,
    neighbours: np.ndarray,
    sides: tuple[np.ndarray, np.ndarray] | None = None,
    report: Callable[[float], None] = lambda share: None,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(N,) int8 signs, 1 or -1, that make neighbouring normals consistent, the (N,) connected part of each point, and
    (N,) bool, for which of them the signs make normals face outside.

    positions, normals: (N, 3) float64. neighbours: (N, k) indices. Parts are numbered from 0 without gaps.
    sides: two (N,) of `outside.seen_sides`, or None. report: called with the share of processed edges.
    """
    graph = neighbours[:, :GRAPH_NEIGHBOURS]
    columns, directions = np.ascontiguousarray(positions.T), np.ascontiguousarray(normals.T, np.float32)
    part, flipped = _without_doubt(columns, directions, graph)
    report(0.6)
    own, column = np.nonzero(part[graph] != part[:, None])
    ends = np.stack([own.astype(graph.dtype), graph[own, column]])
    agreement = _agreement(columns, directions, *ends)
    votes = np.where(flipped[ends[0]] ^ flipped[ends[1]], -agreement, agreement)
    outside = int(part.max(initial=-1)) + 1
    ends, votes = _counted(part[ends], votes, outside)
    label, flips = _joined(ends, votes, outside)
    faces_outside = np.zeros(len(part), bool)
    if sides is not None:
        more, both = sides
        of_parts = (np.bincount(label[part], amount) for amount in (np.abs(more), both))
        faces_outside = np.greater(next(of_parts), _BODY * next(of_parts))[label[part]]
        # the outside is one more part: what is seen of a body from there votes for its parts
        clear = more * np.abs(more) / np.maximum(both * both, np.float32(1e-12))
        seen = np.bincount(part, np.where(faces_outside, np.where(flipped, -clear, clear), 0), outside)
        bodies = np.flatnonzero(seen)
        ends = np.concatenate([ends, [bodies, np.full(len(bodies), outside)]], axis=1)
        _, flips = _joined(ends, np.concatenate([votes, np.float32(seen[bodies])]), outside + 1)
        flips ^= flips[outside]
    report(1.0)
    return np.where(flipped ^ flips[part], -1, 1).astype(np.int8), label[part], faces_outside


def _without_doubt(columns: np.ndarray, directions: np.ndarray, graph: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(N,) the part of each point, of what edges without doubt join, and (N,) bool, whether it must flip to agree with
    the others in it. columns: (3, N) places. directions: (3, N) float32 normals. graph: (N, k) neighbours."""
    count, far = len(graph), graph[:, _SHORT:] if graph.shape[1] > _SHORT else graph
    agreement = np.empty(far.shape[::-1], np.float32)
    for row, other in zip(agreement, far.T, strict=True):
        row[:] = _agreement(columns, directions, np.arange(count), other)
    is_good, others = np.abs(agreement) >= _NO_DOUBT, np.ascontiguousarray(far.T)
    # Each point follows its good neighbour with the least number, if that is below its own.
    own = np.arange(count, dtype=others.dtype)
    parent, flip = own.copy(), np.zeros(count, bool)
    for other, good, row in zip(others, is_good, agreement, strict=True):
        follows = good & (other < parent)
        parent[follows], flip[follows] = other[follows], row[follows] < 0
    part, flipped = _roots(parent, flip)
    line, at = np.nonzero(is_good & (part[others] != part))
    ends = np.stack([part[at], part[others[line, at]]])
    turned = (agreement[line, at] < 0) ^ flipped[at] ^ flipped[others[line, at]]
    label, flips = _joined(ends, np.where(turned, np.float32(-1), 1), int(part.max(initial=-1)) + 1)
    return label[part], flipped ^ flips[part]


def _joined(ends: np.ndarray, votes: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """(count,) the number of the part that each node belongs to, and whether it must flip to agree with others in it.

    ends: (2, E) different nodes. votes: (E,) float32, above 0 where their normals agree, and how surely. All edges
    between two parts vote together, so that none of them decides alone.
    """
    label, flipped = np.arange(count), np.zeros(count, bool)
    while ends.shape[1]:
        ends, votes = _counted(ends, votes, count)
        number, flip = _merge(ends, votes, count)
        flipped ^= flip[label]
        label = number[label]
        votes = np.where(flip[ends[0]] ^ flip[ends[1]], -votes, votes)
        ends, count = number[ends], int(number.max()) + 1
        between = np.flatnonzero(ends[0] != ends[1])
        ends, votes = ends[:, between], votes[between]
    return label, flipped


def _counted(ends: np.ndarray, votes: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """(2, P) the different pairs among (2, E) ends, ascending, and (P,) the sum of each one's votes."""
    keys = np.minimum(*ends).astype(np.int64) * count + np.maximum(*ends)
    order, keys = sorted_with_order(keys, count * count)
    first = np.flatnonzero(np.diff(keys, prepend=-1))
    return np.stack(np.divmod(keys[first], count)), np.add.reduceat(votes[order], first)


def facing_outward(positions: np.ndarray, normals: np.ndarray, part: np.ndarray) -> np.ndarray:
    """(N,) int8 signs, constant per part, so that the part's normals on the whole point away from its middle, or up.

    The mean of (p - middle) . n over the mean length of p - middle is 1 for a sphere and near 0 for a sheet, such as
    terrain, of which valleys would decide; the mean of n is 0 for closed surfaces. The stronger one decides: sheets
    that do not stand upright face up. A wall gives neither, and its mean normal is made to point along y or x.
    """
    sizes = np.bincount(part)
    middles = np.stack([np.bincount(part, column) / sizes for column in positions.T], axis=1)
    away = positions - middles[part]
    scale = np.bincount(part, np.linalg.norm(away, axis=1))
    outward = np.bincount(part, np.einsum("ij,ij->i", away, normals)) / np.where(scale > 0, scale, 1)
    up = np.bincount(part, normals @ (1e-2, 1e-1, 1.0)) / sizes
    votes = np.where((np.abs(outward) > 1e-6) & (np.abs(outward) > np.abs(up)), outward, up)
    return np.where(votes[part] < 0, -1, 1).astype(np.int8)


def facing_viewpoint(positions: np.ndarray, normals: np.ndarray, part: np.ndarray, viewpoint) -> np.ndarray:
    """(N,) int8 signs, constant per part, so that most of its normals face `viewpoint`, (3,) in the points' units."""
    towards = np.asarray(viewpoint, np.float64) - positions
    length = np.linalg.norm(towards, axis=1)
    cosines = np.einsum("ij,ij->i", towards, normals) / np.where(length > 0, length, 1)
    return np.where(np.bincount(part, cosines)[part] < 0, -1, 1).astype(np.int8)


#: Cosine below which a surface is so steep to its scanner that noise decides which side is seen.
_STEEP = 0.1

#: How often steep points are asked again, once all their neighbours have a side.
_REFINED = 3


def facing_scanners(positions: np.ndarray, normals: np.ndarray, scanners: np.ndarray) -> np.ndarray:
    """(N,) int8 signs, so that normals face (N, 3) scanners, which saw no back; 1 where a scanner is NaN, or the
    surface is steep to it."""
    with np.errstate(invalid="ignore"):
        return np.where(_cosines_to(scanners, positions, normals) < -_STEEP, -1, 1).astype(np.int8)


def scanned_sides(
    positions: np.ndarray, normals: np.ndarray, neighbours: np.ndarray, scanners: np.ndarray
) -> np.ndarray:
    """(N,) int8 signs, so that normals face (N, 3) finite scanners; those of surfaces that are steep to them agree with
    their neighbours', which takes a fraction of the time of `consistent_signs`.

    positions, normals: (N, 3) float64. neighbours: (N, k) indices.
    """
    columns, directions = np.ascontiguousarray(positions.T), np.ascontiguousarray(normals.T, np.float32)
    cosines = _cosines_to(scanners, positions, normals)
    facing, steep = np.where(cosines < 0, -1, 1).astype(np.float32), np.flatnonzero(np.abs(cosines) < _STEEP)
    near = neighbours[steep, :GRAPH_NEIGHBOURS]
    agreement = _agreement(columns, directions, np.repeat(steep, near.shape[1]), near.ravel()).reshape(near.shape)
    signs = facing.copy()
    signs[steep] = 0
    # only those are asked again of which a neighbour was told its side in the round before
    counts = np.bincount(near.ravel(), minlength=len(signs))
    followers, firsts = order_of(near.ravel()) // max(near.shape[1], 1), np.cumsum(counts) - counts
    asked = np.arange(len(steep))
    while len(asked):
        found = np.sign((agreement[asked] * signs[near[asked]]).sum(axis=1))
        told = steep[asked[found != 0]]
        signs[told] = found[found != 0]
        asked = np.unique(followers[ranges(firsts[told], counts[told])])
        asked = asked[signs[steep[asked]] == 0]
    # what no point that is not steep leads to follows its own scanner
    left = steep[signs[steep] == 0]
    signs[left] = facing[left]
    for _ in range(_REFINED):
        votes = (agreement * signs[near]).sum(axis=1)
        signs[steep] = np.where(votes < 0, -1, np.where(votes > 0, 1, signs[steep]))
    return signs.astype(np.int8)


def _cosines_to(scanners: np.ndarray, positions: np.ndarray, normals: np.ndarray) -> np.ndarray:
    towards = scanners - positions
    return np.einsum("ij,ij->i", towards, normals) / np.maximum(np.linalg.norm(towards, axis=1), 1e-300)


def _agreement(columns: np.ndarray, directions: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(E,) float32 from 1 for neighbours a, b in one plane with the same normal to -1 for opposite normals; values near
    0 are uncertain. columns: (3, N) places. directions: (3, N) float32 normals.

    If the normals are within 60 degrees of parallel or antiparallel, this is their cosine, reduced if the edge is steep
    relative to the planes: a steep edge is noise or leads to another sheet. Otherwise the points lie across a sharp
    edge, and it is half the cosine after reflecting the second normal in the plane halfway between them.
    """
    agreement = np.empty(len(a), np.float32)

    def job(part: slice):
        at, to = a[part], b[part]
        na, nb = directions.take(at, axis=1), directions.take(to, axis=1)
        along = columns.take(to, axis=1) - columns.take(at, axis=1)
        length = np.sqrt(np.einsum("in,in->n", along, along))
        along = np.divide(along, np.where(length > 0, length, 1), dtype=np.float32, casting="same_kind")
        da, db, dot = (np.einsum("in,in->n", *pair) for pair in ((na, along), (nb, along), (na, nb)))
        in_plane = dot * (1 - np.maximum(np.abs(da), np.abs(db)))
        agreement[part] = np.where(np.abs(dot) >= 0.5, in_plane, (dot - 2 * da * db) / 2)

    in_portions(len(a), _CHUNK, job)
    return agreement


def _merge(parts: np.ndarray, votes: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Join every part to another along its best edge.

    parts: (2, E) different parts at the ends of each edge. votes: (E,) below 0 where their normals disagree across it;
    the best edge has the clearest vote, and of several such the first place.
    Returns (count,) the new number of each part, and (count,) whether it must flip to agree with the others in it.
    """
    clearness, clearest = np.nan_to_num(np.abs(votes)), np.full(count, np.float32(-1))
    for end in parts:
        np.maximum.at(clearest, end, clearness)
    best = np.full(count, parts.shape[1])
    for end in parts:
        edge = np.flatnonzero(clearness == clearest[end])[::-1]
        first = np.full(count, parts.shape[1])
        # With several assignments to one part the last one stays.
        first[end[edge]] = edge
        best = np.minimum(best, first)
    joined = np.flatnonzero(best < parts.shape[1])
    edge = best[joined]
    parent, flip = np.arange(count), np.zeros(count, bool)
    parent[joined] = parts[0, edge] + parts[1, edge] - joined
    flip[joined] = votes[edge] < 0
    # Two parts that chose the same edge point at each other; the smaller one becomes the root.
    root = (parent[parent] == np.arange(count)) & (np.arange(count) < parent)
    parent[root], flip[root] = np.flatnonzero(root), False
    return _roots(parent, flip)


def _roots(parent: np.ndarray, flip: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(count,) the number of the tree that each node belongs to, without gaps, and whether it must flip to agree with
    the root. parent: (count,) of each node, itself for roots. flip: (count,) whether it must to agree with the parent,
    False for roots."""
    number = np.cumsum(parent == np.arange(len(parent))) - 1
    while True:
        grandparent = parent[parent]
        if (grandparent == parent).all():
            return number[parent], flip
        flip = flip ^ flip[parent]
        parent = grandparent
