# SPDX-License-Identifier: GPL-3.0-or-later
"""Shadows by definition: a ray from every visible point to its light is tested against every splat, in float64.

Points are lit where they are: lifts (`Surfels.lift`), which the renderer adds at terminators, are ignored.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ..rendering.scene import Scene
from ..rendering.scene.camera import Camera
from ..rendering.scene.light import Light
from .polygons import are_lit
from .splats import Splats, eye_splats

#: Pairs of a ray and a splat per batch.
CHUNK_PAIRS = 50_000

#: Points on a lamp over which soft shadows are averaged.
LAMP_POINTS = 25

#: Last fraction of the way from a lamp in which a polygon casts no shadow, so that it does not shadow itself.
OWN_SURFACE = 1e-9

#: shaders/features/shadows.glsl: the turn of an edge, radians, beyond which splats that reach over it cast no shadow,
#: and how far they are moved back at most, in epsilons.
BEND = math.radians(30)
FARTHEST_BACK = 4.0

#: Distance of a sun, in units of the scene's extent.
FAR_AWAY = 1e4


def lit_share(light: Light, scene: Scene, camera: Camera, position: np.ndarray, epsilon: float) -> np.ndarray:
    """(n,) the share of the lamp that is visible from positions (n, 3) in eye space.

    A splat hides the places that lie farther behind it, as seen from the light, than it is moved back: epsilon, in its
    radii, behind a plane that is turned away from the light by BEND more than its own.
    """
    # Splats are wanted from the light's side: solid instances hide backs by the camera, so they count in full here.
    casters = casting(scene)
    splats = eye_splats(_without_solids(casters), camera)
    if not casters.shown:
        return np.ones(len(position))
    extent = float(np.abs(np.concatenate([splats.center, position])).max())
    lamp = _lamp(light, camera, position, extent)
    return np.mean([_is_lit(casters, camera, splats, epsilon, place, position) for place in lamp], axis=0)


def _is_lit(casters: Scene, camera: Camera, splats: Splats, epsilon: float, lamp: np.ndarray, position: np.ndarray):
    """(n,) bool: whether light reaches each position."""
    lit = are_lit(casters, camera, lamp, position, OWN_SURFACE)
    return lit & _is_seen(splats, epsilon * _moved(splats, lamp[0]), lamp, position) if len(splats) else lit


def _moved(splats: Splats, lamp: np.ndarray) -> np.ndarray:
    """(N,) how far splats are moved away from the lamp, in units of epsilon."""
    way = splats.center - lamp
    with np.errstate(divide="ignore", invalid="ignore"):
        cosine = np.abs(np.einsum("ij,ij->i", splats.plane, way))
        cosine /= np.linalg.norm(splats.plane, axis=1) * np.linalg.norm(way, axis=1)
    facing = np.nan_to_num(np.minimum(cosine, 1.0))
    turned = np.cos(np.arccos(facing) + BEND)
    return splats.grain() / np.maximum(turned, 1 / FARTHEST_BACK)


def casting(scene: Scene) -> Scene:
    """The scene with only the instances that cast shadows."""
    of = {name: (i for i in getattr(scene, name) if i.casts_shadow) for name in ("surfels", "polygons")}
    kinds = {name: tuple(i if i.is_seen else replace(i, is_seen=True) for i in some) for name, some in of.items()}
    return replace(scene, **kinds, lights=())


def _without_solids(scene: Scene) -> Scene:
    loose = (replace(i, shape=replace(i.surfels, is_solid=False, hidden_back=None)) for i in scene.surfels)
    return replace(scene, surfels=tuple(loose))


def _lamp(light: Light, camera: Camera, position: np.ndarray, extent: float) -> np.ndarray:
    """(k, 1 or n, 3) points on the lamp, spaced by the golden angle over a disc that faces the positions it lights."""
    rotation = camera.matrix_world[:3, :3].T
    axis = rotation @ np.asarray(light.direction, np.float64)
    axis /= np.linalg.norm(axis)
    if light.kind == "sun":
        middle, radius = -axis * FAR_AWAY * extent, math.tan(light.size / 2) * FAR_AWAY * extent
    else:
        middle, radius = rotation @ (np.asarray(light.position, np.float64) - camera.matrix_world[:3, 3]), light.size
    if not light.is_sized:
        return middle[None, None]
    k = np.arange(LAMP_POINTS)
    r, turn = np.sqrt((k + 0.5) / LAMP_POINTS), k * math.pi * (3 - math.sqrt(5))
    disc = np.stack([r * np.cos(turn), r * np.sin(turn)], axis=1)
    if light.kind == "area":
        u, v = np.asarray(light.half_axes, np.float64) @ rotation.T
        if not light.is_round:
            side = math.isqrt(LAMP_POINTS)
            ticks = (np.arange(side) + 0.5) / side * 2 - 1
            disc = np.stack(np.meshgrid(ticks, ticks), axis=2).reshape(-1, 2)
        return (middle + disc @ np.stack([u, v]))[:, None]
    toward = middle - position.mean(axis=0)
    side = np.cross(toward, (0.3, 0.8, 0.5))
    side /= np.linalg.norm(side)
    other = np.cross(toward, side) / np.linalg.norm(toward)
    return (middle + radius * disc @ np.stack([side, other]))[:, None]


def _is_seen(splats: Splats, moved: np.ndarray, lamp: np.ndarray, position: np.ndarray) -> np.ndarray:
    """(n,) bool: whether no splat hides the lamp's point. moved: (N,) distance that each splat is moved away
    from the lamp. lamp: (1, 3).
    """
    rows = max(CHUNK_PAIRS // len(splats), 1)
    parts = np.split(position, range(rows, len(position), rows))
    return np.concatenate([_part_is_seen(splats, moved, lamp[0], part) for part in parts])


def _part_is_seen(splats: Splats, moved: np.ndarray, lamp: np.ndarray, position: np.ndarray) -> np.ndarray:
    ray = position - lamp
    length = np.linalg.norm(ray, axis=1)
    square = np.einsum("ij,ij->i", splats.plane, splats.plane)[:, None]
    dual_u, dual_v = np.cross(splats.v, splats.plane) / square, np.cross(splats.plane, splats.u) / square
    to_center = splats.center - lamp
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        share = np.einsum("ij,ij->i", splats.plane, to_center) / (ray @ splats.plane.T)
        a = share * (ray @ dual_u.T) - np.einsum("ij,ij->i", dual_u, to_center)
        b = share * (ray @ dual_v.T) - np.einsum("ij,ij->i", dual_v, to_center)
        hit = (a * a + b * b <= 1) & (share > 0)
        if splats.is_clipped:
            inside = [splats.clip[:, k, 0] * a + splats.clip[:, k, 1] * b + splats.clip[:, k, 2] >= 0 for k in (0, 1)]
            hit &= np.where(splats.reflex, inside[0] | inside[1], inside[0] & inside[1])
        distance = share * length[:, None] + moved
    return ~(hit & (distance < length[:, None])).any(axis=1)
