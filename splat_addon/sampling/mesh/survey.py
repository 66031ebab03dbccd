# SPDX-License-Identifier: GPL-3.0-or-later
"""One pass over all triangles of a mesh that collects what both the removal of unusable triangles and the test for
solids need.

Fetching the corners costs more than the tests, so it is done once.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .triangle_mesh import TriangleMesh, corner_indices, corners_at, doubled_areas, triangle_chunks


@dataclass(frozen=True, eq=False)
class Survey:
    """flat: (k,) intp, ascending: triangles of zero area.
    facing_area: total area, see `TriangleMesh`.
    suspects: (m,) intp, ascending: all triangles that may have the same three positions as another, in any order.
    is_used: (V,) bool: whether a triangle of non-zero area uses the vertex.
    boundary: sum of `boundary_weights`, 0 if the boundary of the triangles vanishes, with coincident vertices merged.
    volumes: (T,) float64 from `signed_volumes`; None if the mesh is open.
    """

    flat: np.ndarray
    suspects: np.ndarray
    facing_area: float
    is_used: np.ndarray
    boundary: np.uint64
    volumes: np.ndarray | None

    @property
    def is_closed(self) -> bool:
        return bool(self.boundary == 0)


def survey(mesh: TriangleMesh) -> Survey:
    """The survey of the mesh, computed once; its result is meaningless if vertices are not finite."""
    if mesh.surveyed is None:
        object.__setattr__(mesh, "surveyed", _survey(mesh))
    return mesh.surveyed


def _survey(mesh: TriangleMesh) -> Survey:
    """The fields of `Survey` in order, computed chunk by chunk."""
    keys, count = mesh.places, len(mesh)
    flat, sums, volumes = [np.empty(0, np.intp)], np.empty(count, np.uint64), np.empty(count)
    is_used = np.zeros(len(mesh.positions), bool)
    facing_area, boundary = 0.0, np.uint64(0)
    with np.errstate(over="ignore", invalid="ignore"):
        for chunk in triangle_chunks(count):
            indices = corner_indices(mesh.triangles[chunk])
            a, b, c = keys.take(indices)
            np.add(a, b, out=sums[chunk])
            sums[chunk] += c
            boundary += boundary_weights(a, b, c).sum(dtype=np.uint64)

            corners = corners_at(mesh.positions.T, indices)
            normals = doubled_areas(corners)
            _volumes(corners[:, 0], normals, out=volumes[chunk])
            sizes = np.abs(normals, out=normals)
            largest = np.maximum(sizes[0], sizes[1])
            np.maximum(largest, sizes[2], out=largest)
            facing_area += float(largest.sum()) / 2
            empty = np.flatnonzero(largest == 0)
            if len(empty):
                flat.append(empty + chunk.start)
                widest = largest.argmax()
                if largest[widest] == 0:
                    continue
                indices[:, empty] = indices[:, widest, None]
            is_used[indices] = True
    suspects = _suspects(sums, mesh)
    return Survey(np.concatenate(flat), suspects, facing_area, is_used, boundary, None if boundary else volumes)


def survey_without(mesh: TriangleMesh, those: np.ndarray, left: TriangleMesh) -> Survey:
    """The survey of `left`, which is `mesh` without some triangles, from that of `mesh`: only the dropped are looked at
    again. those: (k,) their indices, without repeats, among them all of zero area."""
    found, is_kept = survey(mesh), np.ones(len(mesh), bool)
    is_kept[those] = False
    indices = corner_indices(mesh.triangles[those])
    area = float(np.abs(doubled_areas(corners_at(mesh.positions.T, indices))).max(axis=0).sum()) / 2
    with np.errstate(over="ignore"):
        boundary = found.boundary - boundary_weights(*mesh.places.take(indices)).sum(dtype=np.uint64)
    is_used = np.zeros(len(left.positions), bool)
    is_used[left.triangles] = True
    suspects = np.cumsum(is_kept)[found.suspects[is_kept[found.suspects]]] - 1
    volumes = None
    if not boundary:
        volumes = signed_volumes(left.positions, left.triangles) if found.volumes is None else found.volumes[is_kept]
    return Survey(np.empty(0, np.intp), suspects, found.facing_area - area, is_used, boundary, volumes)


def boundary_weights(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    """(t,) uint64 whose sum over some triangles is 0 if they are closed. a, b, c: (t,) hashes of their corners' places.

    Directed edges are added up under an antisymmetric weight of the hashes f of their ends' places, modulo 2^64:
    f g (g - f), which for the three edges of a triangle is the product of the differences. The sum of a chain with a
    boundary is 0 only with a probability of about 2^-50, and degenerate triangles cancel out.
    """
    weights = a - b
    weights *= b - c
    weights *= c - a
    return weights


def signed_volumes(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(T,) float64: six times the signed volume between each triangle and (0, 0, 0), positive if the triangle faces
    away from it. For a closed surface they add up to six times its volume. positions: (V, 3)."""
    components, volumes = np.ascontiguousarray(positions.T), np.empty(len(triangles))
    for chunk in triangle_chunks(len(triangles)):
        corners = corners_at(components, corner_indices(triangles[chunk]))
        _volumes(corners[:, 0], doubled_areas(corners), out=volumes[chunk])
    return volumes


def _volumes(first: np.ndarray, normals: np.ndarray, out: np.ndarray):
    """first: (3, t) a corner of each triangle. normals: (3, t), as long as twice the area."""
    np.multiply(first[0], normals[0], out=out)
    out += first[1] * normals[1]
    out += first[2] * normals[2]


def _suspects(sums: np.ndarray, mesh: TriangleMesh) -> np.ndarray:
    """The triangles whose sum of hashed positions equals that of another triangle. sums: (T,), sorted in place."""
    sums.sort()
    shared = sums[1:][sums[1:] == sums[:-1]]
    if not len(shared):
        return np.empty(0, np.intp)
    return np.flatnonzero(np.isin(mesh.places[mesh.triangles].sum(axis=1, dtype=np.uint64), shared))
