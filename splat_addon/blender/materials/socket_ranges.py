# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers that shaders take: Blender lets scripts and nodes give their sockets any other, also NaN.

The ranges are those of Cycles, where NaN counts as the least number.
"""

from __future__ import annotations

import bpy
import numpy as np

from ...rendering.scene.numbers import MAX_FACTOR, MAX_RADIANCE

#: socket -> the least and the greatest of its numbers. In Cycles, coat and sheen may cover more than all of a surface.
_RANGES = {
    "Base Color": (0.0, MAX_RADIANCE),
    "Color": (0.0, MAX_RADIANCE),
    "Alpha": (0.0, 1.0),
    "Roughness": (0.0, 1.0),
    "Metallic": (0.0, 1.0),
    "IOR": (1e-5, 1e5),
    "Specular IOR Level": (0.0, MAX_FACTOR),
    "Specular Tint": (0.0, MAX_FACTOR),
    "Coat Weight": (0.0, 1.0),
    "Coat Roughness": (0.0, 1.0),
    "Coat IOR": (1.0, 1e5),
    "Coat Tint": (0.0, MAX_FACTOR),
    "Sheen Weight": (0.0, 1.0),
    "Sheen Roughness": (0.0, 1.0),
    "Sheen Tint": (0.0, MAX_FACTOR),
    "Transmission Weight": (0.0, 1.0),
    "Subsurface Weight": (0.0, 1.0),
}

#: Shaders whose colour is multiplied by a strength, so that only the product has a limit.
_EMITTERS = ("EMISSION", "BACKGROUND")


def has_range(node: bpy.types.Node, name: str) -> bool:
    """Whether the numbers of a shader's socket are limited one by one."""
    return name in _RANGES and node.type not in _EMITTERS


def range_of(node: bpy.types.Node, name: str) -> tuple[float, float]:
    """The least and the greatest number of a shader's socket."""
    return _RANGES[name] if has_range(node, name) else (-MAX_RADIANCE, MAX_RADIANCE)


def in_range(name: str, value: tuple[float, ...]) -> tuple[float, ...]:
    """The numbers of a socket that has a range, as the shader takes them."""
    given, (least, greatest) = np.array(value, np.float64), _RANGES[name]
    return tuple(np.clip(np.where(np.isnan(given), least, given), least, greatest).tolist())


def finite_factors(values: np.ndarray) -> np.ndarray:
    """Numbers that multiply something else, which have no other limit."""
    return np.clip(np.nan_to_num(values), -MAX_RADIANCE, MAX_RADIANCE)


def is_radiance(value: tuple[float, ...]) -> bool:
    """Whether pictures can represent what something emits; otherwise it is black."""
    return all(abs(channel) <= MAX_RADIANCE for channel in value)
