# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds which triangles are connected: vertices at the same position become one, and each connected part gets a
number."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from .triangle_mesh import TriangleMesh, corner_indices, triangle_chunks

#: Bits of a hash used for a first, quick test of which entries may match.
_SIEVE_BITS = 16


class Connectivity:
    """What is connected in a mesh, each computed when it is first asked for."""

    def __init__(self, mesh: TriangleMesh):
        self._places, self._triangles = mesh.places, mesh.triangles

    @cached_property
    def twins(self) -> np.ndarray | None:
        """(V,) intp, from `twins`."""
        return twins(self._places)

    @cached_property
    def parts(self) -> np.ndarray:
        """(T,) intp: the part of each triangle, as its lowest vertex."""
        return part_labels(self._triangles, self.twins).take(self._triangles[:, 0])


def connectivity(mesh: TriangleMesh) -> Connectivity:
    """The connectivity of a mesh without non-finite vertices, the same object each time."""
    if mesh.connected is None:
        object.__setattr__(mesh, "connected", Connectivity(mesh))
    return mesh.connected


def twins(keys: np.ndarray) -> np.ndarray | None:
    """(V,) intp: for each vertex the first vertex at its position; None if no position is shared.

    keys: (V,) from `vertex_hashes`, so the result is right except for a hash collision with probability 2^-64.
    """
    ordered = np.sort(keys)
    shared = ordered[1:][ordered[1:] == ordered[:-1]]
    if not len(shared):
        return None
    at = among(keys, shared)
    _, index, place = np.unique(keys[at], return_index=True, return_inverse=True)
    first = np.arange(len(keys))
    first[at] = at[index][place.reshape(-1)]
    return first


def among(keys: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Indices of those of (n,) hashes that occur among the (m,) wanted ones, both uint64; fast if few match."""
    mask = np.uint64((1 << _SIEVE_BITS) - 1)
    is_wanted = np.zeros(1 << _SIEVE_BITS, bool)
    is_wanted[(wanted & mask).view(np.intp)] = True
    at = np.flatnonzero(is_wanted.take((keys & mask).view(np.intp)))
    return at[np.isin(keys.take(at), wanted)]


def part_labels(corners: np.ndarray, labels: np.ndarray | None = None) -> np.ndarray:
    """(V,) intp: for each vertex the lowest vertex of its part; the (t, 3) corners of triangles connect vertices.

    labels: (V,) intp from `twins`, for vertices to be merged beforehand; None: merge none.
    Roots are hooked onto lower ones along two edges of each triangle, and the paths halved (Shiloach & Vishkin 1982).
    If several lower roots are possible, any will do, so the last one written stays; parts that remain separate are
    joined in the next round, which has triangles between the few roots only.
    """
    labels = np.arange(int(corners.max(initial=-1)) + 1) if labels is None else labels.copy()
    for chunk in triangle_chunks(len(corners)):
        first, second, third = corner_indices(corners[chunk])
        for edge in ((first, second), (second, third)):
            a, b = (labels.take(end) for end in edge)
            at = np.flatnonzero(a != b)
            a, b = a.take(at), b.take(at)
            labels[np.maximum(a, b)] = np.minimum(a, b)
    labels = _shortened(labels)
    apart = []
    for chunk in triangle_chunks(len(corners)):
        a, b, c = ends = labels.take(corner_indices(corners[chunk]))
        apart.append(ends.take(np.flatnonzero((a != b) | (a != c)), axis=1))
    apart = np.concatenate(apart, axis=1).T if apart else corners
    if len(apart):
        roots = np.flatnonzero(labels == np.arange(len(labels)))
        number = np.empty_like(labels)
        number[roots] = np.arange(len(roots))
        labels[roots] = roots.take(part_labels(number.take(apart), np.arange(len(roots))))
        labels = labels.take(labels)
    return labels


def _shortened(labels: np.ndarray) -> np.ndarray:
    """For every vertex the root of its path."""
    while True:
        shorter = labels.take(labels)
        if np.array_equal(shorter, labels):
            return labels
        labels = shorter
