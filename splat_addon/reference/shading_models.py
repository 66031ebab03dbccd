# SPDX-License-Identifier: GPL-3.0-or-later
"""The shading models in float64: the twins of shaders/shading_models/*.glsl, by name.

Each takes the surfaces that rays see (`Surface`), their grid, the scene, its camera and the settings, and returns (n,
3) radiance.
"""

from __future__ import annotations

import numpy as np

from ..rendering.depth_range import depth_extent
from ..rendering.scene import Scene
from ..rendering.scene.camera import Camera
from ..rendering.settings import Settings
from .brdf import dot, unit
from .lights import all_incident
from .rays import RayGrid, Surface
from .shading import MIN_ROUGHNESS, principled_radiance
from .world import WorldLight


def _flat(surface: Surface, grid: RayGrid, scene: Scene, camera: Camera, settings: Settings) -> np.ndarray:
    return surface.color


def _captured(surface: Surface, grid: RayGrid, scene: Scene, camera: Camera, settings: Settings) -> np.ndarray:
    light = np.ones_like(surface.color)
    for one in _lighting(surface, grid, scene, camera, settings)[1]:
        light = light + one.irradiance * np.maximum(dot(surface.normal, one.to_light), 0)[:, None] / np.pi
    return surface.color * light


def _normals(surface: Surface, grid: RayGrid, scene: Scene, camera: Camera, settings: Settings) -> np.ndarray:
    return surface.normal @ camera.matrix_world[:3, :3].T / 2 + 0.5


def _depth(surface: Surface, grid: RayGrid, scene: Scene, camera: Camera, settings: Settings) -> np.ndarray:
    extent = depth_extent(scene.table, camera, settings.epsilon, settings.epsilon_length)
    share = (surface.depth - extent.near) / (extent.far - extent.near)
    return np.repeat(np.clip(share, 0, 1)[:, None], 3, axis=1)


def _principled(surface: Surface, grid: RayGrid, scene: Scene, camera: Camera, settings: Settings) -> np.ndarray:
    direction, incident = _lighting(surface, grid, scene, camera, settings)
    return principled_radiance(surface, direction, incident, WorldLight(scene, camera))


def _phong(surface: Surface, grid: RayGrid, scene: Scene, camera: Camera, settings: Settings) -> np.ndarray:
    direction, incident = _lighting(surface, grid, scene, camera, settings)
    metallic, f0 = np.clip(surface.metallic, 0, 1)[:, None], surface.f0[:, None]
    diffuse, specular = surface.color * (1 - metallic), f0 + (surface.color - f0) * metallic
    exponent = blinn_exponent(surface.roughness)
    radiance = surface.emission + (diffuse + specular) * WorldLight(scene, camera).irradiance(surface.normal)
    for light in incident:
        cosine = np.maximum(dot(surface.normal, light.to_light), 0)[:, None]
        lobe = (exponent + 8) / (8 * np.pi) * _blinn_lobe(surface.normal, -unit(direction), light.to_light, exponent)
        radiance = radiance + (diffuse / np.pi + specular * lobe[:, None]) * light.irradiance * cosine
    return radiance


def _toon(surface: Surface, grid: RayGrid, scene: Scene, camera: Camera, settings: Settings) -> np.ndarray:
    direction, incident = _lighting(surface, grid, scene, camera, settings)
    metallic = np.clip(surface.metallic, 0, 1)[:, None]
    highlight = (1 + (surface.color - 1) * metallic) * (1 - np.clip(surface.roughness, 0, 1))[:, None]
    exponent = blinn_exponent(surface.roughness)
    radiance = surface.emission + surface.color * WorldLight(scene, camera).irradiance(surface.normal)
    for light in incident:
        cosine = dot(surface.normal, light.to_light)
        lobe = _blinn_lobe(surface.normal, -unit(direction), light.to_light, exponent)
        steps = toon_ramp(cosine, settings.toon_steps, settings.toon_softness)[:, None]
        spot = _soft_step(lobe - 0.5, settings.toon_softness)[:, None]
        seen = surface.color * steps + highlight * spot
        radiance = radiance + np.where(cosine[:, None] > 0, seen * light.irradiance / np.pi, 0)
    return radiance


