# SPDX-License-Identifier: GPL-3.0-or-later
"""Tangents of a mesh's texture coordinates, the frame of normal maps: MikkTSpace, which Blender and glTF use.

Mikkelsen, "Simulation of Wrinkled Surfaces Revisited", 2008: each triangle's direction of growing u is projected onto
the plane perpendicular to the corner's normal. A corner's tangent is the mean of these directions, weighted by angle,
over the triangles that share the corner's position, normal and texture coordinates and whose texture has the same
handedness.
"""

from __future__ import annotations

import numpy as np

from ...vectors import unit
from ..mesh.triangle_mesh import TriangleMesh


def layered_tangents(mesh: TriangleMesh) -> np.ndarray | None:
    """(T, 3, 4 layers) float32: `corner_tangents` for each layer of texture coordinates; None if there is no layer."""
    if mesh.corner_uvs is None:
        return None
    layers = (mesh.corner_uvs[..., k : k + 2] for k in range(0, mesh.corner_uvs.shape[2], 2))
    return np.concatenate([corner_tangents(mesh, uvs) for uvs in layers], axis=2)


@np.errstate(divide="ignore", invalid="ignore", over="ignore")
def corner_tangents(mesh: TriangleMesh, uvs: np.ndarray) -> np.ndarray:
    """(T, 3, 4) float32: the unit tangent of each corner, and the sign of the bitangent, cross(normal, tangent).

    uvs: (T, 3, 2). Zero where a triangle has no area on the texture or on the surface.
    """
    corners = mesh.positions[mesh.triangles]
    uvs = np.asarray(uvs, np.float64)
    face_normals = unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    if mesh.corner_normals is None:
        normals = np.broadcast_to(face_normals[:, None], corners.shape)
    else:
        given = unit(np.asarray(mesh.corner_normals, np.float64))
        normals = np.where(np.isfinite(given).all(axis=2, keepdims=True), given, face_normals[:, None])
    along_u, mirrored = _directions(corners, uvs)
    flattened = unit(_flattened(along_u[:, None], normals))
    # The angle between a corner's edges, both projected perpendicular to its normal.
    next_edge, last_edge = (unit(_flattened(np.roll(corners, -k, axis=1) - corners, normals)) for k in (1, 2))
    angles = np.arccos(np.clip((next_edge * last_edge).sum(axis=2), -1, 1))
    weighted = np.nan_to_num(flattened * angles[..., None], posinf=0, neginf=0)
    group = _groups(mesh.triangles, normals, uvs, mirrored)
    sums = np.stack([np.bincount(group, column)[group] for column in weighted.reshape(-1, 3).T], axis=1)
    tangents = np.nan_to_num(unit(sums)).reshape(corners.shape)
    signs = np.broadcast_to(np.where(mirrored, -1.0, 1.0)[:, None, None], (*corners.shape[:2], 1))
    return np.concatenate([tangents, signs], axis=2).astype(np.float32)


def _directions(corners: np.ndarray, uvs: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(T, 3) unit directions on the surface in which u grows and v is constant, and (T,) whether the texture is
    mirrored."""
    (du1, dv1), (du2, dv2) = ((uvs[:, k] - uvs[:, 0]).T for k in (1, 2))
    p1, p2 = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = du1 * dv2 - du2 * dv1
    return unit((p1 * dv2[:, None] - p2 * dv1[:, None]) * np.sign(area)[:, None]), area < 0


def _groups(triangles: np.ndarray, normals: np.ndarray, uvs: np.ndarray, mirrored: np.ndarray) -> np.ndarray:
    """(3 T,) integers that are equal for corners that share position, normal and texture coordinates."""
    columns = [
        triangles.reshape(-1, 1),
        np.ascontiguousarray(normals, np.float32).reshape(-1, 3).view(np.int32),
        np.ascontiguousarray(uvs, np.float32).reshape(-1, 2).view(np.int32),
        np.repeat(mirrored, 3)[:, None],
    ]
    keys = np.concatenate([column.astype(np.int64) for column in columns], axis=1)
    order = np.lexsort(keys.T)
    is_new = np.concatenate([[0], (np.diff(keys[order], axis=0) != 0).any(axis=1)]).astype(np.intp)
    group = np.empty(len(order), np.intp)
    group[order] = np.cumsum(is_new)
    return group


def _flattened(vectors: np.ndarray, normals: np.ndarray) -> np.ndarray:
    return vectors - normals * (vectors * normals).sum(axis=-1, keepdims=True)
