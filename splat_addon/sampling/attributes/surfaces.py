# SPDX-License-Identifier: GPL-3.0-or-later
"""What a material is made of, as far as surfels keep it: each input of a Principled shader as a `Channel`.

A channel is a product of a constant, textures and vertex colours: what importers and painters make. `sampler` gives its
value at samples of the surface.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...images import Image

#: What a renderer makes of a colour where one number is asked for: luminance of Rec. 709.
LUMINANCE = (0.2126, 0.7152, 0.0722, 0.0)
RED, GREEN, BLUE, ALPHA = ((*np.eye(4)[k].tolist(),) for k in range(4))


#: name -> what a coordinate becomes: where an image repeats along one side and not along the other.
WRAPS = {
    "REPEAT": lambda coordinate: coordinate - np.floor(coordinate),
    "MIRROR": lambda coordinate: 1 - np.abs(coordinate - 2 * np.floor(coordinate / 2) - 1),
    "NONE": lambda coordinate: coordinate,
}


@dataclass(frozen=True, eq=False)
class Texture:
    """An image on the surface.

    layer: which of the mesh's texture coordinates. placement: (2, 3) matrix from those to the image's, None: the same.
    wraps: how the image's u and v are brought to 0..1 before it is looked up, names in `WRAPS`; None: they are not.
    weights: of r, g, b, a, whose sum is the factor of a channel of one number; None: the components themselves.
    uses_alpha: False: the alpha is not looked at, so that what lies outside a clipped image is black and not clear.
    """

    image: Image
    layer: int = 0
    placement: np.ndarray | None = None
    weights: tuple[float, float, float, float] | None = None
    uses_alpha: bool = True
    wraps: tuple[str, str] | None = None

    def __post_init__(self):
        if self.wraps is not None and not (len(self.wraps) == 2 and set(self.wraps) <= set(WRAPS)):
            raise ValueError(f"A texture's wraps must be two of {', '.join(WRAPS)}, not {self.wraps!r}.")
        if self.placement is not None:
            placement = np.asarray(self.placement, np.float64)
            if placement.shape != (2, 3) or not np.isfinite(placement).all():
                raise ValueError(f"A texture's placement must be 2 x 3 finite numbers, not {self.placement!r}.")
            object.__setattr__(self, "placement", placement)


@dataclass(frozen=True)
class VertexColors:
    """Colours at the mesh's corners. layer: which of them. weights: as a `Texture`'s. uses_alpha: False: alpha is 1."""

    layer: int = 0
    weights: tuple[float, float, float, float] | None = None
    uses_alpha: bool = True


@dataclass(frozen=True, eq=False)
class Channel:
    """A quantity of the surface. value: 1, 3 or 4 numbers, times each of the factors whose layer the mesh has.

    factors: one or several. A factor without weights gives as many of its components as the value has.
    """

    value: tuple[float, ...]
    factors: Texture | VertexColors | tuple[Texture | VertexColors, ...] = ()

    def __post_init__(self):
        if len(self.value) not in (1, 3, 4) or not np.isfinite(self.value).all():
            raise ValueError(f"A channel's value must be 1, 3 or 4 finite numbers, not {self.value!r}.")
        is_one = isinstance(self.factors, Texture | VertexColors)
        object.__setattr__(self, "factors", (self.factors,) if is_one else tuple(self.factors))


#: How the colour of a normal map's pixel is read.
SPACES = ("TANGENT", "OBJECT")


@dataclass(frozen=True, eq=False)
class NormalMap:
    """Detail of the shading normal: twice the colour less one, in the frame of `tangents` or in object space.

    layer: of the texture coordinates whose directions the tangents follow. strength: 0 leaves the normal as it is.
    """

    color: Channel
    strength: float = 1.0
    layer: int = 0
    space: str = "TANGENT"

    def __post_init__(self):
        if not (np.isfinite(self.strength) and self.strength >= 0):
            raise ValueError(f"A normal map's strength must be a finite number, 0 or more, not {self.strength}.")
        if self.space not in SPACES:
            raise ValueError(f"A normal map's space must be one of {', '.join(SPACES)}, not {self.space!r}.")


@dataclass(frozen=True, eq=False)
class Surface:
    """One material.

    color: scene-linear r, g, b, a. opacity: one number that multiplies the colour's alpha. roughness, metallic: one
    number. emission: scene-linear radiance. None: not given, which is no opacity but the colour's own, Principled's
    default of the others, and no normal map.
    """

    color: Channel = Channel((0.8, 0.8, 0.8, 1.0))
    opacity: Channel | None = None
    roughness: Channel | None = None
    metallic: Channel | None = None
    emission: Channel | None = None
    normal_map: NormalMap | None = None

    def __post_init__(self):
        for name, count in _COUNTS.items():
            channel = getattr(self, name)
            if channel is not None and len(channel.value) != count:
                raise ValueError(f"A surface's {name} has {count} numbers, not {len(channel.value)}.")

    @property
    def color_texture(self) -> Texture | None:
        """The one image whose colours, times a constant, are the surface's; None where there is more or less to it."""
        factors = self.color.factors
        is_one = len(factors) == 1 and isinstance(factors[0], Texture) and factors[0].weights is None
        return factors[0] if is_one else None

    def channels(self) -> dict[str, Channel]:
        """Those that are given, by name; that of the normal map as "normal_map"."""
        given = {name: getattr(self, name) for name in _COUNTS if getattr(self, name) is not None}
        return given if self.normal_map is None else given | {"normal_map": self.normal_map.color}


_COUNTS = {"color": 4, "opacity": 1, "roughness": 1, "metallic": 1, "emission": 3}
