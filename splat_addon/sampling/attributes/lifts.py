# SPDX-License-Identifier: GPL-3.0-or-later
"""How high the smooth surface that corner normals describe lies above a mesh's triangles.

Facets that turn away from a light lie in the shadow of their neighbours even where their shading normals face it. They
are therefore lit as points of the smooth surface are, which is the mean of the places on the tangent planes of a
triangle's corners, by barycentric weights (Boubekeur and Alexa, "Phong Tessellation", 2008). Where a tangent plane
lies below the triangle, it counts as the triangle itself (Hanika, "Hacking the Shadow Terminator", 2021), so points
are never moved into the surface.
"""

from __future__ import annotations

import numpy as np

from ..mesh.triangle_mesh import TriangleMesh, triangle_chunks

#: Lifts below this many spacings are not stored: shadow maps hold splats that much farther back.
LEAST_LIFT = 0.1

#: The largest product of two of three barycentric weights, summed over the edges.
MOST_LIFT = 1 / 3


def edge_bulges(mesh: TriangleMesh, spacing: float) -> np.ndarray | None:
    """(3, T) float32: how far the ends of each triangle's edges 0-1, 1-2 and 2-0 lie below one another's tangent
    planes, together, object units; None if that lifts no point by `LEAST_LIFT` spacings.
    """
    if mesh.corner_normals is None:
        return None
    bulges = np.empty((3, len(mesh)), np.float32)
    for some in triangle_chunks(len(mesh)):
        corners, normals = mesh.positions[mesh.triangles[some]], mesh.corner_normals[some].astype(np.float64)
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            normals /= np.linalg.norm(normals, axis=2, keepdims=True)
            for start, row in enumerate(bulges):
                end = (start + 1) % 3
                edge = corners[:, end] - corners[:, start]
                ends = (np.einsum("ij,ij->i", sign * edge, normals[:, k]) for sign, k in ((-1, start), (1, end)))
                row[some] = np.nan_to_num(sum(np.maximum(below, 0) for below in ends), posinf=0)
    return bulges if MOST_LIFT * bulges.max(initial=0) > LEAST_LIFT * spacing else None


def lifts(shares: np.ndarray, bulges: np.ndarray) -> np.ndarray:
    """(n,) object units, 0 or more, at (3, n) barycentric weights in triangles with (3, n) bulges of their edges."""
    lifted = shares[0] * shares[1] * bulges[0]
    for k in (1, 2):
        lifted += shares[k] * shares[(k + 1) % 3] * bulges[k]
    # weights on an edge are rounded to either side of 0
    return np.maximum(lifted, 0, out=lifted)
