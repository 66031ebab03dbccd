# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes at the limits of arithmetic: sheets seen edge-on, specks at the near plane, moved and scaled worlds.

tests/extremes and `scripts/bench.py numerics` share these functions; `scenes` has the ordinary scenes.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ..quaternions import axes_quaternions
from ..rendering.scene import Instance, Scene
from ..rendering.scene.camera import Camera
from ..rendering.scene.light import Light
from ..surfels import Surfels

#: Radius of a sheet's disc in half-diagonals of its cell: neighbours overlap at the corners.
SHEET_OVERLAP = 1.2


def discs(centers, u=(1, 0, 0), v=(0, 1, 0), colors=None, normals=None) -> Surfels:
    """Ellipses from centres and orthogonal half-axes, (N, 3) or one row each; colours are random if not given."""
    centers = np.atleast_2d(np.asarray(centers, np.float64))
    u, v = (np.broadcast_to(np.asarray(a, np.float64), centers.shape) for a in (u, v))
    lengths = np.stack([np.linalg.norm(a, axis=1) for a in (u, v)], axis=1)
    x, y = u / lengths[:, :1], v / lengths[:, 1:]
    z = np.cross(x, y)
    if colors is None:
        colors = np.random.default_rng(0).random(centers.shape)
    normals = z if normals is None else np.broadcast_to(np.asarray(normals, np.float64), centers.shape)
    return Surfels(
        positions=centers,
        rotations=axes_quaternions(x, y, z),
        scales=lengths,
        normals=normals / np.linalg.norm(normals, axis=1, keepdims=True),
        colors=np.concatenate([np.broadcast_to(colors, centers.shape), np.ones((len(centers), 1))], axis=1),
        materials=np.zeros(len(centers), np.int32),
    )


def sheet(side: int, half: float, tilt: float, depth: float, colors=None) -> Surfels:
    """A square of side x side discs around (0, 0, -depth), extending `half` to each side; tilt: degrees from
    facing +Z.
    """
    axis = ((np.arange(side) + 0.5) * 2 / side - 1) * half
    x, y = (a.reshape(-1, 1) for a in np.meshgrid(axis, axis))
    angle = math.radians(tilt)
    along = np.array((0, math.cos(angle), -math.sin(angle)))
    radius = SHEET_OVERLAP * math.sqrt(2) * half / side
    return discs(x * (1, 0, 0) + y * along + (0, 0, -depth), (radius, 0, 0), along * radius, colors)


def speck(camera: Camera, depth: float) -> Instance:
    """One red disc slightly to the right of the camera's axis; its width is a thirtieth of its depth."""
    matrix = camera.matrix_world.copy()
    matrix[:3, 3] += (0.25 * matrix[:3, 0] - matrix[:3, 2]) * depth
    return Instance(discs((0, 0, 0), (depth / 30, 0, 0), (0, depth / 30, 0), (1, 0, 0)), matrix)


def floor_below(height: float) -> Surfels:
    """24 x 24 discs that form a floor under an eye at the origin; the nearest ones extend behind the eye."""
    return replace(sheet(24, 2.0, 90.0, 0.0), origin=(0.0, -height, 0.0))


def giant_floor(radius: float) -> Surfels:
    """One disc that extends from under the eye to the horizon."""
    return discs((0.1, -1.03, -5), (radius, 0, 0), (0, 0.1 * radius, -radius), (0.2, 0.5, 0.9))


def stripes(long: float, short: float, turn: float) -> Surfels:
    """21 parallel ellipses side by side, turned about the axis by an angle in radians."""
    u, v = np.array(((math.cos(turn), math.sin(turn), 0), (-math.sin(turn), math.cos(turn), 0)))
    return discs(np.linspace(-1, 1, 21)[:, None] * v + (0, 0, -3), u * long, v * short)


def pile(layers: int, colors=None) -> Surfels:
    """Discs close behind one another, each of which covers the whole picture."""
    random = np.random.default_rng(1)
    centers = np.concatenate([random.normal(0, 0.02, (layers, 2)), -3 - 1e-3 * random.random((layers, 1))], axis=1)
    return discs(centers, (1.5, 0, 0), (0, 1.5, 0), colors)


def crowd(camera: Camera, count: int, radius: float) -> Surfels:
    """Splats with a radius in pixels, spread over the pixel just above and right of the picture's middle."""
    pixel = 3 * (camera.window[1] - camera.window[0]) / camera.size[0]
    centers = np.random.default_rng(1).random((count, 3)) * (pixel, pixel, 1e-3) - (0, 0, 3)
    return discs(centers, (radius * pixel, 0, 0), (0, radius * pixel, 0))


def transformed(scene: Scene, camera: Camera, matrix: np.ndarray) -> tuple[Scene, Camera]:
    """The whole world, camera and lights included, moved by a (4, 4) similarity: its picture must stay the same."""
    scale = float(np.cbrt(np.linalg.det(matrix[:3, :3])))
    instances = tuple(replace(i, matrix_world=matrix @ i.matrix_world) for i in scene.surfels)
    lights = tuple(_transformed_light(light, matrix, scale) for light in scene.lights)
    moved = replace(camera, matrix_world=matrix @ camera.matrix_world, near=camera.near * scale, far=camera.far * scale)
    if camera.is_orthographic:
        moved = replace(moved, window=tuple(edge * scale for edge in camera.window))
    return replace(scene, surfels=instances, lights=lights), moved


def _transformed_light(light: Light, matrix: np.ndarray, scale: float) -> Light:
    """A point light's irradiance falls with the square of the distance, so its power grows with it."""
    position = tuple((matrix @ (*light.position, 1.0))[:3])
    direction = tuple(matrix[:3, :3] @ light.direction / scale)
    energy = light.energy * scale**2 if light.kind == "point" else light.energy
    return replace(light, position=position, direction=direction, energy=energy)
