# SPDX-License-Identifier: GPL-3.0-or-later
"""When samples of a surface count as alike."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Tolerance:
    """When samples count as alike.

    distance: from the sampled planes, object units. Textures may slip by the same distance.
    angle: between shading normals, radians.
    color: maximum difference of a colour component, scene-linear, unless a texture replaces it, and of any optional
        field of `Surfels`.
    """

    distance: float
    angle: float = math.radians(8)
    color: float = 0.02

    def __post_init__(self):
        for name in ("distance", "angle", "color"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 0):
                raise ValueError(f"The tolerance of the {name} must be a finite number, 0 or more, not {value}.")
