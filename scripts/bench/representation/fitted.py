# SPDX-License-Identifier: GPL-3.0-or-later
"""Shading normals, and how they change over surfels, fitted by least squares to what is seen of the mesh.

A pixel shows the mean of the normals of all splats over it, so that a fit to the mesh within each surfel alone is not
the best one. Here parallel rays from 14 sides meet surfels, which the reference weighs, and the mesh, and the means are
fitted to the mesh's normals for all surfels at once. Rays whose error is large, as beside creases, count little.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from scipy.sparse import csr_matrix, diags, hstack
from scipy.sparse.linalg import lsqr

from splat_addon.normal_fields import changes, fields_of, share_of
from splat_addon.quaternions import axes_columns
from splat_addon.reference.rays import RayGrid, _hits, _seen, splats_in, visible_depth
from splat_addon.reference.splats import eye_splats, projected_bounds
from splat_addon.reference.triangles import render_triangles
from splat_addon.rendering import Camera, Instance, Scene, Settings, look_at
from splat_addon.sampling import TriangleMesh
from splat_addon.surfels import Surfels

#: Rays across a surfel's spacing, from the middles and the corners of a cube.
RAYS = 3
SIDES = [
    np.array(side) / np.linalg.norm(side) for side in product((-1, 0, 1), repeat=3) if np.abs(side).sum() in (1, 3)
]
#: The least cosine between a ray and the normal that it meets.
LEAST_COSINE = 0.3
#: How much the values before the fit count, and the error of a ray that counts by half.
DAMPING, LARGE_ERROR = 0.1, 0.3
#: Solutions one after another: what a splat's normal is divided by depends on its change.
STEPS = 2


@dataclass(frozen=True, eq=False)
class Seen:
    """What rays see. ray, surfel: (m,) numbers of the pairs that meet. weight: (m,) of these, below 0 for a surfel
    that is seen from behind. place: (m, 2) in half-axes. normal: (n, 3) unit, of the mesh at each ray."""

    ray: np.ndarray
    surfel: np.ndarray
    weight: np.ndarray
    place: np.ndarray
    normal: np.ndarray


def seen_by_rays(surfels: Surfels, mesh: TriangleMesh) -> Seen:
    low, high = mesh.bounds()
    middle, diagonal = (low + high) / 2, float(np.linalg.norm(high - low))
    size = int(np.ceil(RAYS * diagonal / np.median(surfels.scales.min(axis=1))))
    # A surfel's number is its colour, which float32 keeps.
    numbers = np.zeros((len(surfels), 4), np.float32)
    numbers[:, 0], numbers[:, 3] = np.arange(len(surfels)), 1
    scene, parts, first = Scene((Instance(replace(surfels, colors=numbers)),)), [], 0
    for side in SIDES:
        pose = look_at(middle + diagonal * side, middle, (0, 1, 0) if abs(side[1]) < 0.9 else (0, 0, 1))
        camera = Camera.orthographic(pose, diagonal, (size, size), diagonal / 100, diagonal * 3)
        found = _from_one_side(scene, surfels, mesh, camera)
        parts.append(replace(found, ray=found.ray + first))
        first += len(found.normal)
    return Seen(*(np.concatenate([getattr(part, name) for part in parts]) for name in Seen.__annotations__))


def _from_one_side(scene: Scene, surfels: Surfels, mesh: TriangleMesh, camera: Camera) -> Seen:
    splats = eye_splats(scene, camera)
    grid = RayGrid.of_pixels(camera, 1, 0, 0, *camera.size)
    splats, boxes = splats_in(splats, projected_bounds(splats, camera), grid)
    number, turn = np.rint(splats.color[:, 0]).astype(int), camera.matrix_world[:3, :3]
    side = np.sign(np.einsum("ij,ij->i", surfels.normals[number] @ turn, splats.normal))
    visible = visible_depth(splats, boxes, grid, Settings.epsilon)
    ray, splat, weight, _, place = map(np.concatenate, zip(*_seen(splats, grid, _hits(splats, boxes, grid), visible)))
    corners = mesh.positions[mesh.triangles], mesh.corner_normals
    true = render_triangles(*corners, camera, samples=1, pixel_filter="box")
    normal, is_hit = true.color.reshape(-1, 3), true.coverage.ravel() > 0.5
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    is_used = (is_hit & (normal @ turn[:, 2] > LEAST_COSINE))[ray]
    rays, place_of = np.unique(ray[is_used], return_inverse=True)
    splat = splat[is_used]
    return Seen(place_of, number[splat], weight[is_used] * side[splat], place[is_used], normal[rays])


def fitted(surfels: Surfels, seen: Seen, with_changes: bool) -> Surfels:
    """The surfels with fitted normals, and changes of these, too."""
    share, axes = share_of(False), axes_columns(surfels.rotations.astype(np.float64), 0, 1, 2)
    own = surfels.normals.astype(np.float64)
    values = [own, *(share * along.T for along in changes(surfels.arrays(), axes))]
    factors = np.ones(len(seen.ray)), *seen.place.T
    shape = len(seen.normal), len(surfels)
    for _ in range(STEPS):
        each = sum(f[:, None] * value[seen.surfel] for f, value in zip(factors, values, strict=True))
        weight = seen.weight / np.linalg.norm(each, axis=1)
        sums = np.stack([np.bincount(seen.ray, weight * part, shape[0]) for part in each.T], axis=1)
        length = np.maximum(np.linalg.norm(sums, axis=1), 1e-9)
        error = seen.normal - sums / length[:, None]
        rows = [csr_matrix((weight / length[seen.ray] * f, (seen.ray, seen.surfel)), shape) for f in factors]
        counts = 1 / (1 + (np.linalg.norm(error, axis=1) / LARGE_ERROR) ** 2)
        chosen = rows if with_changes else rows[:1]
        system, damping = diags(counts) @ hstack(chosen), DAMPING * np.sqrt(shape[0] / shape[1])
        more = [lsqr(system, counts * part, damp=damping, iter_lim=40)[0] for part in error.T]
        more = np.stack(more, axis=1).reshape(len(chosen), -1, 3)
        values = [value + more[k] if k < len(chosen) else value for k, value in enumerate(values)]
        length = np.linalg.norm(values[0], axis=1, keepdims=True)
        values = [value / length for value in values]
    normals, *along = values
    fields = fields_of(normals.T, tuple(change.T / share for change in along), axes) if with_changes else {}
    return replace(surfels, normals=normals.astype(np.float32), **fields)
