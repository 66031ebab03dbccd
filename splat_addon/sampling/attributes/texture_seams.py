# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds where the charts of a UV map end, because a texture-mapped splat that reaches over such an edge must not show
the image beside its chart.

Each surfel stores the nearest chart edge of its own triangle, as a line in its ellipse.
"""

from __future__ import annotations

import numpy as np

from ..mesh.places import vertex_hashes
from ..mesh.triangle_mesh import TriangleMesh

#: Lines farther from the centre than this, in half-axes, have no effect.
FARTHEST = 1.5
#: A line through the centre is treated as if it were this far from it.
_NEAREST = 1e-3


def seam_edges(mesh: TriangleMesh) -> np.ndarray:
    """(T, 3) bool: whether the edge opposite each corner is a seam, which no triangle of the same material shares with
    the same texture coordinates."""
    return _seams(_corners(mesh))


def corner_seams(mesh: TriangleMesh) -> np.ndarray:
    """(3 T,) uint8: 1 where the edge opposite the corner is a seam, plus 2 where the triangle touches a seam with the
    corner alone (`Polygons`)."""
    corners = _corners(mesh)
    seams = _seams(corners)
    touches = np.isin(corners, np.concatenate([corners[:, others][seams] for others in ([1, 2, 0], [2, 0, 1])]))
    return (seams + 2 * (touches & ~seams[:, [1, 2, 0]] & ~seams[:, [2, 0, 1]])).astype(np.uint8).ravel()


def _corners(mesh: TriangleMesh) -> np.ndarray:
    """(T, 3) uint64, equal for corners of one material at one place with the same texture coordinates."""
    places = mesh.places[mesh.triangles]
    uvs = np.asarray(mesh.corner_uvs, np.float32)
    corners = places ^ vertex_hashes(uvs.reshape(-1, uvs.shape[2]).astype(np.float64)).reshape(places.shape)
    if mesh.materials is not None:
        corners = corners ^ (mesh.materials.astype(np.uint64) * np.uint64(0x9E3779B97F4A7C15))[:, None]
    return corners


def _seams(corners: np.ndarray) -> np.ndarray:
    # a sum identifies an edge from either side
    edges = corners[:, [1, 2, 0]] + corners[:, [2, 0, 1]]
    _, inverse, counts = np.unique(edges, return_inverse=True, return_counts=True)
    return (counts[inverse] == 1).reshape(edges.shape)


def border_lines(seams: np.ndarray, weights: np.ndarray, changes: np.ndarray) -> np.ndarray:
    """(n, 2) float32 m of the nearest seam m . q = 1 in each ellipse's own coordinates q; 0 if none is near.

    seams: (n, 3), result of `seam_edges` for each sample's triangle. weights: (3, n) barycentric weights at the centre.
        changes: (3, 2, n) their change along the two half-axes.
    """
    lines = np.zeros((len(seams), 2), np.float32)
    nearest = np.full(len(seams), FARTHEST)
    for seam, weight, change in zip(seams.T, weights, changes, strict=True):
        slope = np.hypot(*change)
        with np.errstate(divide="ignore", invalid="ignore"):
            distance = np.maximum(weight / slope, _NEAREST)
            at = np.flatnonzero(seam & (distance < nearest) & np.isfinite(slope))
            lines[at] = (-change[:, at] / (slope[at] * distance[at])).T
        nearest[at] = distance[at]
    return lines
