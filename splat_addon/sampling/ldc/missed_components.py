# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the connected parts of a mesh that lie between all rays: bolts, wires, dust smaller than a cell.

This is cheap if nothing was missed: only triangles without a sample are considered, and the sampled surface grows over
nearly all of them in a few steps. Only triangles that it does not reach are welded and labelled.
"""

from __future__ import annotations

import numpy as np

from ..mesh.connectivity import among, part_labels
from ..mesh.triangle_mesh import TriangleMesh

#: The sampled surface stops growing when a step takes less than this share of the rest, or when the rest is below this
#: number of triangles; labelling handles the remainder.
_WORTHWHILE_SHARE, _FEW = 0.1, 4096


class SampledSurface:
    """Grows from the triangles that have samples to those that share a vertex with them, in passes over the mesh.

    reached: (V,) bool, reached vertices.
    """

    def __init__(self, vertices: int):
        self.reached = np.zeros(vertices, bool)
        self._rest: list[np.ndarray] = []

    def add(self, indices: np.ndarray, sampled: np.ndarray):
        """Record that the triangles with vertices `indices`, (3, t), have samples."""
        self.reached[indices.take(sampled, axis=1).ravel()] = True

    def grow(self, indices: np.ndarray, start: int):
        """Grow one step over the triangles with vertices `indices`, (3, t), which are numbered from `start`."""
        a, b, c = self.reached.take(indices)
        touched = a | b | c
        grown = np.flatnonzero(touched & ~(a & b & c))
        self.reached[indices.take(grown, axis=1).ravel()] = True
        self._rest.append(np.flatnonzero(~touched) + start)

    def rest(self) -> np.ndarray:
        """(m,) triangles not yet reached; this includes neighbours of triangles that were reached later in the same
        pass."""
        return np.concatenate(self._rest)


def missed_components(mesh: TriangleMesh, surface: SampledSurface) -> tuple[np.ndarray, np.ndarray]:
    """The triangles of all parts without a sample, and each one's part: two (m,) intp arrays. Parts are numbered from 0
    in the order of their first triangles.

    surface: the sampled surface of the mesh. Triangles with a common corner position belong to one part.
    """
    rest, reached = surface.rest(), surface.reached
    corners, rest = _unreached(mesh.triangles.take(rest, axis=0), rest, reached)
    if len(rest):
        corners, reached = _welded(mesh.places, corners, reached)
        corners, rest = _unreached(corners, rest, reached)
    if not len(rest):
        return rest, rest
    labels = part_labels(corners)
    is_found = np.zeros(len(reached), bool)
    is_found[labels[np.flatnonzero(reached[: len(labels)])]] = True
    part = labels[corners[:, 0]]
    missed = ~is_found[part]
    _, first, number = np.unique(part[missed], return_index=True, return_inverse=True)
    # in the order of their first triangles, because labels follow the order of hashes
    return rest[missed], np.argsort(np.argsort(first))[number.reshape(-1)]


def _welded(hashes: np.ndarray, corners: np.ndarray, reached: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(m, 3) corners that index positions instead of vertices, and the (p,) positions of reached vertices.

    hashes: (V,) of the vertices' positions.
    """
    places, named = np.unique(hashes.take(corners.ravel()), return_inverse=True)
    at = among(hashes, places)
    is_reached = np.zeros(len(places), bool)
    is_reached[np.searchsorted(places, hashes.take(at[reached.take(at)]))] = True
    return named.reshape(-1, 3), is_reached


def _unreached(corners: np.ndarray, rest: np.ndarray, reached: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The (m, 3) corners and (m,) triangles that the reached vertices, (V,) bool, do not grow over."""
    while len(rest) and not reached.all():
        a, b, c = reached.take(corners).T
        touched = a | b | c
        left = np.flatnonzero(~touched)
        reached[corners.compress(touched, axis=0).ravel()] = True
        before, corners, rest = len(rest), corners.take(left, axis=0), rest.take(left)
        taken = before - len(rest)
        if not taken or (taken < _WORTHWHILE_SHARE * before and before > _FEW):
            return corners, rest
    return (corners, rest) if not reached.all() else (corners[:0], rest[:0])
