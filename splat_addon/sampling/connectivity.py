# SPDX-License-Identifier: GPL-3.0-or-later
"""Which triangles hang together: vertices at one place become one, and each connected part gets a number."""

from __future__ import annotations

import numpy as np

from .mesh import corner_indices, triangle_chunks


def twins(keys: np.ndarray) -> np.ndarray | None:
    """(V,) intp: for each vertex the first at its place; None where each is alone.

    keys: (V,) of the places, by `vertex_hashes`, so right but by an accident of 2^-64.
    """
    ordered = np.sort(keys)
    shared = np.unique(ordered[1:][ordered[1:] == ordered[:-1]])
    if not len(shared):
        return None
    at = np.flatnonzero(shared.take(np.searchsorted(shared, keys), mode="clip") == keys)
    _, index, place = np.unique(keys[at], return_index=True, return_inverse=True)
    first = np.arange(len(keys))
    first[at] = at[index][place.reshape(-1)]
    return first


def part_labels(corners: np.ndarray) -> np.ndarray:
    """(V,) intp: for each vertex the lowest vertex of its part, where the (t, 3) corners of triangles connect them.

    Every round hooks roots onto lower ones of the same triangle and halves the paths (Shiloach & Vishkin 1982); about
    log t rounds, over fewer and fewer triangles. Of several lower ones any will do, so the last one written stays; what
    that cuts off is joined again in the next round.
    """
    labels = np.arange(int(corners.max(initial=-1)) + 1)
    while len(corners):
        for chunk in triangle_chunks(len(corners)):
            roots = labels.take(corner_indices(corners[chunk]))
            lowest = np.minimum(np.minimum(roots[0], roots[1]), roots[2])
            for root in roots:
                at = np.flatnonzero(root > lowest)
                labels[root.take(at)] = lowest.take(at)
        while True:
            shorter = labels.take(labels)
            if np.array_equal(shorter, labels):
                break
            labels = shorter
        apart = []
        for chunk in triangle_chunks(len(corners)):
            a, b, c = labels.take(corner_indices(corners[chunk]))
            apart.append(np.flatnonzero((a != b) | (a != c)) + chunk.start)
        corners = labels.take(corners.take(np.concatenate(apart), axis=0))
    return labels
