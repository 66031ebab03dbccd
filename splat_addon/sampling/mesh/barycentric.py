# SPDX-License-Identifier: GPL-3.0-or-later
"""Barycentric coordinates of places in triangles."""

from __future__ import annotations

import numpy as np

from .triangle_mesh import TriangleMesh


def barycentric(mesh: TriangleMesh, triangles: np.ndarray, places: np.ndarray) -> np.ndarray:
    """(k, 3) barycentric coordinates of (k, 3) places in the planes of (k,) triangles, clamped to them."""
    corners = mesh.positions[mesh.triangles[triangles]]
    first, second, offset = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], places - corners[:, 0]
    normal = np.cross(first, second)
    square = np.maximum(np.einsum("ij,ij->i", normal, normal), 1e-300)
    u = np.einsum("ij,ij->i", np.cross(offset, second), normal) / square
    v = np.einsum("ij,ij->i", np.cross(first, offset), normal) / square
    shares = np.clip(np.stack([1 - u - v, u, v], axis=1), 0, 1)
    return shares / shares.sum(axis=1, keepdims=True)
