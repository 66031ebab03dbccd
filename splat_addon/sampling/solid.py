# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a mesh bounds a solid, so that no viewer outside it ever sees the back of its surface.

Where that holds, `Surfels.is_solid` lets the renderer leave backs out: half the splats, and silhouettes without
the rim of those that stick out from behind.
"""

from __future__ import annotations

import numpy as np

from .cleaning import vertex_hashes
from .connectivity import part_labels, twins
from .mesh import TriangleMesh, corner_indices, crossed, gather_corners, triangle_chunks


def is_solid(mesh: TriangleMesh) -> bool:
    """Whether every triangle's edges are met by others running the other way, and every part turns outwards.

    Vertices at one place count as one, as importers split them at seams. Then a ray from outside enters before it
    leaves: first hits are always fronts. Parts are joined by vertices; one with a negative or no volume (turned
    inside out, a cavity) makes the answer False, which costs speed and never a picture.
    """
    return SolidShape(mesh).is_solid_at(mesh.positions)


class SolidShape:
    """What `is_solid` looks at, for a mesh whose vertices move: what hangs together is found once."""

    def __init__(self, mesh: TriangleMesh):
        self._triangles = mesh.triangles
        self._is_closed = bool(len(mesh)) and bool(np.isfinite(mesh.positions).all())
        if self._is_closed:
            keys = vertex_hashes(mesh.positions)
            self._is_closed = _is_closed(keys, mesh.triangles)
        if self._is_closed:
            #: For each vertex, the first at its place; None: no place has several.
            self._twins = twins(keys)
            corners = mesh.triangles if self._twins is None else self._twins.take(mesh.triangles)
            self._parts = part_labels(corners).take(corners[:, 0])

    def is_solid_at(self, positions: np.ndarray) -> bool:
        """positions: (V, 3) of the same vertices. False too where vertices that were at one place have parted."""
        if not self._is_closed or not np.isfinite(positions).all():
            return False
        if self._twins is not None and not np.array_equal(positions[self._twins], positions):
            return False
        has_triangles = np.bincount(self._parts) > 0
        return bool((self._part_volumes(positions)[has_triangles] > 0).all())

    def _part_volumes(self, positions: np.ndarray) -> np.ndarray:
        """Signed volume of every connected part, by the divergence theorem, about the mesh's middle."""
        points = np.ascontiguousarray(positions.T)
        ends = [(float(component.min()), float(component.max())) for component in points]
        scale = max(max(high - low for low, high in ends), np.finfo(np.float64).tiny)
        for component, (low, high) in zip(points, ends, strict=True):
            component -= (low + high) / 2
            component /= scale
        volumes = np.empty(len(self._triangles))
        for chunk in triangle_chunks(len(volumes)):
            corners = gather_corners(points, self._triangles[chunk])
            normals = crossed(corners[:, 1:])
            volumes[chunk] = sum(corners[k, 0] * normals[k] for k in range(3))
        return np.bincount(self._parts, volumes) / 6


def _is_closed(keys: np.ndarray, triangles: np.ndarray) -> bool:
    """Whether the boundary of the chain of (T, 3) triangles vanishes. keys: (V,) uint64, of the vertices' places.

    Directed edges are added up under an antisymmetric weight of their ends' keys, which are as good as random, modulo
    2^64: the sum of a chain with a boundary is 0 with a probability of about 2^-64. Degenerate triangles cancel by
    themselves.
    """
    mixed = (keys ^ (keys >> np.uint64(31))) * np.uint64(0xD6E8FEB86659FD93)
    total = np.uint64(0)
    with np.errstate(over="ignore"):
        for chunk in triangle_chunks(len(triangles)):
            indices = corner_indices(triangles[chunk])
            first, second = keys.take(indices), mixed.take(indices)
            for k in range(3):
                after = (k + 1) % 3
                total += (first[k] * second[after] - first[after] * second[k]).sum(dtype=np.uint64)
    return bool(total == 0)