def _ramp(surface: Surface, grid: RayGrid, scene: Scene, camera: Camera, settings: Settings) -> np.ndarray:
    _, incident = _lighting(surface, grid, scene, camera, settings)
    light = np.broadcast_to(WorldLight(scene, camera).irradiance(surface.normal), surface.normal.shape)
    for one in incident:
        light = light + one.irradiance * np.maximum(dot(surface.normal, one.to_light), 0)[:, None] / np.pi
    colors = settings.ramp.colors.astype(np.float64)
    places, luminance = np.linspace(0, 1, len(colors)), light @ settings.ramp.luminance
    looked_up = np.stack([np.interp(luminance, places, channel) for channel in colors.T], axis=1)
    return surface.emission + surface.color * looked_up


def _matcap(surface: Surface, grid: RayGrid, scene: Scene, camera: Camera, settings: Settings) -> np.ndarray:
    """Maps the normal, in a basis around the ray as in Blender's Workbench, to a position in the picture."""
    view = -unit(grid.rays(surface.rays)[1])
    a, b = 1 / (1 + view[:, 2]), -view[:, 0] * view[:, 1] / (1 + view[:, 2])
    across = np.stack([1 - view[:, 0] ** 2 * a, b, -view[:, 0]], axis=1)
    up = np.stack([b, 1 - view[:, 1] ** 2 * a, -view[:, 1]], axis=1)
    place = np.stack([dot(across, surface.normal), dot(up, surface.normal)], axis=1) * 0.496 + 0.5
    pixels = settings.matcap.pixels.astype(np.float64)
    size = np.array(pixels.shape[1::-1])
    at = np.clip(place * size - 0.5, 0, size - 1)
    low = np.floor(at).astype(int)
    (x0, y0), (x1, y1), (sx, sy) = low.T, np.minimum(low + 1, size - 1).T, (at - low).T[..., None]
    below = pixels[y0, x0] * (1 - sx) + pixels[y0, x1] * sx
    return surface.color * (below * (1 - sy) + (pixels[y1, x0] * (1 - sx) + pixels[y1, x1] * sx) * sy)


def _overdraw(surface: Surface, grid: RayGrid, scene: Scene, camera: Camera, settings: Settings) -> np.ndarray:
    return heat(np.log2(surface.count) / 8)


def _weight(surface: Surface, grid: RayGrid, scene: Scene, camera: Camera, settings: Settings) -> np.ndarray:
    return heat(np.log2(surface.weight) / 8 + 0.5)


def heat(t: np.ndarray) -> np.ndarray:
    """(n, 3) blue, cyan, green, yellow and red in even steps from 0 to 1."""
    stops = np.array(((0, 0, 1), (0, 1, 1), (0, 1, 0), (1, 1, 0), (1, 0, 0)), np.float64)
    return np.stack([np.interp(t, np.linspace(0, 1, 5), channel) for channel in stops.T], axis=1)


def blinn_exponent(roughness: np.ndarray) -> np.ndarray:
    """Exponent of a Blinn lobe as wide as GGX at that roughness (Walter et al. 2007, section 5.2)."""
    return 2 / np.clip(roughness, MIN_ROUGHNESS, 1) ** 4 - 2


def toon_ramp(cosine: np.ndarray, steps: int, softness: float) -> np.ndarray:
    """0 to 1 in `steps` even levels, whose edges lie at multiples of 1 / steps and are `softness` of one wide."""
    at = cosine * steps
    edge = np.clip(np.floor(at + 0.5), 1, steps - 1)
    return (edge - 1 + _soft_step(at - edge, softness)) / (steps - 1)


def _soft_step(x: np.ndarray, softness: float) -> np.ndarray:
    t = np.clip(x / softness + 0.5, 0, 1) if softness > 0 else (x >= 0).astype(float)
    return t * t * (3 - 2 * t)


def _blinn_lobe(normal, view, to_light, exponent) -> np.ndarray:
    return np.maximum(dot(normal, unit(view + to_light)), 0) ** exponent


def _lighting(surface: Surface, grid: RayGrid, scene: Scene, camera: Camera, settings: Settings):
    """Directions of the rays that hit, (n, 3), and the light that reaches the hit points."""
    origin, direction = grid.rays(surface.rays)
    position = origin + surface.depth[:, None] * direction
    return direction, all_incident(scene, camera, position, surface.light_set, settings.epsilon)


#: The models that show how splats add up; they treat everything as opaque.
DIAGNOSTIC = ("overdraw", "weight")

#: name of a shading model -> its twin
SHADERS = {
    "principled": _principled,
    "captured": _captured,
    "phong": _phong,
    "toon": _toon,
    "ramp": _ramp,
    "flat": _flat,
    "normals": _normals,
    "depth": _depth,
    "matcap": _matcap,
    "overdraw": _overdraw,
    "weight": _weight,
}
