# SPDX-License-Identifier: GPL-3.0-or-later
"""The opening that a camera looks through where it is no pinhole: a thin lens (Cook et al., "Distributed ray tracing",
1984, section 4), with the shapes of opening that Cycles has.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Lens:
    """A thin lens at a perspective camera's place, in its plane.

    radius: of the opening, world units. focus_distance: along -Z, world units: what lies there is sharp.
    blades: corners of the opening, on its circle; below 3 it is round. rotation: of the corners, radians.
    ratio: by which the opening is narrower than high (anamorphic lenses).
    """

    radius: float
    focus_distance: float
    blades: int = 0
    rotation: float = 0.0
    ratio: float = 1.0

    def __post_init__(self):
        if not (0 < self.radius < math.inf):
            raise ValueError(f"A lens needs a radius above 0, not {self.radius}; a pinhole camera has no lens.")
        if not (0 < self.focus_distance < math.inf):
            raise ValueError(f"A lens cannot focus at the distance {self.focus_distance}; move it before the camera.")
        if not (0 < self.ratio < math.inf and math.isfinite(self.rotation)):
            raise ValueError(f"A lens needs a ratio above 0 and a finite rotation, not {self.ratio}, {self.rotation}.")

    def points(self, unit: np.ndarray) -> np.ndarray:
        """(..., 2) float64 in [0, 1) -> (..., 2) places on the opening along the camera's x and y, even by area."""
        u, v = np.moveaxis(np.asarray(unit, np.float64), -1, 0)
        places = _on_disc(u, v) if self.blades < 3 else _on_polygon(u, v, self.blades, self.rotation)
        return self.radius * places * (1 / self.ratio, 1.0)


def _on_disc(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Rings of the square to rings of the unit disc (Shirley & Chiu, "A low distortion map", 1997)."""
    a, b = 2 * u - 1, 2 * v - 1
    wide = np.abs(a) > np.abs(b)
    radius = np.where(wide, a, b)
    share = np.divide(np.where(wide, b, a), radius, out=np.zeros_like(radius), where=radius != 0) * math.pi / 4
    angle = np.where(wide, share, math.pi / 2 - share)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)


def _on_polygon(u: np.ndarray, v: np.ndarray, corners: int, rotation: float) -> np.ndarray:
    """u chooses one of the triangles around the centre and, with v, the place in it (as Cycles' regular polygon)."""
    triangle = np.floor(u * corners)
    out = np.sqrt(u * corners - triangle)
    along = out * v
    half = math.pi / corners
    x, y = out * math.cos(half), (2 * along - out) * math.sin(half)
    angle = rotation + 2 * half * triangle
    return np.stack([x * np.cos(angle) - y * np.sin(angle), x * np.sin(angle) + y * np.cos(angle)], axis=-1)
