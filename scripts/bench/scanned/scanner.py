# SPDX-License-Identifier: GPL-3.0-or-later
"""A simulated laser scanner: rays on a spherical grid from several places meet a mesh, with noise, strays and
occlusion."""

from __future__ import annotations

from dataclasses import dataclass

import bpy  # noqa: F401 - mathutils comes with it
import numpy as np
from mathutils import Vector
from mathutils.bvhtree import BVHTree
from scipy.spatial import cKDTree

from splat_addon.sampling import TriangleMesh

#: Directions from the model's middle to the scanner's places, and their distance in half diagonals.
PLACES = np.array([(2, 1, 1.2), (-1.5, 2, 0.4), (-1, -2, 1.5), (1.6, -1.2, -0.8), (-2, 0.3, -1.4), (0.3, 0.5, 2)])
DISTANCE = 2.5

#: Rays of the first grid, which only tells how many of them meet the model.
_FEW = 4_000

#: Strays within this many standard deviations of noise from the surface are no strays.
_DEVIATIONS = 3.0


@dataclass(frozen=True, eq=False)
class Scan:
    """points, scanners: (N, 3) float64. normals: (N, 3) the mesh's at the hits, on the scanner's side; NaN for strays.
    is_stray: (N,) bool; is_near: (N,) strays that lie within the noise of the surface, which nobody could tell.
    nearest: (N, 3) the mesh's normals at its places nearest to the points, on the scanner's side; NaN for strays.
    seen: tree of the hits without noise. spacing: the edge of a square with the mean area per point.
    """

    points: np.ndarray
    scanners: np.ndarray
    normals: np.ndarray
    is_stray: np.ndarray
    is_near: np.ndarray
    nearest: np.ndarray
    seen: cKDTree
    spacing: float


def scanned(mesh: TriangleMesh, count: int, noise: float, strays: float) -> Scan:
    """About `count` points in random order. noise: standard deviation along each axis, in spacings. strays: their
    share, spread evenly over the mesh's box, grown by a tenth at each side."""
    random = np.random.default_rng(0)
    tree = BVHTree.FromPolygons(mesh.positions.tolist(), mesh.triangles.tolist())
    low, high = mesh.bounds()
    middle, reach = (low + high) / 2, float(np.linalg.norm(high - low)) / 2
    places = middle + DISTANCE * reach * PLACES / np.linalg.norm(PLACES, axis=1, keepdims=True)
    shares = [len(_hits(tree, place, middle, reach, _FEW)[1]) / _FEW for place in places]
    rays = count / sum(shares)
    found = [_hits(tree, place, middle, reach, rays) for place in places]
    hits, faces = (np.concatenate(parts) for parts in zip(*found, strict=True))
    scanners = np.repeat(places, [len(faces) for _, faces in found], axis=0)
    normals = _towards(_normals(mesh, hits, faces), scanners - hits)
    corners = mesh.positions[mesh.triangles]
    area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).sum() / 2
    spacing = float(np.sqrt(area / len(hits)))
    stray = random.uniform(low - 0.1 * (high - low), high + 0.1 * (high - low), (int(strays * len(hits)), 3))
    near = np.array([tree.find_nearest(place)[3] for place in stray.tolist()]) < _DEVIATIONS * noise * spacing
    noisy = hits + noise * spacing * random.normal(size=hits.shape)
    points = np.concatenate([noisy, stray])
    order, is_stray = random.permutation(len(points)), np.arange(len(points)) >= len(hits)
    return Scan(
        points[order],
        np.concatenate([scanners, places[random.integers(len(places), size=len(stray))]])[order],
        np.concatenate([normals, np.full(stray.shape, np.nan)])[order],
        is_stray[order],
        np.concatenate([np.zeros(len(hits), bool), near.reshape(-1)])[order],
        np.concatenate([_nearest_normals(mesh, tree, noisy, scanners), np.full(stray.shape, np.nan)])[order],
        cKDTree(hits),
        spacing,
    )


def _nearest_normals(mesh: TriangleMesh, tree, points, scanners) -> np.ndarray:
    found = [tree.find_nearest(point) for point in points.tolist()]
    places, faces = np.array([place[:] for place, *_ in found]), np.array([face for _, _, face, _ in found])
    return _towards(_normals(mesh, places, faces), scanners - points)


def _towards(normals: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """(n, 3) normals, turned to where (n, 3) directions point."""
    return normals * np.where(np.einsum("ij,ij->i", normals, directions) < 0, -1, 1)[:, None]


def _hits(tree, place, middle, reach, rays) -> tuple[np.ndarray, np.ndarray]:
    """(n, 3) first hits of about `rays` rays from a place, and (n,) the triangles. The grid of equal angles is as wide
    as the ball around the model. The back of a triangle returns nothing, so that no sheet is seen from both sides."""
    towards = middle - place
    azimuth, height = np.arctan2(towards[1], towards[0]), np.arcsin(towards[2] / np.linalg.norm(towards))
    half = np.arcsin(reach / np.linalg.norm(towards))
    steps = np.linspace(-half, half, max(int(np.sqrt(rays)), 2))
    up, around = np.meshgrid(height + steps, azimuth + steps / np.cos(height), indexing="ij")
    directions = np.stack([np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up)], axis=-1)
    directions = directions.reshape(-1, 3).tolist()
    found = [tree.ray_cast(place.tolist(), direction) for direction in directions]
    cosines = (hit[1] and hit[1].dot(direction) for hit, direction in zip(found, map(Vector, directions), strict=True))
    found = [
        (hit[0][:], hit[2]) for hit, cosine in zip(found, cosines, strict=True) if cosine is not None and cosine < 0
    ]
    return np.array([hit for hit, _ in found]).reshape(-1, 3), np.array([face for _, face in found], np.int64)


def _normals(mesh: TriangleMesh, hits: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """(n, 3) unit normals of the mesh, interpolated between a triangle's corners."""
    a, b, c = (mesh.positions[mesh.triangles[faces, k]] for k in range(3))
    ab, ac, away = b - a, c - a, hits - a
    flat = np.cross(ab, ac)
    square = np.maximum(np.einsum("ij,ij->i", flat, flat), 1e-300)
    v = np.einsum("ij,ij->i", np.cross(away, ac), flat) / square
    w = np.einsum("ij,ij->i", np.cross(ab, away), flat) / square
    weights = np.clip(np.stack([1 - v - w, v, w], axis=1), 0, 1)
    normals = np.einsum("nk,nkc->nc", weights, mesh.corner_normals[faces])
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
