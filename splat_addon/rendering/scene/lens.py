# SPDX-License-Identifier: GPL-3.0-or-later
"""The aperture of a camera that is not a pinhole: a thin lens (Cook et al., "Distributed ray tracing", 1984, section
4), with the aperture shapes of Cycles."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .numbers import MAX_FACTOR, MAX_INDEX, MAX_LENGTH, MIN_LENGTH, check_range


@dataclass(frozen=True)
class Lens:
    """A thin lens at a perspective camera's place, in its plane.

    radius: of the aperture, world units. focus_distance: distance of the sharp plane along -Z, world units.
    blades: corners of the aperture, on its circle; below 3 it is round. rotation: of the corners, radians.
    ratio: height over width of the aperture (anamorphic lenses).
    """

    radius: float
    focus_distance: float
    blades: int = 0
    rotation: float = 0.0
    ratio: float = 1.0

    def __post_init__(self):
        if not MIN_LENGTH <= self.radius <= MAX_LENGTH:
            raise ValueError(f"A lens needs a radius above 0, not {self.radius}; a pinhole camera has no lens.")
        if not MIN_LENGTH <= self.focus_distance <= MAX_LENGTH:
            raise ValueError(f"A lens cannot focus at the distance {self.focus_distance}; move it before the camera.")
        check_range("The number of a lens's blades", self.blades, -MAX_INDEX, MAX_INDEX, is_whole=True)
        if not (MIN_LENGTH <= self.ratio <= MAX_FACTOR and math.isfinite(self.rotation)):
            raise ValueError(f"A lens needs a ratio above 0 and a finite rotation, not {self.ratio}, {self.rotation}.")

    def points(self, unit: np.ndarray) -> np.ndarray:
        """(..., 2) float64 in [0, 1) -> (..., 2) points on the aperture along the camera's x and y, uniform by area."""
        u, v = np.moveaxis(np.asarray(unit, np.float64), -1, 0)
        places = _on_disc(u, v) if self.blades < 3 else _on_polygon(u, v, self.blades, self.rotation)
        return self.radius * places * (1 / self.ratio, 1.0)


def _on_disc(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Maps concentric squares to concentric circles (Shirley & Chiu, "A low distortion map", 1997)."""
    a, b = 2 * u - 1, 2 * v - 1
    wide = np.abs(a) > np.abs(b)
    radius = np.where(wide, a, b)
    share = np.divide(np.where(wide, b, a), radius, out=np.zeros_like(radius), where=radius != 0) * math.pi / 4
    angle = np.where(wide, share, math.pi / 2 - share)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)


def _on_polygon(u: np.ndarray, v: np.ndarray, corners: int, rotation: float) -> np.ndarray:
    """u selects one of the triangles around the centre and, with v, the point in it (as Cycles' regular polygon)."""
    triangle = np.floor(u * corners)
    out = np.sqrt(u * corners - triangle)
    along = out * v
    half = math.pi / corners
    x, y = out * math.cos(half), (2 * along - out) * math.sin(half)
    angle = rotation + 2 * half * triangle
    return np.stack([x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)], axis=-1)
