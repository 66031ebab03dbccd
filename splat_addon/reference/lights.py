# SPDX-License-Identifier: GPL-3.0-or-later
"""The light that reaches points, by definition and in float64; the twin of shaders/hosts/lights.glsl.

A light with a size is a square of its area; a round one faces the place that it lights, as
Cycles takes a disc there. Blender's manual has the units;
a spot's rim is Cycles' smooth step between two cosines.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ..rendering.scene import Scene
from ..rendering.scene.camera import Camera
from ..rendering.scene.light import MAX_SUN_HALF_ANGLE, Light
from .brdf import unit
from .shadows import lit_share

#: Below this ratio of half-side to distance, a light is treated as a point.
LEAST_SIZE = 2e-3


@dataclass(frozen=True, eq=False)
class Incident:
    """Light that reaches n points. to_light: (n, 3) unit. irradiance: (n, 3) of surfaces that face it.

    is_sized: (n,) bool. For those, corners: (n, 4, 3) relative to the points, and radiance: (n, 3).
    """

    to_light: np.ndarray
    irradiance: np.ndarray
    is_sized: np.ndarray
    corners: np.ndarray
    radiance: np.ndarray

    def times(self, share: np.ndarray) -> Incident:
        """The same light, reduced to that share (n,)."""
        dimmed = {name: getattr(self, name) * share[:, None] for name in ("irradiance", "radiance")}
        return replace(self, **dimmed)


def incident(light: Light, camera: Camera, position: np.ndarray) -> Incident:
    """The light from one lamp at positions (n, 3) in the camera's eye space."""
    rotation = camera.matrix_world[:3, :3].T
    axis = rotation @ np.asarray(light.direction, np.float64)
    axis /= np.linalg.norm(axis)
    if light.kind == "sun":
        middle = np.broadcast_to(-axis, position.shape)
    else:
        middle = rotation @ (np.asarray(light.position, np.float64) - camera.matrix_world[:3, 3]) - position
    distance = np.maximum(np.linalg.norm(middle, axis=1), 1e-150)
    to_light = middle / distance[:, None]
    strength, half_u, half_v, radiance = _SHAPES[light.kind](light, rotation, axis, to_light, distance)
    color = np.asarray(light.color, np.float64)
    size = light.area**0.5 / 2 if light.kind == "area" else np.linalg.norm(half_u, axis=1)
    corners = np.stack([middle + i * half_u + j * half_v for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))], axis=1)
    is_sized = light.is_sized & np.broadcast_to(size > LEAST_SIZE * distance, distance.shape)
    return Incident(to_light, strength[:, None] * color, is_sized, corners, radiance[:, None] * color)


def _sun(light: Light, rotation, axis, to_light, distance):
    half_side = math.tan(min(light.size / 2, MAX_SUN_HALF_ANGLE)) * _SQUARED
    rim = half_side / math.sqrt(1 + half_side**2)
    radiance = light.energy / (4 * rim * math.atan(rim)) if rim else 0.0
    return np.full(len(distance), light.energy), *_facing(to_light, half_side), np.full(len(distance), radiance)


def _point(light: Light, rotation, axis, to_light, distance):
    intensity = light.energy / (4 * math.pi)
    radiance = intensity / (math.pi * light.size**2) if light.size else 0.0
    sides = _facing(to_light, light.size * _SQUARED)
    return intensity / distance**2, *sides, np.full(len(distance), radiance)


def _spot(light: Light, rotation, axis, to_light, distance):
    strength, u, v, radiance = _point(light, rotation, axis, to_light, distance)
    cosine = math.cos(light.spot_angle / 2)
    step = np.clip((-(to_light @ axis) - cosine) / max((1 - cosine) * light.spot_blend, 1e-6), 0, 1)
    passed = step * step * (3 - 2 * step)
    return strength * passed, u, v, radiance * passed


def _area(light: Light, rotation, axis, to_light, distance):
    along = -(to_light @ axis)
    radiance = np.where(along > 0, light.energy / (math.pi * light.area), 0.0)
    u, v = np.asarray(light.half_axes, np.float64) @ rotation.T * (_SQUARED if light.is_round else 1.0)
    return light.energy / math.pi * np.maximum(along, 0) / distance**2, u, v, radiance


_SQUARED = math.sqrt(math.pi) / 2
_SHAPES = {"sun": _sun, "point": _point, "spot": _spot, "area": _area}


def _facing(to_light: np.ndarray, half_side) -> tuple[np.ndarray, np.ndarray]:
    """(n, 3) half-axes of squares that face the lit points."""
    side = np.where(np.abs(to_light[:, 2:]) < 0.7, (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
    u = unit(np.cross(side, to_light))
    return u * np.reshape(half_side, (-1, 1)), np.cross(to_light, u) * np.reshape(half_side, (-1, 1))


def all_incident(scene: Scene, camera: Camera, position, light_set, epsilon: float) -> list[Incident]:
    """The light from every lamp at positions (n, 3) that belong to sets (n, 4) of objects; epsilon: see `lit_share`."""
    arriving = []
    for light in scene.lights:
        share = _linked(light, light_set)
        if light.casts_shadow:
            share = share * lit_share(light, scene, camera, position, epsilon)
        arriving.append(incident(light, camera, position).times(share))
    return arriving


def _linked(light: Light, light_set: np.ndarray) -> np.ndarray:
    """(n,) share of a point that the light affects, by light linking."""
    return light_set.sum(axis=1) if light.receivers is None else light_set[:, list(light.receivers)].sum(axis=1)
