# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the charts of a UV map end: a texture-mapped splat that reaches over such an edge must not show what lies
beside its chart in the image.

Each surfel keeps the nearest edge of its own triangle at which the map breaks off, as a line in its ellipse.
"""

from __future__ import annotations

import numpy as np

from ..mesh.places import vertex_hashes
from ..mesh.triangle_mesh import TriangleMesh

#: Lines farther from the centre than this, in half-axes, limit nothing that is looked up.
FARTHEST = 1.5
#: A line through the centre is taken as this far from it.
_NEAREST = 1e-3


def seam_edges(mesh: TriangleMesh) -> np.ndarray:
    """(T, 3) bool: whether the edge opposite each corner is shared with no triangle of the same material that has the
    same texture coordinates there."""
    places = mesh.places[mesh.triangles]
    uvs = np.asarray(mesh.corner_uvs, np.float32)
    corners = places ^ vertex_hashes(uvs.reshape(-1, uvs.shape[2]).astype(np.float64)).reshape(places.shape)
    # a sum names an edge alike from both sides
    edges = corners[:, [1, 2, 0]] + corners[:, [2, 0, 1]]
    if mesh.materials is not None:
        edges = edges ^ (mesh.materials.astype(np.uint64) * np.uint64(0x9E3779B97F4A7C15))[:, None]
    _, inverse, counts = np.unique(edges, return_inverse=True, return_counts=True)
    return (counts[inverse] == 1).reshape(edges.shape)


def border_lines(seams: np.ndarray, weights: np.ndarray, changes: np.ndarray) -> np.ndarray:
    """(n, 2) float32 m of the nearest seam m . q = 1 in each ellipse's own coordinates q; 0 where none is near.

    seams: (n, 3) of each sample's triangle. weights: (3, n) barycentric, at the centre. changes: (3, 2, n) their change
    along the two half-axes.
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
