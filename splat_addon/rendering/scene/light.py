# SPDX-License-Identifier: GPL-3.0-or-later
"""Lights in Blender's units, and the texels through which shaders read them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .numbers import MAX_LENGTH, MIN_LENGTH, check_lengths, check_range

#: Wider suns are shaded with this half-angle: half of the sky.
MAX_SUN_HALF_ANGLE = 1.4

#: Maximum number of sets of instances with different lights: the channels of one texture.
MAX_LIGHT_SETS = 4

#: Maximum irradiance per channel: beyond this, lit colours may overflow float32.
MAX_IRRADIANCE = 1e30

#: Maximum power of a light per channel. A light as far away as a star needs it, and float32 holds no more.
MAX_POWER = 3e38

KINDS = ("sun", "point", "spot", "area")


@dataclass(frozen=True, eq=False)
class Light:
    """kind: "sun" (energy is irradiance, W/m^2, of a surface facing it), "point" and "spot" (energy is radiant power,
    W, sent out evenly: irradiance energy / (4 pi d^2) at distance d; a spot keeps what its cone lets through) or "area"
    (energy is the power, W, that a flat lamp sends to its front, by Lambert's law).

    color: (3,) linear, multiplies energy. position: (3,) world, of all but suns.
    direction: (3,) world, the way the light of a sun, a spot's axis and an area's front travel.
    size: radians across a sun, or the radius of a point or spot; 0 is a light without size.
    spot_angle: radians across a spot's cone; spot_blend: 0 to 1, how soft its rim is.
    receivers: numbers of the sets of instances (`Instance.light_set`) that it lights, or None for all.
    casts_shadow: whether objects block its light.
    half_axes: (2, 3) world, from an area's middle to the middles of two sides; is_round: they are an ellipse's.
    """

    kind: str
    color: tuple[float, float, float] = (1.0, 1.0, 1.0)
    energy: float = 1.0
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    direction: tuple[float, float, float] = (0.0, 0.0, -1.0)
    size: float = 0.0
    spot_angle: float = math.pi / 4
    spot_blend: float = 0.15
    half_axes: tuple[tuple[float, float, float], tuple[float, float, float]] = ((0.5, 0.0, 0.0), (0.0, 0.5, 0.0))
    is_round: bool = False
    receivers: tuple[int, ...] | None = None
    casts_shadow: bool = False

    def __post_init__(self):
        if self.kind not in KINDS:
            raise ValueError(f"A light's kind must be one of {', '.join(KINDS)}, not {self.kind!r}.")
        for name in ("color", "energy", "position", "direction", "size", "spot_angle", "spot_blend", "half_axes"):
            if not np.isfinite(getattr(self, name)).all():
                raise ValueError(f"A light's {name} must be finite, not {np.asarray(getattr(self, name)).tolist()}.")
        largest = MAX_IRRADIANCE if self.kind == "sun" else MAX_POWER
        if not np.abs(self.color).max() * abs(self.energy) <= largest:
            raise ValueError(
                f"A light's colour times its energy must be at most {largest:g}, which pictures can hold, not "
                f"{np.asarray(self.color).tolist()} times {float(self.energy):g}."
            )
        for name in ("position", "size", "half_axes"):
            check_lengths(f"A light's {name}", getattr(self, name))
        check_range("A light's spot_angle", self.spot_angle, 0.0, 2 * math.pi)
        check_range("A light's spot_blend", self.spot_blend, 0.0, 1.0)
        if not MIN_LENGTH <= np.abs(self.direction).max() <= MAX_LENGTH:
            raise ValueError(f"A light's direction must not be zero or endless, but is {self.direction}.")
        if self.size < 0:
            raise ValueError(f"A light's size must be 0 or more, not {self.size}.")
        if self.kind == "area" and not self.area > 0:
            raise ValueError(f"An area light's half-axes must span an area, not {np.asarray(self.half_axes).tolist()}.")

    @property
    def area(self) -> float:
        """Area of an area light."""
        u, v = np.asarray(self.half_axes, np.float64)
        return float(np.linalg.norm(np.cross(u, v))) * (math.pi if self.is_round else 4.0)

    @property
    def is_sized(self) -> bool:
        """Whether it has an extent, unlike a point or a single direction."""
        return self.kind == "area" or self.size > 0


#: Float32 texels per light: see shaders/hosts/lights.glsl.
TEXELS_PER_LIGHT = 7

#: Half-side of a square with the area of a disc, in radii of the disc.
_SQUARED = math.sqrt(math.pi) / 2


def pack_lights(lights: tuple[Light, ...], world_to_view: np.ndarray, scale: float, map_ranges=None) -> np.ndarray:
    """(L, 7, 4) float32, in scaled view space; world_to_view: (4, 4) float64.

    map_ranges: (L, 2) the first and the number of each light's shadow maps, or None without shadows.

    place, w: 1, or for a sun the direction to it and 0 | irradiance at distance 1 that faces it (of an area the
    intensity along its axis), half-side of a square as large as it | axis, cosine of a spot's half-angle | half-axis u,
    1 / width of a spot's rim | half-axis v, 1 for an area | 1 for each set that it lights |
    first shadow map, number of shadow maps, size of the lamp that casts them, 1 for one that casts shadows.
    """
    texels = np.zeros((len(lights), TEXELS_PER_LIGHT, 4))
    rotation = world_to_view[:3, :3]
    for row, light in zip(texels, lights, strict=True):
        axis = rotation @ np.asarray(light.direction, np.float64)
        axis /= np.linalg.norm(axis)
        strength, half_side = _STRENGTHS[light.kind](light, scale)
        if light.kind == "sun":
            row[0] = *-axis, 0.0
        else:
            row[0] = *((world_to_view @ (*light.position, 1.0))[:3] * scale), 1.0
        row[1] = *(np.asarray(light.color, np.float64) * strength), half_side
        row[2] = *axis, -2.0
        row[3, 3] = 1.0
        row[6, 3] = light.casts_shadow
        row[5] = [light.receivers is None or number in light.receivers for number in range(MAX_LIGHT_SETS)]
        if light.kind == "spot":
            cosine = math.cos(light.spot_angle / 2)
            row[2, 3], row[3, 3] = cosine, 1 / max((1 - cosine) * light.spot_blend, 1e-6)
        if light.kind == "area":
            squared = _SQUARED if light.is_round else 1.0
            row[3, :3], row[4, :3] = (np.asarray(light.half_axes, np.float64) @ rotation.T) * scale * squared
            row[4, 3] = 1.0
    if map_ranges is not None:
        texels[:, 6, :2] = map_ranges
        texels[:, 6, 2] = [_LAMP_SIZES[light.kind](light, scale) for light in lights]
    # in a tiny scene units are tiny, so a power may exceed float32
    return np.clip(texels, -MAX_IRRADIANCE, MAX_IRRADIANCE).astype(np.float32)


def _sun(light: Light, scale: float) -> tuple[float, float]:
    half_angle = min(light.size / 2, MAX_SUN_HALF_ANGLE)
    return light.energy, math.tan(half_angle) * _SQUARED


def _point(light: Light, scale: float) -> tuple[float, float]:
    return light.energy / (4 * math.pi) * scale**2, light.size * scale * _SQUARED


def _area(light: Light, scale: float) -> tuple[float, float]:
    return light.energy / math.pi * scale**2, math.sqrt(light.area) / 2 * scale


_STRENGTHS = {"sun": _sun, "point": _point, "spot": _point, "area": _area}

#: Half the width of a light that casts soft shadows, in scaled view units; for a sun the tangent of half its angle.
_LAMP_SIZES = {
    "sun": lambda light, _: math.tan(min(light.size / 2, MAX_SUN_HALF_ANGLE)),
    "point": lambda light, scale: light.size * scale,
    "spot": lambda light, scale: light.size * scale,
    "area": lambda light, scale: math.sqrt(light.area / math.pi) * scale,
}
