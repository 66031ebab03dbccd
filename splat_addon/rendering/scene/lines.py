# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines along silhouettes and creases, over any shading model (Saito and Takahashi 1990)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .numbers import MAX_FACTOR, MAX_RADIANCE

MAX_WIDTH = 16.0

#: A crease must turn the normal within this many pixels beside a line.
CREASE_REACH = 3.0


@dataclass(frozen=True)
class Lines:
    """width: in pixels. A silhouette is drawn on the nearer surface, a crease half on each side.
    color: linear rgb. crease_angle: radians between normals, above which there is a crease.
    depth_threshold: how much deeper than the extrapolated surface the next one must be at a silhouette, in units of a
        pixel's width at that depth.
    shallow_angle: radians between the view and the surface, below which a line covers it (Botsch et al. 2005, section
        6); 0 for none.
    """

    width: float = 1.5
    color: tuple[float, float, float] = (0.0, 0.0, 0.0)
    crease_angle: float = math.radians(40)
    depth_threshold: float = 4.0
    shallow_angle: float = 0.0

    def __post_init__(self):
        object.__setattr__(self, "color", tuple(float(c) for c in self.color))
        if not 0 < self.width <= MAX_WIDTH:
            raise ValueError(f"A line's width must be above 0 and at most {MAX_WIDTH:g} pixels, not {self.width}.")
        if len(self.color) != 3 or not all(0 <= c <= MAX_RADIANCE for c in self.color):
            raise ValueError(f"A line's color must be three numbers of 0 or more, not {self.color}.")
        if not 0 < self.crease_angle <= math.pi:
            raise ValueError(f"crease_angle must be above 0 and at most pi, not {self.crease_angle}.")
        if not 0 <= self.depth_threshold <= MAX_FACTOR:
            raise ValueError(f"depth_threshold must be 0 or more pixels, not {self.depth_threshold}.")

        if not 0 <= self.shallow_angle <= math.pi / 2:
            raise ValueError(f"shallow_angle must be 0 to pi / 2, not {self.shallow_angle}.")

    @property
    def reach(self) -> float:
        """Pixels on each side that a line looks at."""
        return self.width + 2.0 + CREASE_REACH
