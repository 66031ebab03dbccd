# SPDX-License-Identifier: GPL-3.0-or-later
"""A picture of a lit ball, from which matcap shading takes its colours (Sloan et al. 2001)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .numbers import MAX_RADIANCE, check_range
from .texels import opaque_texels


@dataclass(frozen=True, eq=False)
class Matcap:
    """pixels: (h, w, 3) linear rgb, row 0 at the bottom; the ball fills the picture. Compared by identity."""

    pixels: np.ndarray

    def __post_init__(self):
        pixels = np.ascontiguousarray(self.pixels, np.float32)
        if pixels.ndim != 3 or pixels.shape[2] != 3 or 0 in pixels.shape:
            raise ValueError(f"A matcap's pixels must be (height, width, 3), not {pixels.shape}.")
        check_range("A matcap's pixels", pixels, -MAX_RADIANCE, MAX_RADIANCE)
        object.__setattr__(self, "pixels", pixels)

    def texels(self) -> np.ndarray:
        """(h, w, 4) in the layout of the device."""
        return opaque_texels(self.pixels)
