# SPDX-License-Identifier: GPL-3.0-or-later
"""The conversion's settings: the same properties on the operator and, for the sidebar, on the scene."""

from __future__ import annotations

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty, PointerProperty

from ..sampling import DEFAULT_SPLAT_SIZE
from .conversion import Choices
from .ids import CONVERSION_SETTINGS


class ConversionProperties:
    """A mix-in; Blender collects the annotations of all bases."""

    density: EnumProperty(
        name="Density",
        description="How it is said how close the surfels lie",
        items=(
            (
                "RESOLUTION",
                "Resolution",
                "The same number of surfels along the longest edge, whatever the object's size",
            ),
            ("SPACING", "Spacing", "The same distance between surfels in every object"),
        ),
        default="RESOLUTION",
    )
    resolution: IntProperty(
        name="Resolution",
        description=(
            "Grid cells along the longest edge of the object's bounding box. "
            "Twice as many shows details half the size, for four times the surfels, memory and time"
        ),
        default=256,
        min=0,
        soft_min=8,
        soft_max=4096,
    )
    spacing: FloatProperty(
        name="Spacing",
        description=(
            "Distance between surfels, in the object's own units, before its scale. "
            "Half of it shows details half the size, for four times the surfels, memory and time"
        ),
        default=0.01,
        min=0.0,
        soft_max=10.0,
        precision=4,
        step=0.1,
    )
    splat_size: FloatProperty(
        name="Splat Size",
        description=(
            "Half-axis of a splat, in spacings. 1.25 covers every surface without holes; 1 is sharper, "
            "but leaves 1 point of the surface in 3,000 uncovered, as single dark specks"
        ),
        default=DEFAULT_SPLAT_SIZE,
        min=0.0,
        soft_min=0.5,
        soft_max=2.0,
    )
    source: EnumProperty(
        name="Source",
        description="What happens to the mesh that was converted",
        items=(
            ("KEEP", "Keep", "Leave the mesh as it is; it and its surfels lie in the same place"),
            ("HIDE", "Hide", "Hide the mesh in the viewport and in renders, so that only its surfels are seen"),
        ),
        default="KEEP",
    )


#: What the operator and the scene both have.
PROPERTY_NAMES = tuple(ConversionProperties.__annotations__)


def choices(properties: ConversionProperties) -> Choices:
    """What the properties ask for."""
    key = properties.density.lower()
    return Choices({key: getattr(properties, key)}, properties.splat_size)


def draw_properties(layout: bpy.types.UILayout, properties: ConversionProperties) -> None:
    """The settings in Blender's own style, for the sidebar and the redo panel."""
    layout.use_property_split = True
    layout.use_property_decorate = False
    layout.row().prop(properties, "density", expand=True)
    layout.prop(properties, properties.density.lower())
    layout.prop(properties, "splat_size")
    layout.row().prop(properties, "source", expand=True)


class SurfelConversionSettings(ConversionProperties, bpy.types.PropertyGroup):
    """What the sidebar will convert with."""


_register_classes, _unregister_classes = bpy.utils.register_classes_factory((SurfelConversionSettings,))


def register():
    _register_classes()
    setattr(bpy.types.Scene, CONVERSION_SETTINGS, PointerProperty(type=SurfelConversionSettings))


def unregister():
    delattr(bpy.types.Scene, CONVERSION_SETTINGS)
    _unregister_classes()
