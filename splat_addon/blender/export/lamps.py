# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts Blender's lights to the renderer's."""

from __future__ import annotations

import math
from dataclasses import replace

import bpy
import numpy as np

from ...rendering import Light
from ..materials.node_trees import uses_nodes
from ..materials.surface_shaders import surface_shader
from .radiance import color_times_strength

#: Blender's light type -> its emitting area, by which the energy of a non-normalised light is multiplied, as in Cycles:
#: the area of a sun's disc at distance 1 or of a point light's sphere, or 4 for a light without size.
_AREAS = {
    "SUN": lambda light: math.pi * math.sin(light.angle / 2) ** 2,
    "POINT": lambda light: 4 * (math.pi * light.shadow_soft_size**2 or 1),
    "SPOT": lambda light: 4 * (math.pi * light.shadow_soft_size**2 or 1),
}


def light_of(light: bpy.types.Light, matrix_world: np.ndarray, notes) -> Light | None:
    """The light, or None for an area light without extent. matrix_world: (4, 4), of the light's object."""
    color = np.array(light.color, np.float64) * _emission(light, notes)
    if light.use_temperature:
        color = color * np.array(light.temperature_color, np.float64)
    shape = _SHAPES[light.type](light, matrix_world)
    if light.type != "POINT":
        shape["direction"] = _direction(matrix_world)
    if light.type == "AREA" and np.linalg.norm(np.cross(*shape["half_axes"])) == 0:
        notes.add(f"The area light {light.name!r} has no area and gives no light; give it a size and a scale above 0")
        return None
    made = Light(
        light.type.lower(),
        tuple(color),
        light.energy * 2.0**light.exposure,
        position=tuple(matrix_world[:3, 3]),
        casts_shadow=light.use_shadow,
        **shape,
    )
    if light.normalize:
        return made
    area = made.area if light.type == "AREA" else _AREAS[light.type](light)
    return replace(made, energy=made.energy * area)


def _direction(matrix_world: np.ndarray) -> tuple[float, float, float]:
    if not matrix_world[:3, 2].any():
        raise ValueError("Its scale is 0 along Z, so that it has no direction; set it away from 0.")
    return tuple(-matrix_world[:3, 2])


def _area_shape(light: bpy.types.AreaLight, matrix_world: np.ndarray) -> dict:
    sizes = light.size, light.size_y if light.shape in {"RECTANGLE", "ELLIPSE"} else light.size
    half_axes = tuple(tuple(matrix_world[:3, k] * size / 2) for k, size in enumerate(sizes))
    return {"half_axes": half_axes, "is_round": light.shape in {"DISK", "ELLIPSE"}}


_SHAPES = {
    "SUN": lambda light, _: {"size": light.angle},
    "POINT": lambda light, _: {"size": light.shadow_soft_size},
    "SPOT": lambda light, _: {
        "size": light.shadow_soft_size,
        "spot_angle": light.spot_size,
        "spot_blend": light.spot_blend,
    },
    "AREA": _area_shape,
}


def _emission(light: bpy.types.Light, notes) -> np.ndarray:
    """(3,) colour times strength of the light's Emission node, which multiplies the light's own; 1 without nodes."""
    if not uses_nodes(light):
        return np.ones(3)
    shader = surface_shader(light)
    if shader is None or shader.node.type != "EMISSION" or shader.node.mute:
        notes.add(f"The light {light.name!r} has no Emission node at its output; its nodes are ignored")
        return np.ones(3)
    return np.array(color_times_strength(shader, f"The light {light.name!r}", notes))
