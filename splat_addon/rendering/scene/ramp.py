# SPDX-License-Identifier: GPL-3.0-or-later
"""A ramp of colours, looked up by the amount of light on a surface (Botsch et al. 2005, section 6)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .numbers import MAX_RADIANCE, check_range
from .texels import opaque_texels

#: Weights of linear Rec. 709 (ITU-R BT.709).
LUMINANCE = (0.2126, 0.7152, 0.0722)


@dataclass(frozen=True, eq=False)
class Ramp:
    """colors: (n, 3) linear rgb at n >= 2 even steps from no light to full light, in between linear.
    luminance: weights of linear red, green and blue that make the amount of light.

    Compared by identity.
    """

    colors: np.ndarray
    luminance: tuple[float, float, float] = LUMINANCE

    def __post_init__(self):
        colors = np.ascontiguousarray(self.colors, np.float32)
        if colors.ndim != 2 or colors.shape[1] != 3 or len(colors) < 2:
            raise ValueError(f"A ramp's colors must be (2 or more, 3), not {colors.shape}.")
        check_range("A ramp's colors", colors, 0.0, MAX_RADIANCE)
        check_range("A ramp's weights of luminance", self.luminance, -1.0, 2.0)
        object.__setattr__(self, "colors", colors)

    @classmethod
    def of_steps(cls, count: int, places: int = 256) -> Ramp:
        """A ramp of that many even greys from black to white, as in the toon model."""
        at = np.minimum(np.arange(places) * count // places, count - 1) / (count - 1)
        return cls(np.repeat(at[:, None], 3, axis=1))

    def texels(self) -> np.ndarray:
        """The ramp as (1, n, 4) texels for the device."""
        return opaque_texels(self.colors)[None]
