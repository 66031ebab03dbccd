# SPDX-License-Identifier: GPL-3.0-or-later
"""The optional properties of a material's surface, besides roughness, metallic and reflectance."""

from __future__ import annotations

from dataclasses import dataclass

from .numbers import MAX_FACTOR, check_radiance, check_range


@dataclass(frozen=True)
class Finish:
    """The optional parts of a surface like Blender's Principled BSDF; without arguments it has none of them.

    specular_tint: (3,) multiplies the reflectance of a dielectric at normal incidence, and that of a metal at 82
        degrees.
    coat: how much of the surface a clear varnish covers, 0 to 1. coat_roughness, coat_ior: its own.
    coat_tint: (3,) what it lets through of light that crosses it straight.
    sheen: how much of the surface fibres cover, 0 to 1. sheen_roughness: of their layer. sheen_tint: (3,) their colour.
    transmission: how much of what is not metal is glass, 0 to 1. tint_power: a crossing of the surface keeps the base
        colour to this power; 0.5 for light that crosses a wall's two surfaces to keep the base colour.
    is_thin: what is glass is a sheet, which light enters and leaves at once, whatever its shape.
    translucency: how much of the diffuse light leaves on the other side of the surface, 0 to 1.
    """

    specular_tint: tuple[float, float, float] = (1.0, 1.0, 1.0)
    coat: float = 0.0
    coat_roughness: float = 0.03
    coat_ior: float = 1.5
    coat_tint: tuple[float, float, float] = (1.0, 1.0, 1.0)
    sheen: float = 0.0
    sheen_roughness: float = 0.5
    sheen_tint: tuple[float, float, float] = (1.0, 1.0, 1.0)
    transmission: float = 0.0
    tint_power: float = 0.5
    is_thin: bool = False
    translucency: float = 0.0

    def __post_init__(self):
        for name in (
            "coat",
            "coat_roughness",
            "sheen",
            "sheen_roughness",
            "transmission",
            "tint_power",
            "translucency",
        ):
            check_range(f"A finish's {name}", getattr(self, name), 0.0, 1.0)
        check_range("A finish's coat_ior", self.coat_ior, 1.0, 1e6)
        for name in ("specular_tint", "coat_tint", "sheen_tint"):
            check_range(f"A finish's {name}", getattr(self, name), 0.0, MAX_FACTOR)
            check_radiance(f"A finish's {name}", getattr(self, name))

    @property
    def layers(self) -> tuple[str, ...]:
        """The names of the optional parts that it has."""
        tint = ("specular_tint",) if tuple(self.specular_tint) != PLAIN.specular_tint else ()
        return (*tint, *(n for n in ("coat", "sheen", "transmission", "translucency") if getattr(self, n) > 0))

    @property
    def numbers(self) -> tuple[float, ...]:
        """The finish as 16 numbers, which can be averaged; shaders have them in fours.

        Specular tint, coat  |  coat's tint, its roughness  |  its index of refraction, transmission, that times
        its tint's power, translucency  |  sheen times its tint, its roughness.
        """
        coat = self.coat, *self.coat_tint, self.coat_roughness, self.coat_ior
        through = self.transmission, self.transmission * self.tint_power, self.translucency
        return *self.specular_tint, *coat, *through, *(self.sheen * c for c in self.sheen_tint), self.sheen_roughness


#: Without any of them.
PLAIN = Finish()
