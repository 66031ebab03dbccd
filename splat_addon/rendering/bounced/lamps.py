# SPDX-License-Identifier: GPL-3.0-or-later
"""What lamps send to points: a place on the lamp for each, so that many together have soft shadows."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...vectors import unit
from ..scene.light import MAX_SUN_HALF_ANGLE, Light


class Sent(NamedTuple):
    """What n points receive if nothing is between. toward: (n, 3) unit, to the place on the lamp. distances: (n,).
    irradiance: (n, 3), of a surface that faces it."""

    toward: np.ndarray
    distances: np.ndarray
    irradiance: np.ndarray


def sent(light: Light, positions: np.ndarray, chances: np.ndarray) -> Sent:
    """chances: (n, 2), even in 0 to 1, which place on the lamp each of (n, 3) positions sees."""
    color = np.asarray(light.color, np.float64)
    if light.kind == "sun":
        toward = _around(
            -unit(np.asarray(light.direction, np.float64)), min(light.size / 2, MAX_SUN_HALF_ANGLE), chances
        )
        every = np.ones((len(positions), 1))
        return Sent(toward, np.full(len(positions), np.inf), every * color * light.energy)
    middle, axis = np.asarray(light.position, np.float64), unit(np.asarray(light.direction, np.float64))
    to_middle = middle - positions
    places = middle + (_on_area(light, chances) if light.kind == "area" else _on_disc(to_middle, light.size, chances))
    between = places - positions
    distances = np.maximum(np.linalg.norm(between, axis=1), 1e-12)
    toward = between / distances[:, None]
    if light.kind == "area":
        strength = light.energy / math.pi * np.maximum(-(toward @ axis), 0)
    else:
        strength = np.full(len(positions), light.energy / (4 * math.pi))
    if light.kind == "spot":
        cosine = math.cos(light.spot_angle / 2)
        step = np.clip((-(unit(to_middle) @ axis) - cosine) / max((1 - cosine) * light.spot_blend, 1e-6), 0, 1)
        strength *= step * step * (3 - 2 * step)
    return Sent(toward, distances, (strength / distances**2)[:, None] * color)


def _disc(chances: np.ndarray) -> np.ndarray:
    """(n, 2) places on a disc of radius 1."""
    angle = 2 * math.pi * chances[:, 1]
    return np.sqrt(chances[:, :1]) * np.stack([np.cos(angle), np.sin(angle)], axis=1)


def _on_area(light: Light, chances: np.ndarray) -> np.ndarray:
    return (_disc(chances) if light.is_round else 2 * chances - 1) @ np.asarray(light.half_axes, np.float64)


def _on_disc(to_middle: np.ndarray, radius: float, chances: np.ndarray) -> np.ndarray:
    """(n, 3) places on discs that face the points."""
    if not radius:
        return np.zeros(3)
    x, y = _beside(unit(to_middle))
    at = radius * _disc(chances)
    return x * at[:, :1] + y * at[:, 1:]


def _around(axis: np.ndarray, half_angle: float, chances: np.ndarray) -> np.ndarray:
    """(n, 3) unit directions within an angle of one."""
    x, y = _beside(axis[None])
    at = math.tan(half_angle) * _disc(chances)
    return unit(axis + x * at[:, :1] + y * at[:, 1:])


def _beside(axes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Two (n, 3) unit vectors perpendicular to each axis and to one another."""
    side = np.where(np.abs(axes[:, 2:]) < 0.7, (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
    x = unit(np.cross(side, axes))
    return x, np.cross(axes, x)
