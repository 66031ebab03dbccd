# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels, materials and lights as texels, the form in which shaders pull them.

A splat is four RGBA32F texels, 512 splats a row:
    position.xyz, normal.x   |   axis u.xyz, normal.y   |   axis v.xyz, material   |   color.rgba
where normal.xy is the octahedral form of the shading normal and the axes carry the half-axes' lengths.
"""

from __future__ import annotations

import numpy as np

from ..surfels import Surfels
from .scene import Instance, Light, Material

SPLATS_PER_ROW = 512
TEXELS_PER_SPLAT = 4
#: Rows that every tested backend's textures can have.
MAX_ROWS = 16384
MAX_SPLATS = SPLATS_PER_ROW * MAX_ROWS


def pack_surfels(surfels: Surfels) -> np.ndarray:
    """(rows, 2048, 4) float32 texels of N surfels. Raises ValueError above `MAX_SPLATS` (8.4 million)."""
    rows, count = row_count(surfels), len(surfels)
    texels = np.zeros((rows * SPLATS_PER_ROW, TEXELS_PER_SPLAT, 4), np.float32)
    filled = texels[:count]
    filled[:, 0, :3] = surfels.positions
    filled[:, 1, :3], filled[:, 2, :3] = surfels.half_axes()
    encoded = octahedral(surfels.normals)
    filled[:, 0, 3], filled[:, 1, 3] = encoded[0], encoded[1]
    filled[:, 2, 3] = surfels.materials
    filled[:, 3] = surfels.colors
    return texels.reshape(rows, SPLATS_PER_ROW * TEXELS_PER_SPLAT, 4)


def row_count(surfels: Surfels) -> int:
    """Rows of 512 splats, one at least. Raises ValueError above `MAX_SPLATS` (8.4 million)."""
    count = len(surfels)
    if count > MAX_SPLATS:
        raise ValueError(
            f"One object can hold {MAX_SPLATS:,} surfels, not {count:,}; split it or raise its surfel spacing."
        )
    return max(-(-count // SPLATS_PER_ROW), 1)


def octahedral(normals: np.ndarray) -> np.ndarray:
    """(2, N) octahedral coordinates of (N, 3) unit vectors; the twin of shaders/common/octahedron.glsl."""
    x, y, z = np.ascontiguousarray(normals.T)
    size = np.abs(x) + np.abs(y) + np.abs(z)
    x, y = x / size, y / size
    below = z < 0
    folded_x = np.where(x >= 0, 1 - np.abs(y), np.abs(y) - 1)
    folded_y = np.where(y >= 0, 1 - np.abs(x), np.abs(x) - 1)
    return np.stack([np.where(below, folded_x, x), np.where(below, folded_y, y)])


def pack_materials(materials: tuple[Material, ...]) -> np.ndarray:
    """(1, M, 4) float32: roughness, metallic, reflectance at normal incidence, 0."""
    return np.array([[(m.roughness, m.metallic, reflectance(m.ior), 0.0) for m in materials]], np.float32)


def reflectance(ior: float) -> float:
    """Of a dielectric at normal incidence (Fresnel)."""
    return ((ior - 1) / (ior + 1)) ** 2


def shared_material(instances: tuple[Instance, ...]) -> Material | None:
    """The one material that every surfel of the instances has, or None where they differ."""
    materials = {m for instance in instances for m in instance.materials}
    return materials.pop() if len(materials) == 1 else None


def pack_lights(lights: tuple[Light, ...], world_to_view: np.ndarray, scale: float) -> np.ndarray:
    """(L, 2, 4) float32, in scaled view space.

    Texel 0: direction to the light (sun, w = 0) or its position (point, w = 1). Texel 1: irradiance at a surface
    that faces it; of a point light at distance 1, energy / (4 pi), in scaled units.
    """
    texels = np.zeros((len(lights), 2, 4))
    for row, light in zip(texels, lights, strict=True):
        irradiance = np.asarray(light.color, np.float64) * light.energy
        row[0], row[1, :3] = _LIGHT_TEXELS[light.kind](light, irradiance, world_to_view, scale)
    return texels.astype(np.float32)


def _sun(light, irradiance, world_to_view, scale):
    to_light = world_to_view[:3, :3] @ -np.asarray(light.direction, np.float64)
    return (*to_light / np.linalg.norm(to_light), 0.0), irradiance


def _point(light, irradiance, world_to_view, scale):
    position = (world_to_view @ (*light.position, 1.0))[:3] * scale
    return (*position, 1.0), irradiance / (4 * np.pi) * scale**2


_LIGHT_TEXELS = {"sun": _sun, "point": _point}
