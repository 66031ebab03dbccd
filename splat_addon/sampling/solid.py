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
    if not len(mesh) or not np.isfinite(mesh.positions).all():
        return False
    corners = welded(mesh.positions)[mesh.triangles]
    return _is_closed(corners) and bool((_part_volumes(mesh, corners) > 0).all())


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


def _part_volumes(mesh: TriangleMesh, corners: np.ndarray) -> np.ndarray:
    """Signed volume of every connected part, by the divergence theorem, about the mesh's middle."""
    low, high = mesh.bounds()
    scale = max(float((high - low).max()), np.finfo(np.float64).tiny)
    points = (mesh.positions - (low + high) / 2) / scale
    a, b, c = (points[mesh.triangles[:, k]] for k in range(3))
    volumes = np.einsum("ij,ij->i", a, np.cross(b, c)) / 6
    parts = np.unique(part_labels(corners)[corners[:, 0]], return_inverse=True)[1].reshape(-1)
    return np.bincount(parts, volumes)
