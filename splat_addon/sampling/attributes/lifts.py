# SPDX-License-Identifier: GPL-3.0-or-later
"""How high the smooth surface that corner normals describe lies above a mesh's triangles.

Facets that turn away from a light lie in the shadow of their neighbours even where their shading normals face it. They
are therefore lit as points of the smooth surface are, which is the mean of the places on the tangent planes of a
triangle's corners, by barycentric weights (Boubekeur and Alexa, "Phong Tessellation", 2008). Where a tangent plane
lies below the triangle, it counts as the triangle itself (Hanika, "Hacking the Shadow Terminator", 2021), so points
are never moved into the surface.
"""

from __future__ import annotations

from functools import partial

import numpy as np

from ...workers import run_all
from ..mesh.triangle_mesh import TriangleMesh, gather_corners, triangle_chunks

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

    def fill(some: slice):
        corners = gather_corners(mesh.positions.T, mesh.triangles[some])
        normals = mesh.corner_normals[some].transpose(2, 1, 0).astype(np.float64, order="C")
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            normals /= np.sqrt(_squares(normals))
            for start, row in enumerate(bulges):
                end = (start + 1) % 3
                edge = corners[:, end] - corners[:, start]
                below = np.maximum(-_dots(edge, normals[:, start]), 0) + np.maximum(_dots(edge, normals[:, end]), 0)
                row[some] = np.where(np.isfinite(below), below, 0)

    run_all(partial(fill, some) for some in triangle_chunks(len(mesh)))
    return bulges if MOST_LIFT * bulges.max(initial=0) > LEAST_LIFT * spacing else None


def lifts(shares: np.ndarray, bulges: np.ndarray) -> np.ndarray:
    """(n,) object units, 0 or more, at (3, n) barycentric weights in triangles with (3, n) bulges of their edges."""
    lifted = shares[0] * shares[1] * bulges[0]
    for k in (1, 2):
        lifted += shares[k] * shares[(k + 1) % 3] * bulges[k]
    # weights on an edge are rounded to either side of 0
    return np.maximum(lifted, 0, out=lifted)


def _squares(vectors: np.ndarray) -> np.ndarray:
    """(...) squared lengths of (3, ...) vectors."""
    x, y, z = vectors
    return x * x + y * y + z * z


def _dots(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(t,) dot products of (3, t) vectors, with their terms in the order in which numpy adds those of rows."""
    return a[0] * b[0] + a[2] * b[2] + a[1] * b[1]
