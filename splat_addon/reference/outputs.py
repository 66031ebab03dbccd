# SPDX-License-Identifier: GPL-3.0-or-later
"""Outputs of a frame other than colour, by definition: the twin of shaders/hosts/outputs.glsl."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..rendering.scene import Scene
from ..rendering.scene.camera import Camera
from ..rendering.settings import Settings
from .brdf import dot
from .lights import all_incident
from .rays import RayGrid, Surface

#: The shading models that look at lights, and at materials.
LIT = ("principled", "phong", "toon", "ramp")


def _diffuse_color(surface: Surface, grid: RayGrid, scene: Scene, camera: Camera, settings: Settings) -> np.ndarray:
    if settings.shading not in LIT:
        return surface.color
    return surface.color * (1 - np.clip(surface.metallic, 0, 1))[:, None]


def _emission(surface: Surface, grid: RayGrid, scene: Scene, camera: Camera, settings: Settings) -> np.ndarray:
    return surface.emission * (settings.shading in LIT)


def _shadow(surface: Surface, grid: RayGrid, scene: Scene, camera: Camera, settings: Settings) -> np.ndarray:
    """For each colour, the irradiance that arrives divided by the irradiance without shadows; 0 / 0 counts as 0."""
    if settings.shading not in LIT:
        return np.zeros_like(surface.color)
    origin, direction = grid.rays(surface.rays)
    position = origin + surface.depth[:, None] * direction
    shadowless = replace(scene, lights=tuple(replace(light, casts_shadow=False) for light in scene.lights))
    arriving, unshadowed = (
        sum(
            (
                light.irradiance * np.maximum(dot(surface.normal, light.to_light), 0)[:, None]
                for light in all_incident(lit, camera, position, surface.light_set, settings.epsilon)
            ),
            np.zeros_like(surface.color),
        )
        for lit in (scene, shadowless)
    )
    return np.divide(arriving, unshadowed, out=np.zeros_like(arriving), where=unshadowed > 0)


def _overdraw(surface: Surface, grid: RayGrid, scene: Scene, camera: Camera, settings: Settings) -> np.ndarray:
    return surface.count[:, None]


#: array of a `Frame` that is a mean over rays -> how many numbers it has, and a function of what rays see
OUTPUTS = {
    "diffuse_color": (3, _diffuse_color),
    "emission": (3, _emission),
    "shadow": (3, _shadow),
    "overdraw": (1, _overdraw),
}
