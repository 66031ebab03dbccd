# SPDX-License-Identifier: GPL-3.0-or-later
"""Eye-dome lighting, as `Settings` has it (Boucheny 2009)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .numbers import MAX_FACTOR

MAX_RADIUS = 32.0

#: What strength 1 makes of a surface whose surroundings rise towards the viewer by 45 degrees on all sides.
_DARKEST_AT_45 = 0.75


@dataclass(frozen=True)
class EyeDome:
    """strength: of the darkening, above 0; 1 is usual. radius: pixels between a sample and the eight around it that it
    is compared with; the width of the dark rims."""

    strength: float = 1.0
    radius: float = 1.5

    def __post_init__(self):
        if not 0 < self.strength <= MAX_FACTOR:
            raise ValueError(f"The strength of eye-dome lighting must be above 0, not {self.strength}.")
        if not 1 <= self.radius <= MAX_RADIUS:
            raise ValueError(f"The radius of eye-dome lighting must be 1 to {MAX_RADIUS:g} pixels, not {self.radius}.")

    @property
    def gain(self) -> float:
        """A surface is darkened by exp(-gain * mean rise of its surroundings), a rise being the tangent of an angle."""
        return -math.log(_DARKEST_AT_45) * self.strength


def steps_of(radius: float) -> tuple[float, float]:
    """Whole samples along an axis, and along each of a diagonal's, for a radius in samples."""
    return max(float(round(radius)), 1.0), max(float(round(radius / math.sqrt(2))), 1.0)
