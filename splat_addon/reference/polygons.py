# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons by definition: every ray against every triangle, joined with what the ray sees of splats, in float64."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from ..rendering.scene import PolygonInstance, Scene, SurfaceTexture
from ..rendering.scene.camera import Camera
from ..rendering.scene.finish import PLAIN
from .rays import RayGrid, Surface
from .splats import BACK_WEIGHT, has_finish, material_table
from .textures import point_colors

#: The least weight of a front, the least cosine between normals of one surface: shaders/hosts/mean_surface.glsl.
LEAST_FRONT = 0.02
SAME_SURFACE = 0.7

#: Pairs of a ray and a triangle per batch, few enough to stay in the processor's cache.
CHUNK_PAIRS = 50_000


@dataclass(frozen=True, eq=False)
class Hits:
    """The nearest polygon of each of n rays: depth (n,), infinite where there is none; how far behind it splats of its
    surface may lie (n,); color (n, 3), unit normal (n, 3) on the side that is seen, and (n, 10 + F) as
    `Splats.surface`."""

    depth: np.ndarray
    overlap: np.ndarray
    color: np.ndarray
    normal: np.ndarray
    surface: np.ndarray


def polygon_hits(scene: Scene, camera: Camera, grid: RayGrid, epsilon: float, epsilon_length: float = 0.0) -> Hits:
    """The nearest polygon of each of the grid's rays, ignoring splats."""
    origin, direction = grid.rays(np.arange(grid.count))
    n = grid.count
    columns = 10 + len(PLAIN.numbers) * has_finish(scene)
    found = Hits(np.full(n, np.inf), np.zeros(n), np.zeros((n, 3)), np.zeros((n, 3)), np.zeros((n, columns)))
    radii = dict(zip(scene.table.placed, scene.table.overlaps, strict=True))
    for instance in (one for one in scene.polygons if one.is_seen):
        corners = eye_corners(instance, camera)
        depth, triangle, shares = whole_hits(instance, corners, origin, direction, camera.near, camera.far)
        rays = np.flatnonzero(depth < found.depth)
        if len(rays):
            found.depth[rays] = depth[rays]
            grain = radii.get(instance, 0.0)
            found.overlap[rays] = epsilon * grain + epsilon_length * (grain > 0)
            _take(instance, camera, corners, rays, triangle[rays], shares[rays], direction[rays], found)
    return found


def eye_corners(instance: PolygonInstance, camera: Camera) -> np.ndarray:
    """(T, 3, 3) float64: triangle, corner, place in the camera's eye space."""
    model_view = instance.model_view(camera)
    positions = instance.polygons.positions.astype(np.float64)
    return (positions @ model_view[:3, :3].T + model_view[:3, 3]).reshape(-1, 3, 3)


def whole_hits(instance: PolygonInstance, corners, origin, direction, near: float, far: float):
    """The hits of `nearest_hits` without those in holes: a ray passes a texture if its own threshold exceeds the alpha
    there.

    Thresholds of the first surface that a ray meets are multiples of the golden ratio, and so spread evenly over
    neighbouring rays; those of surfaces behind it are multiples of others, so that what passes several is the product.
    """
    depth, triangle, shares = nearest_hits(corners, origin, direction, near, far)
    ratio, random, rays = 0.6180339887498949, np.random.default_rng(0), np.flatnonzero(np.isfinite(depth))
    while instance.is_cut_out and len(rays):
        rays = rays[_alphas(instance, triangle[rays], shares[rays]) <= rays * ratio % 1]
        beyond = depth[rays] * (1 + 1e-9)
        found = nearest_hits(corners, origin[rays], direction[rays], beyond, far)
        depth[rays], triangle[rays], shares[rays] = found
        rays, ratio = rays[np.isfinite(found[0])], random.random()
    return depth, triangle, shares


def _bent(instance: PolygonInstance, triangle, shares, normal_matrix, side) -> np.ndarray:
    """(n, 3) unit normals with normal maps applied, in eye space, on the side (n,) that is seen."""
    shape, rows = instance.polygons, 3 * triangle[:, None] + np.arange(3)
    normals, bumps = (np.einsum("rk,rkc->rc", shares, a.astype(np.float64)[rows]) for a in (shape.normals, shape.bumps))
    slots = np.minimum(shape.materials[rows[:, 0]], len(instance.normal_maps) - 1)
    of_slot = np.array([*instance.normal_maps, None], object)[slots]
    for bump in set(of_slot) - {None}:
        at = of_slot == bump
        detail = 2 * point_colors(SurfaceTexture(bump.image), bumps[at, :2])[:, :3] - 1
        across = bumps[at, 5:] * np.cross(normals[at], bumps[at, 2:5])
        frame = bump.strength * detail[:, :1] * bumps[at, 2:5] + bump.strength * detail[:, 1:2] * across
        upright = 1 + (detail[:, 2:] - 1) * min(bump.strength, 1)
        is_framed = (bumps[at, 2:5] != 0).any(axis=1, keepdims=True)
        normals[at] = np.where(is_framed, frame + upright * normals[at], normals[at])
    normals = normals @ normal_matrix * side[:, None]
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def _gloss(instance: PolygonInstance, triangle, shares, surface: np.ndarray) -> None:
    """Fill in the roughness and metallic, the first columns of (n, columns), that images have at hits."""
    rows = 3 * triangle[:, None] + np.arange(3)
    uvs = np.einsum("rk,rkc->rc", shares, instance.polygons.glosses.astype(np.float64)[rows])
    slots = np.minimum(instance.polygons.materials[rows[:, 0]], len(instance.gloss_maps) - 1)
    of_slot = np.array([*instance.gloss_maps, None], object)[slots]
    for gloss in set(of_slot) - {None}:
        at = of_slot == gloss
        found = point_colors(SurfaceTexture(gloss.image), uvs[at])
        for column, factor in enumerate((gloss.roughness, gloss.metallic)):
            if factor is not None:
                surface[at, column] = np.clip(factor * found[:, column], 0, 1)


