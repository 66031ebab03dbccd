# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a mesh bounds a solid, so that no viewer outside it ever sees the back of its surface.

Where that holds, `Surfels.is_solid` lets the renderer leave backs out: half the splats, and silhouettes without
the rim of those that stick out from behind.
"""

from __future__ import annotations

import numpy as np

from .connectivity import part_labels, welded
from .mesh import TriangleMesh


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
            welds = welded(mesh.positions)
            corners = welds[mesh.triangles]
            self._is_closed = _is_closed(corners)
            first = np.unique(welds, return_index=True)[1]
            #: For each vertex, the first at its place.
            self._twins = first[welds]
            self._parts = np.unique(part_labels(corners)[corners[:, 0]], return_inverse=True)[1].reshape(-1)

    def is_solid_at(self, positions: np.ndarray) -> bool:
        """positions: (V, 3) of the same vertices. False too where vertices that were at one place have parted."""
        if not self._is_closed or not np.isfinite(positions).all():
            return False
        if not np.array_equal(positions[self._twins], positions):
            return False
        return bool((self._part_volumes(positions) > 0).all())

    def _part_volumes(self, positions: np.ndarray) -> np.ndarray:
        """Signed volume of every connected part, by the divergence theorem, about the mesh's middle."""
        low, high = positions.min(axis=0), positions.max(axis=0)
        scale = max(float((high - low).max()), np.finfo(np.float64).tiny)
        points = np.ascontiguousarray(((positions - (low + high) / 2) / scale).T)
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = ([p.take(corner) for p in points] for corner in self._triangles.T)
        volumes = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
        return np.bincount(self._parts, volumes) / 6


def _is_closed(corners: np.ndarray) -> bool:
    """Whether the boundary of the chain of triangles vanishes.

    Directed edges are added up under an antisymmetric random weight, modulo 2^64: the sum of a chain with a
    boundary is 0 with a probability of about 2^-64. Degenerate triangles cancel by themselves.
    """
    random = np.random.default_rng(0)
    count = int(corners.max()) + 1
    first, second = (random.integers(0, 2**64, count, np.uint64) for _ in range(2))
    total = np.uint64(0)
    with np.errstate(over="ignore"):
        for k in range(3):
            a, b = corners[:, k], corners[:, (k + 1) % 3]
            total += (first[a] * second[b] - first[b] * second[a]).sum(dtype=np.uint64)
    return bool(total == 0)
