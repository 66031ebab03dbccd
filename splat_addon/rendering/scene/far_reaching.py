# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles that reach thousands of times as far as they are from the eye, such as a ground to the horizon or a stray
face: float32 and the rasterizer's interpolation cannot place what is near the eye on them. Here they are cut into
pieces that are no larger than a few times their own distance, in float64, relative to the eye.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

import numpy as np

from .boxes import CORNERS
from .camera import Camera
from .convex import divided, fans, kept
from .placed import PolygonInstance
from .polygons import Polygons

#: A triangle is cut if it is longer than this many times its distance from the eye, or in a parallel view the longest
#: side of the window. Float32 then places what is near on others within 2^-17 of its distance, and shadow
#: maps are not fitted to all of them.
REACH = 128

#: Pieces end at planes around the eye whose distances are powers of this, as far as the camera sees.
_STEP = 32.0


def least_length(camera: Camera) -> float:
    """The length of the shortest triangle that may be far-reaching, world units."""
    left, right, bottom, top = camera.window
    return REACH * (max(right - left, top - bottom) if camera.is_orthographic else camera.near)


def reaching(instance: PolygonInstance, camera: Camera) -> np.ndarray:
    """(n,) numbers of the triangles of an instance that are far-reaching in a camera's view."""
    stretch, least = float(instance.stretches[0]), least_length(camera)
    rows = np.flatnonzero(instance.polygons.longest_edges * stretch > least)
    corners = _in_view(instance, camera, rows)
    lengths = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1, initial=0)
    if camera.is_orthographic:
        reach, across = _column(camera), corners[..., :2]
        is_near = ((across.min(axis=1) <= reach) & (across.max(axis=1) >= -reach)).all(axis=1)
        return rows[is_near & (lengths > least)]
    return rows[lengths > REACH * np.maximum(_distances(corners), camera.near)]


def pieces(instance: PolygonInstance, camera: Camera, rows: np.ndarray) -> Polygons:
    """The triangles of these numbers, cut for a camera's view, around an origin in that view. They are in the object's
    space, where textures and normals stay what they are, and their edges are no seams of textures."""
    shape, corners = instance.polygons, _in_view(instance, camera, rows)
    numbers = np.broadcast_to(np.arange(len(rows))[:, None, None], (len(rows), 3, 1))
    polygons = np.concatenate([corners, np.broadcast_to(np.eye(3), corners.shape), numbers], axis=2)
    for axis, distance in _planes(camera, corners):
        polygons = divided(polygons, polygons[..., axis] - distance)
    triangles = fans(polygons)
    shares, of = triangles[..., 3:6], 3 * rows[triangles[:, 0, 6].astype(np.int64)]
    middle = np.zeros(3)
    if camera.is_orthographic and len(seen := _seen(corners, camera)):
        middle = seen.mean(axis=0)
    model_view = instance.model_view(camera)
    origin = np.linalg.solve(model_view[:3, :3], middle - model_view[:3, 3])
    return Polygons(origin=shape.origin + origin, **_varied(shape, of, shares, origin))


def seen_places(instance: PolygonInstance, camera: Camera) -> np.ndarray:
    """(n, 3) places in a camera's view space whose convex hull holds what is in its view volume."""
    return _seen(_in_view(instance, camera), camera)


def box_corners(places: np.ndarray) -> np.ndarray:
    """(8, 3) corners of a box around (n, 3) places."""
    return np.where(CORNERS, places.max(axis=0), places.min(axis=0))


def seen_places_in(
    instance: PolygonInstance, camera: Camera, box: tuple[np.ndarray, np.ndarray] | None
) -> tuple[np.ndarray, np.ndarray]:
    """As `seen_places`, of what is in a box in the world, whose lowest and highest corner are given, if any; also
    (n, 3) the same places in the world."""
    triangles, rotation = _in_view(instance, camera), camera.matrix_world[:3, :3]
    for side, ends in zip((1.0, -1.0), box or (), strict=False):
        for axis in range(3):
            triangles = kept(triangles, side * (triangles @ rotation[axis] + camera.matrix_world[axis, 3] - ends[axis]))
    places = _seen(triangles, camera)
    return places, places @ rotation.T + camera.matrix_world[:3, 3]


def pressed_above(instances: Iterable[PolygonInstance], camera: Camera, depth: float) -> Polygons | None:
    """What a parallel camera would see of these if it stood farther back, pressed to one depth, in its view space; None
    for nothing."""
    triangles = np.concatenate([np.zeros((0, 3, 3)), *(_in_view(instance, camera) for instance in instances)])
    left, right, bottom, top = camera.window
    for x, y, z, at in (
        (0, 0, 1, camera.near),
        (1, 0, 0, -left),
        (-1, 0, 0, right),
        (0, 1, 0, -bottom),
        (0, -1, 0, top),
    ):
        triangles = kept(triangles, triangles @ np.array((x, y, z), np.float64) + at)
    corners = fans(triangles).reshape(-1, 3)
    if not len(corners):
        return None
    corners[:, 2], count = -depth, len(corners)
    return Polygons(corners, np.zeros((count, 3)), np.ones((count, 4)), np.zeros(count))


