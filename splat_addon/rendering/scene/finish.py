# SPDX-License-Identifier: GPL-3.0-or-later
"""The optional properties of a material's surface, besides roughness, metallic and reflectance."""

from __future__ import annotations

from dataclasses import astuple, dataclass

import numpy as np


@dataclass(frozen=True)
class Finish:
    """The optional parts of a surface like Blender's Principled BSDF; without arguments it has none of them.

    specular_tint: (3,) multiplies the reflectance of a dielectric at normal incidence, and that of a metal at 82
        degrees.
    coat: how much of the surface a clear varnish covers, 0 to 1. coat_roughness, coat_ior: its own.
    coat_tint: (3,) what it lets through of light that crosses it straight.
    sheen: how much of the surface fibres cover, 0 to 1. sheen_roughness: of their layer. sheen_tint: (3,) their colour.
    """

    specular_tint: tuple[float, float, float] = (1.0, 1.0, 1.0)
    coat: float = 0.0
    coat_roughness: float = 0.03
    coat_ior: float = 1.5
    coat_tint: tuple[float, float, float] = (1.0, 1.0, 1.0)
    sheen: float = 0.0
    sheen_roughness: float = 0.5
    sheen_tint: tuple[float, float, float] = (1.0, 1.0, 1.0)

    def __post_init__(self):
        numbers = [number for value in astuple(self) for number in np.atleast_1d(value)]
        are_colors = len(self.specular_tint) == len(self.coat_tint) == len(self.sheen_tint) == 3
        if not (np.isfinite(numbers).all() and min(numbers) >= 0 and are_colors):
            raise ValueError(f"A finish needs finite numbers of 0 and more, and colours of 3, not {self}.")

    @property
    def layers(self) -> tuple[str, ...]:
        """The names of the optional parts that it has."""
        tint = ("specular_tint",) if tuple(self.specular_tint) != PLAIN.specular_tint else ()
        return (*tint, *(name for name in ("coat", "sheen") if getattr(self, name) > 0))

    @property
    def numbers(self) -> tuple[float, ...]:
        """The finish as 16 numbers, which can be averaged; shaders have them in fours.

        Specular tint, coat  |  coat's tint, its roughness  |  its index of refraction, 0, 0, 0  |  sheen times
        its tint, its roughness.
        """
        coat = self.coat, *self.coat_tint, self.coat_roughness, self.coat_ior, 0.0, 0.0, 0.0
        return *self.specular_tint, *coat, *(self.sheen * c for c in self.sheen_tint), self.sheen_roughness


#: Without any of them.
PLAIN = Finish()
