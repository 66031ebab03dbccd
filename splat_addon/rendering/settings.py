# SPDX-License-Identifier: GPL-3.0-or-later
"""How a picture is to be made: one frozen set of choices that the Blender properties mirror."""

from __future__ import annotations

import math
from dataclasses import dataclass

#: shading -> what it shows
SHADINGS = {
    "principled": "Diffuse and GGX specular light of the scene's lights and world",
    "flat": "The surfels' own colour, unlit",
}

MAX_SUPERSAMPLING = 16

#: the arrays of a `Frame`
OUTPUTS = ("color", "depth", "normal", "coverage")


@dataclass(frozen=True)
class Settings:
    """method: how a splat is rasterised and filtered, a name in `rendering.methods`.
    shading: a name in `SHADINGS`.
    supersampling: N x N samples a pixel, averaged with a box filter.
    epsilon: how far, in radii of each splat, the visibility pass moves it back along the view ray;
        surfaces closer than that mix (facts: 0.5 to 5 is a plateau, 0 breaks the picture up).
    transparent_film: leave the background out and keep its alpha at 0.
    outputs: which arrays of the `Frame` are wanted; the others are None and cost nothing.
    profile: wait for the device after each pass, so that the frame's statistics hold a time for each.
    """

    method: str = "quad"
    shading: str = "principled"
    supersampling: int = 2
    epsilon: float = 0.5
    transparent_film: bool = False
    outputs: tuple[str, ...] = OUTPUTS
    profile: bool = False

    def __post_init__(self):
        if self.shading not in SHADINGS:
            raise ValueError(f"shading must be one of {', '.join(SHADINGS)}, not {self.shading!r}.")
        if int(self.supersampling) != self.supersampling or not 1 <= self.supersampling <= MAX_SUPERSAMPLING:
            raise ValueError(f"supersampling must be 1 to {MAX_SUPERSAMPLING}, not {self.supersampling}.")
        if not set(self.outputs) <= set(OUTPUTS):
            raise ValueError(f"outputs must be among {', '.join(OUTPUTS)}, not {self.outputs!r}.")
        if not (math.isfinite(self.epsilon) and self.epsilon >= 0):
            raise ValueError(f"epsilon must be 0 or more splat radii, not {self.epsilon}.")