def highest_over(instance: PolygonInstance, frame: np.ndarray, middle: np.ndarray, half: float) -> float:
    """The highest place, along the last axis of a frame, of what is over a square across it; -inf for nothing. frame:
    (3, 3), its axes in rows."""
    shape, matrix = instance.polygons, instance.matrix_world
    places = (shape.positions.astype(np.float64) + shape.origin) @ matrix[:3, :3].T + matrix[:3, 3]
    triangles = (places @ frame.T).reshape(-1, 3, 3)
    for axis, side in ((0, 1), (0, -1), (1, 1), (1, -1)):
        triangles = kept(triangles, side * (triangles[..., axis] - middle[axis]) + half)
    return float(triangles[..., 2].max(initial=-np.inf))


def _seen(corners: np.ndarray, camera: Camera) -> np.ndarray:
    """As `seen_places`, of (T, k, 3) polygons in view space."""
    for x, y, z, at in _volume(camera):
        corners = kept(corners, corners @ (x, y, z) + at)
    return corners.reshape(-1, 3)


def _volume(camera: Camera) -> Iterator[tuple[float, float, float, float]]:
    """Planes around what a camera sees, positive inside."""
    left, right, bottom, top = camera.window
    yield from ((0.0, 0.0, -1.0, -camera.near), (0.0, 0.0, 1.0, camera.far))
    if camera.is_orthographic:
        yield from ((1.0, 0.0, 0.0, -left), (-1.0, 0.0, 0.0, right), (0.0, 1.0, 0.0, -bottom), (0.0, -1.0, 0.0, top))
    else:
        yield from ((1.0, 0.0, left, 0.0), (-1.0, 0.0, -right, 0.0), (0.0, 1.0, bottom, 0.0), (0.0, -1.0, -top, 0.0))


def _in_view(instance: PolygonInstance, camera: Camera, rows=slice(None)) -> np.ndarray:
    """(n, 3, 3) float64 triangles in a camera's view space."""
    model_view = instance.model_view(camera)
    corners = instance.polygons.positions.reshape(-1, 3, 3)[rows].astype(np.float64)
    return corners @ model_view[:3, :3].T + model_view[:3, 3]


def _column(camera: Camera) -> float:
    """Half the side of a column around the window of a parallel camera, the same for all samples of a picture."""
    return 2.0 ** math.ceil(math.log2(2 * max(map(abs, camera.window))))


def _planes(camera: Camera, corners: np.ndarray) -> Iterator[tuple[int, float]]:
    """The axis, in view space, and the distance of the planes at which triangles are cut: none lies beyond the first
    around all that the camera sees."""
    if camera.is_orthographic:
        first, last, axes = _column(camera), 0.0, 2
    else:
        nearest = max(float(_distances(corners).min()), camera.near)
        first, axes = _STEP ** math.ceil(math.log(2 * nearest, _STEP)), 3
        last = camera.far * max(1.0, *map(abs, camera.window))
    for axis in range(axes):
        low, high = float(corners[..., axis].min()), float(corners[..., axis].max())
        distance, before = first, 0.0
        while distance < max(-low, high) and before <= last:
            yield from ((axis, at) for at in (-distance, distance) if low < at < high)
            distance, before = distance * _STEP, distance


def _distances(corners: np.ndarray) -> np.ndarray:
    """(n,) of (n, 3, 3) triangles from 0."""
    edges = np.roll(corners, -1, axis=1) - corners
    squares = np.maximum(np.sum(edges * edges, axis=2), 1e-300)
    along = np.clip(-np.sum(corners * edges, axis=2) / squares, 0, 1)
    found = np.linalg.norm(corners + along[..., None] * edges, axis=2).min(axis=1)
    normal = np.cross(edges[:, 0], edges[:, 1])
    area = np.linalg.norm(normal, axis=1)
    # whether the eye's foot on the plane is on the inner side of all edges
    inward = np.einsum("nkc,nkc->nk", np.cross(normal[:, None], edges), -corners)
    above = np.abs(np.sum(normal * corners[:, 0], axis=1)) / np.maximum(area, 1e-300)
    return np.where((inward >= 0).all(axis=1) & (area > 0), np.minimum(above, found), found)


def _varied(shape: Polygons, of: np.ndarray, shares: np.ndarray, origin: np.ndarray) -> dict:
    """The fields of pieces but their origin. of: (n,) first corner of each one's triangle. shares: (n, 3, 3) of that
    triangle's corners in those of the piece."""
    rows = of[:, None] + np.arange(3)

    def mixed(values: np.ndarray) -> np.ndarray:
        flat = values[rows].astype(np.float64).reshape(len(rows), 3, math.prod(values.shape[1:]))
        return np.einsum("nks,nsc->nkc", shares, flat).reshape(-1, *values.shape[1:])

    names = ("normals", "colors", "roughness", "metallic", "emission", "uvs", "bumps", "glosses")
    fields = {name: mixed(values) for name in names if (values := getattr(shape, name)) is not None}
    if shape.bumps is not None:
        fields["bumps"][:, 5] = np.repeat(shape.bumps[of, 5], 3)
    places = np.einsum("nks,nsc->nkc", shares, shape.positions[rows].astype(np.float64) - origin)
    return {"positions": places.reshape(-1, 3), "materials": np.repeat(shape.materials[of], 3), **fields}
