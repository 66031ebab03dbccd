# SPDX-License-Identifier: GPL-3.0-or-later
"""Decides which side of the surface each normal is on, consistently within each connected part.

Hoppe et al. 1992, section 3.3, with the flip criterion of Xie et al. 2003 at sharp edges: the choice is propagated
along the minimum spanning tree of the neighbour graph, where an edge is cheap if the two tangent planes agree. The tree
is grown by Boruvka's rounds instead of Prim's queue: in each round every part takes its best edge to another part, all
at once in numpy.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

#: Neighbours that the graph connects; more would cost time and bridge thin gaps.
GRAPH_NEIGHBOURS = 8

#: Edges per batch.
_CHUNK = 1 << 16


def consistent_signs(
    positions: np.ndarray,
    normals: np.ndarray,
    neighbours: np.ndarray,
    report: Callable[[float], None] = lambda share: None,
) -> tuple[np.ndarray, np.ndarray]:
    """(N,) int8 signs, 1 or -1, that make neighbouring normals consistent, and the (N,) connected part of each point.

    positions, normals: (N, 3) float64. neighbours: (N, k) indices. Parts are numbered from 0 without gaps.
    report: called with the share of processed edges.
    """
    ends = _edges(neighbours[:, :GRAPH_NEIGHBOURS])
    agreement = _agreement(positions, normals, ends)
    # 16 bits are enough to tell good edges from bad ones, and allow a radix sort.
    order = np.argsort((65535 * (1 - np.minimum(np.abs(agreement), 1))).astype(np.uint16), kind="stable")
    ends, turned = ends[:, order], (agreement[order] < 0)
    part = np.arange(len(positions))
    flipped = np.zeros(len(positions), bool)
    while ends.shape[1]:
        parent, flip = _merge(part[ends], turned ^ flipped[ends[0]] ^ flipped[ends[1]], len(positions))
        flipped ^= flip[part]
        part = parent[part]
        between = np.flatnonzero(part[ends[0]] != part[ends[1]])
        ends, turned = ends[:, between], turned[between]
        report(1 - ends.shape[1] / len(agreement))
    return np.where(flipped, -1, 1).astype(np.int8), np.unique(part, return_inverse=True)[1]


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


def facing_scanners(positions: np.ndarray, normals: np.ndarray, scanners: np.ndarray) -> np.ndarray:
    """(N,) int8 signs, so that normals face (N, 3) scanners, which saw no back; 1 where a scanner is NaN, or the
    surface is steep to it."""
    towards = scanners - positions
    with np.errstate(invalid="ignore"):
        cosines = np.einsum("ij,ij->i", towards, normals) / np.maximum(np.linalg.norm(towards, axis=1), 1e-300)
        return np.where(cosines < -_STEEP, -1, 1).astype(np.int8)


def _edges(neighbours: np.ndarray) -> np.ndarray:
    """(2, E) int32 pairs of neighbours; a pair found from both ends is kept once."""
    count = len(neighbours)
    own, other = np.arange(count, dtype=np.int64)[:, None], neighbours.astype(np.int64)
    keys = (np.minimum(own, other) * count + np.maximum(own, other)).ravel()
    keys.sort()
    keys = keys[np.diff(keys, prepend=-1) > 0]
    return np.stack(np.divmod(keys, count)).astype(np.int32)


def _agreement(positions: np.ndarray, normals: np.ndarray, ends: np.ndarray) -> np.ndarray:
    """(E,) from 1 for neighbours in one plane with the same normal to -1 for opposite normals; values near 0 are
    uncertain.

    If the normals are within 60 degrees of parallel or antiparallel, this is their cosine, reduced if the edge is steep
    relative to the planes: a steep edge is noise or leads to another sheet. Otherwise the points lie across a sharp
    edge, and it is half the cosine after reflecting the second normal in the plane halfway between them.
    """
    agreement = np.empty(ends.shape[1], np.float32)
    for start in range(0, ends.shape[1], _CHUNK):
        part = slice(start, start + _CHUNK)
        a, b = ends[:, part]
        along, na, nb = positions[b] - positions[a], normals[a], normals[b]
        length, da, db, dot = (np.einsum("ij,ij->i", *p) for p in ((along, along), (na, along), (nb, along), (na, nb)))
        length = np.sqrt(np.where(length > 0, length, 1))
        da, db = da / length, db / length
        in_plane = dot * (1 - np.maximum(np.abs(da), np.abs(db)))
        agreement[part] = np.where(np.abs(dot) >= 0.5, in_plane, (dot - 2 * da * db) / 2)
    return agreement


def _merge(parts: np.ndarray, turned: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Join every part to another along its best edge.

    parts: (2, E) different parts at the ends of each edge, best edge first.
    turned: (E,) whether their normals disagree across it.
    Returns (count,) the root of each part, and (count,) whether it must flip to agree with the root.
    """
    best = np.full(count, parts.shape[1])
    for end in parts:
        first = np.full(count, parts.shape[1])
        # With several assignments to one part the last one stays: the best edge, because they come in reverse order.
        first[end[::-1]] = np.arange(parts.shape[1])[::-1]
        best = np.minimum(best, first)
    joined = np.flatnonzero(best < parts.shape[1])
    edge = best[joined]
    parent, flip = np.arange(count), np.zeros(count, bool)
    parent[joined] = parts[0, edge] + parts[1, edge] - joined
    flip[joined] = turned[edge]
    # Two parts that chose the same edge point at each other; the smaller one becomes the root.
    root = (parent[parent] == np.arange(count)) & (np.arange(count) < parent)
    parent[root], flip[root] = np.flatnonzero(root), False
    while True:
        grandparent = parent[parent]
        if (grandparent == parent).all():
            return parent, flip
        flip ^= flip[parent]
        parent = grandparent
