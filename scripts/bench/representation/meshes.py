# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes coloured by their normals, and the views that show them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import trimesh
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import Delaunay

from measuring.models import load
from splat_addon.rendering import Camera, look_at
from splat_addon.sampling import Channel, Surface, TriangleMesh, VertexColors

CREASE = np.radians(30)

#: Directions from the model's middle to the camera.
VIEWS = np.array(((1.2, 0.7, 2.6), (-2.0, 1.1, 0.9), (0.8, -1.4, -1.9)))


#: Shapes that are smooth everywhere.
SMOOTH = {
    "ball": lambda: trimesh.creation.icosphere(6),
    "torus": lambda: trimesh.creation.torus(1.0, 0.4, 192, 96),
    "capsule": lambda: trimesh.creation.capsule(2.0, 0.6, count=[96, 96]),
}


def load_colored(folder: Path, name: str) -> TriangleMesh:
    """Load a model from the folder, or make the drilled plate or a smooth shape; split it at creases and colour it by
    its normals."""
    if name == "plate":
        return colored(*drilled_plate())
    if name in SMOOTH:
        shape = SMOOTH[name]()
        return colored(np.asarray(shape.vertices), np.asarray(shape.faces))
    mesh = load(folder / name)
    return colored(mesh.positions, mesh.triangles)


def view(mesh: TriangleMesh, number: int, size: int) -> Camera:
    """The camera at 1.4 diagonals of the box, with a field of view of 0.6."""
    low, high = mesh.bounds()
    middle, diagonal = (low + high) / 2, float(np.linalg.norm(high - low))
    eye = middle + 1.4 * diagonal * VIEWS[number] / np.linalg.norm(VIEWS[number])
    return Camera.perspective(look_at(eye, middle, (0, 1, 0)), 0.6, (size, size), diagonal / 100, diagonal * 10)


def colored(positions: np.ndarray, triangles: np.ndarray) -> TriangleMesh:
    normals = split_normals(positions, triangles)
    colors = np.concatenate([normals / 2 + 0.5, np.ones((*normals.shape[:2], 1))], axis=2).astype(np.float32)
    surface = Surface(Channel((1, 1, 1, 1), VertexColors()))
    return TriangleMesh(positions, triangles, corner_normals=normals, corner_colors=colors, surfaces=(surface,))


def split_normals(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(T, 3, 3) unit normals: at each corner the angle-weighted mean over the surrounding triangles up to the
    creases."""
    _, places = np.unique(positions, axis=0, return_inverse=True)
    places = places.reshape(-1)[triangles]
    corners = positions[triangles]
    normals = _unit(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    edges = np.sort(np.stack([places, np.roll(places, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    order = np.lexsort(edges.T)
    twin = np.flatnonzero((edges[order][1:] == edges[order][:-1]).all(axis=1))
    one, other = order[twin], order[twin + 1]
    smooth = (normals[one // 3] * normals[other // 3]).sum(axis=1) > np.cos(CREASE)
    one, other = one[smooth], other[smooth]
    links = []
    for end in (0, 1):
        mine = one // 3 * 3 + (one % 3 + end) % 3
        for k in range(3):
            its = other // 3 * 3 + k
            same = places.ravel()[its] == places.ravel()[mine]
            links.append(np.stack([mine[same], its[same]]))
    links = np.concatenate(links, axis=1)
    count = 3 * len(triangles)
    graph = coo_matrix((np.ones(links.shape[1]), tuple(links)), shape=(count, count))
    fan = connected_components(graph, directed=False)[1]
    sides = [_unit(np.roll(corners, -k, axis=1) - corners) for k in (1, 2)]
    angles = np.arccos(np.clip((sides[0] * sides[1]).sum(axis=2), -1, 1)).ravel()
    weighted = np.repeat(normals, 3, axis=0) * angles[:, None]
    sums = np.stack([np.bincount(fan, column)[fan] for column in weighted.T], axis=1)
    return np.where((sums**2).sum(axis=1, keepdims=True) > 1e-24, _unit(sums), np.repeat(normals, 3, axis=0)).reshape(
        -1, 3, 3
    )


def drilled_plate() -> tuple[np.ndarray, np.ndarray]:
    """Positions and triangles of a plate with holes of many sizes: a machined part that consists mostly of edges."""
    holes = [(0.0, 0.0, 0.22)] + [(0.62 * np.cos(a), 0.62 * np.sin(a), 0.09) for a in np.arange(6) * np.pi / 3 + 0.3]
    holes += [(0.85 * np.cos(a), 0.85 * np.sin(a), 0.02) for a in np.arange(20) * np.pi / 10]
    rings = [_ring(0, 0, 1.0, 96)] + [_ring(*hole, 48 if hole[2] > 0.05 else 12) for hole in holes]
    flat = np.concatenate(rings)
    faces = Delaunay(flat).simplices
    # A triangle with all corners on one hole's rim fills the hole.
    ring = np.repeat(np.arange(len(rings)), [len(points) for points in rings])[faces]
    faces = faces[(ring != ring[:, :1]).any(axis=1) | (ring[:, 0] == 0)]
    (x1, y1), (x2, y2) = ((flat[faces[:, k]] - flat[faces[:, 0]]).T for k in (1, 2))
    faces = np.where((x1 * y2 - x2 * y1 < 0)[:, None], faces[:, ::-1], faces)
    count, walls, start = len(flat), [], 0
    for k, ring in enumerate(rings):
        i = start + np.arange(len(ring))
        j = start + (np.arange(len(ring)) + 1) % len(ring)
        i, j = (i, j) if k == 0 else (j, i)
        walls += [np.stack([i + count, j + count, j], axis=1), np.stack([i + count, j, i], axis=1)]
        start += len(ring)
    positions = np.concatenate([np.column_stack([flat, np.full(count, z)]) for z in (0.15, -0.15)])
    tilt = np.array(((1, 0, 0), (0, 0.82, -0.57), (0, 0.57, 0.82)))
    return positions @ (tilt / np.linalg.norm(tilt, axis=1, keepdims=True)).T, np.concatenate(
        [faces, faces[:, ::-1] + count, *walls]
    )


def _ring(x: float, y: float, radius: float, count: int) -> np.ndarray:
    angle = np.arange(count) * 2 * np.pi / count
    return np.stack([x + radius * np.cos(angle), y + radius * np.sin(angle)], axis=1)


def _unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.maximum(np.linalg.norm(vectors, axis=-1, keepdims=True), 1e-300)