def _alphas(instance: PolygonInstance, triangle: np.ndarray, shares: np.ndarray) -> np.ndarray:
    """(n,) alpha of the texture at hits, 1 for textures that cut no holes."""
    alphas = np.ones(len(triangle))
    for texture, at, uvs in _texture_places(instance, triangle, shares):
        if texture.is_cut_out:
            alphas[at] = point_colors(texture, uvs)[:, 3]
    return alphas


def _texture_places(instance: PolygonInstance, triangle: np.ndarray, shares: np.ndarray):
    """For each texture: itself, a mask of the hits that show it, and their (m, 2) coordinates."""
    if not instance.is_textured:
        return
    rows = 3 * triangle[:, None] + np.arange(3)
    uvs = np.einsum("rk,rkc->rc", shares, instance.polygons.uvs.astype(np.float64)[rows])
    slots = np.minimum(instance.polygons.materials[rows[:, 0]], len(instance.textures) - 1)
    of_slot = np.array([*instance.textures, None], object)[slots]
    for texture in set(of_slot) - {None}:
        at = of_slot == texture
        yield texture, at, uvs[at]


def nearest_hits(corners: np.ndarray, origin: np.ndarray, direction: np.ndarray, near, far: float):
    """(n,) parameters along the rays, infinite for a miss, (n,) triangles, (n, 3) shares of their corners.

    near: least parameter, (n,) or one number.

    Moeller, Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997, for the pairs that may meet.
    """
    n = len(direction)
    depth, triangle, shares = np.full(n, np.inf), np.zeros(n, int), np.zeros((n, 3))
    near = np.broadcast_to(near, n)
    a, along, beside = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    for part in np.array_split(np.arange(n), max(n * len(corners) // CHUNK_PAIRS, 1)):
        rows, met = _may_meet(a, along, beside, origin[part], direction[part])
        rays = part[rows]
        ray, start = direction[rays], origin[rays] - a[met]
        with np.errstate(divide="ignore", invalid="ignore"):
            p, q = np.cross(ray, beside[met]), np.cross(start, along[met])
            scale = 1 / np.einsum("mk,mk->m", p, along[met])
            u, v = np.einsum("mk,mk->m", start, p) * scale, np.einsum("mk,mk->m", ray, q) * scale
            t = np.einsum("mk,mk->m", q, beside[met]) * scale
            hit = np.flatnonzero((u >= 0) & (v >= 0) & (u + v <= 1) & (t >= near[rays]) & (t <= far))
        np.minimum.at(depth, rays[hit], t[hit])
        # If triangles have equal depth, the first is used: it is written last.
        nearest = hit[t[hit] == depth[rays[hit]]][::-1]
        triangle[rays[nearest]] = met[nearest]
        shares[rays[nearest]] = np.stack([1 - u - v, u, v], axis=1)[nearest]
    return depth, triangle, shares


def _may_meet(a, along, beside, origin, direction) -> tuple[np.ndarray, np.ndarray]:
    """Rows of rays and triangles that intersect, or miss only within rounding.

    Each side of the triangle is linear in the ray's direction and moment (its Pluecker coordinates), so all pairs are
    three products of matrices.
    """
    line = np.concatenate([direction, np.cross(origin, direction)], axis=1)
    facing = -direction @ np.cross(along, beside).T
    side = np.sign(facing)
    u = line @ np.concatenate([np.cross(a, beside), beside], axis=1).T * side
    v = line @ np.concatenate([np.cross(along, a), -along], axis=1).T * side
    reach = max(np.abs(corners).max(initial=0.0) for corners in (along, beside))
    slack = 1e-9 * np.abs(line).max(initial=0.0) * max(np.abs(a).max(initial=0.0), 1.0) * reach
    return np.nonzero((u >= -slack) & (v >= -slack) & (u + v <= side * facing + slack))


def _take(instance, camera, corners, rays, triangle, shares, direction, found: Hits):
    shape, normal_matrix = instance.polygons, np.linalg.inv(instance.model_view(camera)[:3, :3])
    rows = 3 * triangle[:, None] + np.arange(3)

    def mean(values):
        return np.einsum("rk,rk...->r...", shares, values.astype(np.float64)[rows])

    places = corners[triangle]
    outward = np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0])
    outward *= np.sign(np.linalg.det(normal_matrix))
    toward = np.where(camera.is_orthographic, (0.0, 0.0, 1.0), -places[:, 0])
    side = np.where(np.einsum("rk,rk->r", outward, toward) < 0, -1.0, 1.0)
    corner_normals = shape.normals.astype(np.float64) @ normal_matrix
    corner_normals /= np.linalg.norm(corner_normals, axis=1, keepdims=True)
    normal = mean(corner_normals)
    found.normal[rays] = normal / np.linalg.norm(normal, axis=1, keepdims=True) * side[:, None]
    found.color[rays] = mean(shape.colors)[:, :3]
    slots = np.minimum(shape.materials[rows[:, 0]], len(instance.materials) - 1)
    if instance.is_bumped:
        found.normal[rays] = _bent(instance, triangle, shares, normal_matrix, side)
    for texture, at, uvs in _texture_places(instance, triangle, shares):
        found.color[rays[at]] = point_colors(texture, uvs)[:, :3]
    surface = material_table(instance, found.surface.shape[1] > 10)[slots]
    for columns, own in ((0, shape.roughness), (1, shape.metallic), (slice(3, 6), shape.emission)):
        if own is not None:
            surface[:, columns] = mean(own)
    if instance.is_glossed:
        _gloss(instance, triangle, shares, surface)
    found.surface[rays] = surface


