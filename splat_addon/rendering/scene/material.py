# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials and textures of surfaces."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...images import Image
from .finish import PLAIN, Finish
from .numbers import MAX_FACTOR, MAX_INDEX, check_radiance, check_range
from .style import AS_THE_PICTURE, Style


def reflectance(ior: float) -> float:
    """Reflectance of a dielectric at normal incidence (Fresnel)."""
    return ((ior - 1) / (ior + 1)) ** 2


@dataclass(frozen=True)
class Material:
    """How a surface reflects and emits light; its base colour is the surfels' own.

    roughness, metallic: 0 to 1. ior: index of refraction of the dielectric coat, which sets its reflectance at normal
        incidence, ((ior - 1) / (ior + 1))^2. emission: scene-linear radiance, the same in all directions.
    index: what the frame's `material_index` shows of it. finish: what `principled` shading adds to it. style: its own
        toon shading and lines. cuts_holes: it is transparent only where its image is, like a card of leaves: its
        surfels are not blended in layers, but drawn or not, as often as they are opaque.
    Surfels may have their own roughness, metallic and emission, which take the place of these.
    """

    roughness: float = 0.5
    metallic: float = 0.0
    ior: float = 1.5
    emission: tuple[float, float, float] = (0.0, 0.0, 0.0)
    index: int = 0
    finish: Finish = PLAIN
    style: Style = AS_THE_PICTURE
    cuts_holes: bool = False

    def __post_init__(self):
        check_range("A material's roughness and metallic", (self.roughness, self.metallic), 0.0, 1.0)
        check_range("A material's index of refraction", self.ior, 1e-6, 1e6)
        check_radiance("A material's emission", self.emission)
        check_range("A material's index", self.index, -MAX_INDEX, MAX_INDEX, is_whole=True)


@dataclass(frozen=True, eq=False)
class SurfaceTexture:
    """A base colour that is looked up for every pixel, for surfels or polygons with texture coordinates.

    factor: (3,) scene-linear, multiplies the image. is_cut_out: polygons are transparent where the image is. Surfels
        have opacities of their own.
    """

    image: Image
    factor: tuple[float, float, float] = (1.0, 1.0, 1.0)
    is_cut_out: bool = False

    def __post_init__(self):
        check_radiance("A texture's factor", self.factor)

    @cached_property
    def brightest(self) -> float:
        """The largest component of any texel times the factor."""
        return float(np.max(self.image.pixels[..., :3].max(axis=(0, 1)) * self.factor))


@dataclass(frozen=True, eq=False)
class GlossTexture:
    """Roughness and metallic of polygons: red and green of an image, times factors from 0 to 1; None leaves what the
    corners have."""

    image: Image
    roughness: float | None = 1.0
    metallic: float | None = 1.0
    is_cut_out = False

    def __post_init__(self):
        check_range("Factors of roughness and metallic", [f for f in (self.roughness, self.metallic) if f], 0.0, 1.0)

    @property
    def factor(self) -> tuple[float, float, float]:
        """Both, where textures have a factor; -1 for None."""
        return (*(-1.0 if factor is None else factor for factor in (self.roughness, self.metallic)), 0.0)


@dataclass(frozen=True, eq=False)
class NormalTexture:
    """A normal map in tangent space: normals are 2 * colour - 1. strength: 0 leaves the normal as it is."""

    image: Image
    strength: float = 1.0
    is_cut_out = False

    def __post_init__(self):
        check_range("A normal map's strength", self.strength, 0.0, MAX_FACTOR)

    @property
    def factor(self) -> tuple[float, float, float]:
        """Its strength, where textures have a factor."""
        return (self.strength,) * 3
