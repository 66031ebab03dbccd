# SPDX-License-Identifier: GPL-3.0-or-later
"""Describes a material as far as surfels can store it: each input of a Principled shader as a `Channel`.

A channel is a product of a constant, textures and vertex colours, which is what importers and painters produce, or a
graph of shading nodes. `sampler` evaluates it at samples of the surface.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...images import Image
from ...shading_nodes import Graph

RED, GREEN, BLUE, ALPHA = ((*np.eye(4)[k].tolist(),) for k in range(4))


#: name -> wrapping of a coordinate, for images that repeat in one direction but not in the other.
WRAPS = {
    "REPEAT": lambda coordinate: coordinate - np.floor(coordinate),
    "MIRROR": lambda coordinate: 1 - np.abs(coordinate - 2 * np.floor(coordinate / 2) - 1),
    "NONE": lambda coordinate: coordinate,
}


@dataclass(frozen=True, eq=False)
class Texture:
    """An image on the surface.

    layer: index of the mesh's texture coordinates. placement: (2, 3) matrix from those to the image's coordinates;
        None: identity.
    wraps: how the image's u and v are wrapped to 0..1 before the lookup, names in `WRAPS`; None: no wrapping.
    weights: for r, g, b, a, to reduce the pixel to a single factor; None: use the components themselves.
    uses_alpha: if False, alpha is ignored, so that the outside of a clipped image is black instead of transparent.
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
    """Colours at the mesh's corners.

    layer: index of the colour layer. weights: as in `Texture`. uses_alpha: if False, alpha is taken as 1.
    """

    layer: int = 0
    weights: tuple[float, float, float, float] | None = None
    uses_alpha: bool = True


@dataclass(frozen=True, eq=False)
class Computed:
    """What a graph of shading nodes makes of the mesh's layers: one number, or a colour."""

    graph: Graph
    weights = None


Factor = Texture | VertexColors | Computed


@dataclass(frozen=True, eq=False)
class Channel:
    """A material quantity: a constant times factors.

    value: 1, 3 or 4 numbers, multiplied by each factor whose layer the mesh has.
    factors: any number; a factor without weights supplies as many components as the value has.
    """

    value: tuple[float, ...]
    factors: Factor | tuple[Factor, ...] = ()

    def __post_init__(self):
        if len(self.value) not in (1, 3, 4) or not np.isfinite(self.value).all():
            raise ValueError(f"A channel's value must be 1, 3 or 4 finite numbers, not {self.value!r}.")
        is_one = isinstance(self.factors, Factor)
        object.__setattr__(self, "factors", (self.factors,) if is_one else tuple(self.factors))


#: How the colour of a normal map's pixel is interpreted.
SPACES = ("TANGENT", "OBJECT")


@dataclass(frozen=True, eq=False)
class NormalMap:
    """Detail of the shading normal: 2 * colour - 1, in the frame of `tangents` or in object space.

    layer: the texture coordinates whose directions the tangents follow. strength: 0 leaves the normal unchanged.
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
        number. emission: scene-linear radiance. A channel of None is not given: opacity is then the colour's own alpha,
        the others take Principled's defaults, and there is no normal map.
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
        """The single image that, times a constant, gives the surface's colours; None if the colour is anything else."""
        factors = self.color.factors
        is_one = len(factors) == 1 and isinstance(factors[0], Texture) and factors[0].weights is None
        return factors[0] if is_one else None

    def channels(self) -> dict[str, Channel]:
        """The channels that are given, by name; the one of the normal map is called "normal_map"."""
        given = {name: getattr(self, name) for name in _COUNTS if getattr(self, name) is not None}
        return given if self.normal_map is None else given | {"normal_map": self.normal_map.color}


_COUNTS = {"color": 4, "opacity": 1, "roughness": 1, "metallic": 1, "emission": 3}
