# SPDX-License-Identifier: GPL-3.0-or-later
"""Cuts convex polygons at planes, many at once, in float64 (Sutherland and Hodgman 1974).

Polygons are (n, m, c) arrays: n polygons of m corners with c numbers each, of which the first three are the place and
the others vary as linearly as the place does. A polygon with fewer corners than m has its last one several times.
"""

from __future__ import annotations

import numpy as np


def kept(polygons: np.ndarray, distances: np.ndarray) -> np.ndarray:
    """The parts of polygons on the positive side of planes. distances: (n, m) of the corners, on that side."""
    if not len(polygons):
        return polygons
    following, beyond = np.roll(polygons, -1, axis=1), np.roll(distances, -1, axis=1)
    is_inside, crosses = distances >= 0, (distances >= 0) != (beyond >= 0)
    # from the inner end, so that neighbours get the same place from whichever side they come
    first, last = (np.where(is_inside[..., None], *ends) for ends in ((polygons, following), (following, polygons)))
    inner, outer = np.where(is_inside, distances, beyond), np.where(is_inside, beyond, distances)
    share = np.divide(inner, inner - outer, out=np.zeros_like(inner), where=crosses)
    places = first + share[..., None] * (last - first)
    count, corners, numbers = polygons.shape
    both = np.stack([polygons, places], axis=2).reshape(count, 2 * corners, numbers)
    is_kept = np.stack([is_inside, crosses], axis=2).reshape(count, 2 * corners)
    return _compact(both, is_kept)


def divided(polygons: np.ndarray, distances: np.ndarray) -> np.ndarray:
    """The parts of polygons on both sides of planes."""
    crosses = (distances.min(axis=1) < 0) & (distances.max(axis=1) > 0)
    cut, across = polygons[crosses], distances[crosses]
    sides = [part for part in (polygons[~crosses], kept(cut, across), kept(cut, -across)) if len(part)]
    if not sides:
        return polygons[:0]
    most = max(part.shape[1] for part in sides)
    return np.concatenate([np.pad(p, ((0, 0), (0, most - p.shape[1]), (0, 0)), mode="edge") for p in sides])


def fans(polygons: np.ndarray) -> np.ndarray:
    """(t, 3, c) triangles of the polygons, without those that have no area."""
    first, second, third = polygons[:, :1], polygons[:, 1:-1], polygons[:, 2:]
    triangles = np.stack([np.broadcast_to(first, second.shape), second, third], axis=2).reshape(
        -1, 3, polygons.shape[2]
    )
    a, b, c = triangles[..., :3].swapaxes(0, 1)
    return triangles[np.cross(b - a, c - a).any(axis=1)]


def _compact(polygons: np.ndarray, is_kept: np.ndarray) -> np.ndarray:
    """Only the kept corners of each, in order; polygons that keep fewer than three are left out."""
    counts = is_kept.sum(axis=1)
    polygons, is_kept, counts = (array[counts >= 3] for array in (polygons, is_kept, counts))
    if not len(counts):
        return polygons[:, :3]
    order = np.argsort(~is_kept, axis=1, kind="stable")[:, : counts.max()]
    order = np.where(
        np.arange(order.shape[1]) < counts[:, None], order, order[np.arange(len(order)), counts - 1][:, None]
    )
    return np.take_along_axis(polygons, order[..., None], axis=1)