def joined(splats: Surface, polygons: Hits, contact: float, same_surface: float = SAME_SURFACE) -> Surface:
    """Guennebaud et al. 2006, section 5.1: where both are of one surface, the sum of weights, up to 1, blends them.

    contact: how deep a polygon may lie behind splats of its surface. same_surface: minimum cosine between the normals
    of both; as printed none.
    """
    count = len(polygons.depth)
    weight, share = np.zeros(count), np.where(np.isfinite(polygons.depth), 1.0, 0.0)
    weight[splats.rays] = splats.weight
    at = splats.rays[np.isfinite(polygons.depth[splats.rays])]
    row = np.searchsorted(splats.rays, at)
    behind = polygons.depth[at] - splats.depth[row]
    front = np.where(splats.weight[row] < LEAST_FRONT, splats.weight[row] / BACK_WEIGHT, splats.weight[row])
    is_same = np.einsum("rk,rk->r", polygons.normal[at], splats.normal[row]) > same_surface
    blended = np.where((behind < 0) & ~is_same, 1.0, 1 - np.minimum(front, 1))
    share[at] = np.where(behind > contact, 0.0, blended)
    rays = np.flatnonzero((weight > 0) | (share > 0))
    values = {
        f.name: np.zeros((count, *getattr(splats, f.name).shape[1:])) for f in fields(Surface) if f.name != "rays"
    }
    for name, whole in values.items():
        whole[splats.rays] = getattr(splats, name)
    of_polygon = {
        "color": polygons.color, "normal": polygons.normal, "depth": np.where(share > 0, polygons.depth, 0.0),
        "roughness": polygons.surface[:, 0], "metallic": polygons.surface[:, 1], "f0": polygons.surface[:, 2],
        "emission": polygons.surface[:, 3:6], "light_set": polygons.surface[:, 6:10],
        "finish": polygons.surface[:, 10:],
    }  # fmt: skip
    for name, other in of_polygon.items():
        s = share.reshape(-1, *(1,) * (other.ndim - 1))
        values[name] = (1 - s) * values[name] + s * other
    length = np.linalg.norm(values["normal"], axis=1, keepdims=True)
    values["normal"] = values["normal"] / np.maximum(length, 1e-30)
    return Surface(rays, **{name: whole[rays] for name, whole in values.items()})


def contact(scene: Scene, epsilon: float) -> float:
    """Maximum depth of polygons behind splats of the same surface, world units; as `View.contact`."""
    return (1 + 4 * epsilon) * float(scene.table.overlaps.max(initial=0.0))


def are_lit(scene: Scene, camera: Camera, lamp: np.ndarray, position: np.ndarray, room: float) -> np.ndarray:
    """(n,) bool: no polygon that casts shadows lies between the lamp (1 or n, 3) and positions (n, 3) of the eye space.

    room: share of the way, at its end, that hides nothing.
    """
    lit = np.ones(len(position), bool)
    for instance in scene.polygons:
        corners = eye_corners(instance, camera)
        start = np.broadcast_to(lamp, position.shape)
        lit &= ~np.isfinite(whole_hits(instance, corners, start, position - start, 0.0, 1 - room)[0])
    return lit
