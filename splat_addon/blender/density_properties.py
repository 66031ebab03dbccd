# SPDX-License-Identifier: GPL-3.0-or-later
"""The properties that conversions, live meshes and points have in common, each defined once."""

from __future__ import annotations

from typing import NamedTuple

from bpy.props import BoolProperty, FloatProperty, IntProperty

from ..sampling import DEFAULT_SPLAT_SIZE, SamplingOptions
from .conversion.automatic_density import FALLBACK_RESOLUTION, MOST_SURFELS


class DensityKind(NamedTuple):
    """A way to specify the density: its label, the property that holds the number, and the value stored in a .blend."""

    label: str
    description: str
    property: str
    number: int


DENSITIES = {
    "AUTOMATIC": DensityKind(
        "Automatic",
        "As fine as the scene's camera needs on the current frame, a quarter finer where something moves. "
        f"Resolution {FALLBACK_RESOLUTION} where no camera sees the object, and {MOST_SURFELS:,} surfels at most",
        "pixels",
        4,
    ),
    "RESOLUTION": DensityKind(
        "Resolution", "A number of grid cells along the longest edge of each object's bounding box", "resolution", 0
    ),
    "SPACING": DensityKind("Spacing", "The same distance between surfels in every object", "spacing", 1),
    "COUNT": DensityKind("Count", "A number of surfels for each object", "count", 2),
    "CAMERA": DensityKind(
        "Camera",
        "As fine as the scene's camera and resolution need on the current frame",
        "pixels",
        3,
    ),
}


def resolution_property(whose: str, **limits):
    """The property `resolution`. whose: the object whose bounding box is meant, as in the tooltip."""
    description = (
        f"Grid cells along the longest edge of {whose} bounding box. Doubling it makes four times as many surfels, and "
        "takes four times the memory and time"
    )
    return IntProperty(name="Resolution", description=description, default=256, soft_min=8, **limits)


def spacing_property(units: str, **more):
    """The property `spacing`. units: the end of the tooltip, which says in whose units it is measured."""
    description = f"Distance between surfels{units}. Half of it takes four times the memory and time"
    fields = {"default": 0.01, "soft_max": 10.0, "precision": 4, "step": 0.1}
    return FloatProperty(name="Spacing", description=description, **fields, **more)


def pixels_property(sentence: str, **more):
    """The property for pixels per surfel. sentence: what the tooltip adds."""
    where = "Distance between surfels in pixels of the render, where the object comes closest to the camera"
    fields = {"default": 0.75, "soft_max": 10.0}
    return FloatProperty(name="Pixels per Surfel", description=f"{where}. {sentence}", **fields, **more)


def texture_mapped_property():
    description = (
        "Look up the base colour's image for every pixel instead of once per surfel. Textures are much "
        "sharper, but frames take several times as long without a graphics card"
    )
    return BoolProperty(name="Texture-Mapped", description=description, default=False)


def normal_fields_property():
    description = (
        "Let the shading normal change over each surfel. Surfels that are several pixels large are lit more like "
        "the curved surface that they stand for, but take slightly more memory"
    )
    return BoolProperty(name="Phong Splatting", description=description, default=SamplingOptions.normal_fields)


def splat_size_property(description: str, soft_max: float):
    limits = {"min": 0.0, "soft_min": 0.5, "soft_max": soft_max}
    return FloatProperty(name="Splat Size", description=description, default=DEFAULT_SPLAT_SIZE, **limits)
