# SPDX-License-Identifier: GPL-3.0-or-later
"""What a material's surface has beside roughness, metallic and reflectance."""

from __future__ import annotations

from dataclasses import astuple, dataclass

import numpy as np


@dataclass(frozen=True)
class Finish:
    """The optional parts of a surface like Blender's Principled BSDF; without arguments it has none of them.

    specular_tint: (3,) multiplies the reflectance of a dielectric at normal incidence, and that of a metal at 82
        degrees.
    """

    specular_tint: tuple[float, float, float] = (1.0, 1.0, 1.0)

    def __post_init__(self):
        numbers = [number for value in astuple(self) for number in np.atleast_1d(value)]
        if not (np.isfinite(numbers).all() and min(numbers) >= 0 and len(self.specular_tint) == 3):
            raise ValueError(f"A finish needs finite numbers of 0 and more, and colours of 3, not {self}.")

    @property
    def layers(self) -> tuple[str, ...]:
        """The parts that it has."""
        return ("specular_tint",) if tuple(self.specular_tint) != PLAIN.specular_tint else ()

    @property
    def numbers(self) -> tuple[float, ...]:
        """4 numbers a texel, in which finishes are mixed: r, g, b of the specular tint, 0."""
        return (*self.specular_tint, 0.0)


#: Without any of them.
PLAIN = Finish()
