# SPDX-License-Identifier: GPL-3.0-or-later
"""The conversion's settings: the same properties on the operator and, for the sidebar, on the scene."""

from __future__ import annotations

import math
from typing import NamedTuple

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty

from ...sampling import DEFAULT_CREASE_ANGLE, DEFAULT_GRAZING_ANGLE, DEFAULT_SPLAT_SIZE, LEAST_GRAZING_ANGLE, REDUCTIONS
from ..ids import CONVERSION_SETTINGS
from .automatic_density import FALLBACK_RESOLUTION, MOST_SURFELS
from .mesh_conversion import Choices


class Density(NamedTuple):
    """A way to say how close surfels lie: for people, the property that holds the number, and what a .blend keeps."""

    label: str
    description: str
    property: str
    number: int


DENSITIES = {
    "AUTOMATIC": Density(
        "Automatic",
        "As fine as the scene's camera needs on the current frame, a quarter finer where something moves. "
        f"Resolution {FALLBACK_RESOLUTION} where no camera sees the object, and {MOST_SURFELS:,} surfels at most",
        "pixels",
        4,
    ),
    "RESOLUTION": Density(
        "Resolution", "The same number of surfels along the longest edge, whatever the object's size", "resolution", 0
    ),
    "SPACING": Density("Spacing", "The same distance between surfels in every object", "spacing", 1),
    "COUNT": Density("Count", "The same number of surfels for each object", "count", 2),
    "CAMERA": Density(
        "Camera",
        "As fine as the scene's camera and resolution need on the current frame, where each object comes closest",
        "pixels",
        3,
    ),
}


class ConversionProperties:
    """A mix-in; Blender collects the annotations of all bases."""

    density: EnumProperty(
        name="Density",
        description="How it is said how close the surfels lie",
        items=[(name, density.label, density.description, density.number) for name, density in DENSITIES.items()],
        default="AUTOMATIC",
    )
    resolution: IntProperty(
        name="Resolution",
        description=(
            "Grid cells along the longest edge of the object's bounding box. "
            "Twice as many shows details half the size, for four times the surfels, memory and time: "
            "a million surfels take 0.2 to 0.6 s of a processor and 140 MB"
        ),
        default=256,
        min=0,
        soft_min=8,
        soft_max=4096,
    )
    spacing: FloatProperty(
        name="Spacing",
        description=(
            "Distance between surfels, in the units of the chosen space. "
            "Half of it shows details half the size, for four times the surfels, memory and time"
        ),
        default=0.01,
        min=0.0,
        soft_max=10.0,
        precision=4,
        step=0.1,
    )
    count: IntProperty(
        name="Count",
        description="How many surfels each object becomes, within about 1 in 100",
        default=100_000,
        min=0,
        soft_min=1_000,
        soft_max=10_000_000,
    )
    pixels: FloatProperty(
        name="Pixels per Surfel",
        description=(
            "Distance between surfels in pixels of the render, where the object comes closest to the scene's camera. "
            "Twice as many pixels make a quarter of the surfels"
        ),
        default=0.75,
        min=0.0,
        soft_min=0.25,
        soft_max=10.0,
    )
    join: BoolProperty(
        name="Join",
        description=(
            "Make one surfel object of everything selected, in the place of the active object and evenly spaced in the "
            "world, with the materials of all. The density then means the whole: its longest edge, its count. Takes "
            "up to a third longer: 20 objects, 1.8 million surfels, 7.4 s joined and 5.7 s apart"
        ),
        default=False,
    )
    space: EnumProperty(
        name="Space",
        description="Where surfels are spaced evenly, and whose units lengths are in",
        items=(
            ("OBJECT", "Object", "The object's own space: its scale spreads the surfels, unevenly if it is uneven"),
            (
                "WORLD",
                "World",
                "The world: scaled objects are as dense as others. The surfel object has a scale of 1",
            ),
        ),
        default="OBJECT",
    )
    reduction: EnumProperty(
        name="Reduction",
        description="Which samples of the three axes become surfels",
        items=[(name.upper(), reduction.label, reduction.description) for name, reduction in REDUCTIONS.items()],
        default="NORMAL",
    )
    grazing_angle: FloatProperty(
        name="Grazing Angle",
        description=(
            "Samples are left out where the surface is turned farther than this from their axis. 54.7 degrees keeps "
            "hardly more than one axis everywhere, 90 degrees keeps everything"
        ),
        subtype="ANGLE",
        default=DEFAULT_GRAZING_ANGLE,
        min=LEAST_GRAZING_ANGLE,
        max=math.pi / 2,
    )
    use_adaptive: BoolProperty(
        name="Adaptive",
        description=(
            "Larger surfels, up to 8 spacings, where the surface is flat and its colour even. Leaves a third of the "
            "surfels of a building or a machine and nearly all of a scan. Takes 2 to 3 s longer for a million surfels"
        ),
        default=False,
    )
    tolerance: FloatProperty(
        name="Tolerance",
        description=(
            "How far the surface may be from flat where surfels become larger, in the units of the chosen space"
        ),
        default=0.001,
        min=0.0,
        soft_max=1.0,
        precision=5,
        step=0.01,
    )
    bake_materials: BoolProperty(
        name="Bake Materials",
        description=(
            "Let Cycles bake the inputs of materials that are no plain product of images, colour attributes and "
            "numbers, such as procedural textures and bumps, at each surfel; otherwise the sockets' plain values are "
            "used. Adds about 35 s for a million surfels and each such input, while progress stands still"
        ),
        default=False,
    )
    texture_mapped: BoolProperty(
        name="Texture-Mapped",
        description=(
            "Surfels whose base colour is one image look it up at every pixel of a render, instead of keeping one "
            "colour each, and an edited image shows at once. A globe of text is 20 to 28 dB truer for it, at 3.6 to 6 "
            "times the time of a frame in software; sampling takes twice as long. With Adaptive, a flat board of text "
            "keeps 1 surfel in 13"
        ),
        default=False,
    )
    clips_edges: BoolProperty(
        name="End at Edges",
        description=(
            "Surfels end at creases, borders of colours and open borders, and blend as deep as their surface asks for. "
            "It takes 8 to 12 bytes a surfel, and a frame takes up to 1.1 times as long"
        ),
        default=True,
    )
    crease_angle: FloatProperty(
        name="Crease Angle",
        description="Where the surface or its shading turns by more, there is an edge; sharp edges break the shading",
        subtype="ANGLE",
        default=DEFAULT_CREASE_ANGLE,
        min=math.radians(1),
        max=math.pi,
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
        description="What happens to the object that was converted",
        items=(
            ("KEEP", "Keep", "Leave the object as it is; it and its surfels lie in the same place"),
            ("HIDE", "Hide", "Hide the object in the viewport and in renders, so that only its surfels are seen"),
        ),
        default="KEEP",
    )


#: What the operator and the scene both have.
PROPERTY_NAMES = tuple(ConversionProperties.__annotations__)


def choices(properties: ConversionProperties) -> Choices:
    """What the properties ask for."""
    return Choices(
        density=_density(properties),
        splat_size=properties.splat_size,
        reduction=properties.reduction.lower(),
        grazing_angle=properties.grazing_angle,
        tolerance=properties.tolerance if properties.use_adaptive else None,
        texture_mapped=properties.texture_mapped,
        crease_angle=properties.crease_angle if properties.clips_edges else None,
        space=properties.space.lower(),
        join=properties.join,
        bake=properties.bake_materials,
    )


def _density(properties: ConversionProperties) -> dict[str, float]:
    """The kind of density and its number. A script that gives the operator a number, and not its kind, means that."""
    chosen = properties.density
    if isinstance(properties, bpy.types.Operator) and not properties.properties.is_property_set("density"):
        is_set = properties.properties.is_property_set
        given = [name for name, kind in DENSITIES.items() if kind.property != "pixels" and is_set(kind.property)]
        chosen = given[0] if len(given) == 1 else chosen
    name = DENSITIES[chosen].property
    return {"automatic" if chosen == "AUTOMATIC" else name: getattr(properties, name)}


def draw_properties(layout: bpy.types.UILayout, properties: ConversionProperties) -> None:
    """The settings in Blender's own style, for the sidebar and the redo panel."""
    layout.use_property_split = True
    layout.use_property_decorate = False
    layout.prop(properties, "density")
    layout.prop(properties, DENSITIES[properties.density].property)
    layout.prop(properties, "join")
    if not properties.join:
        layout.row().prop(properties, "space", expand=True)
    layout.prop(properties, "reduction")
    if REDUCTIONS[properties.reduction.lower()].has_angle:
        layout.prop(properties, "grazing_angle")
    layout.prop(properties, "use_adaptive")
    if properties.use_adaptive:
        layout.prop(properties, "tolerance")
    layout.prop(properties, "bake_materials")
    layout.prop(properties, "texture_mapped")
    layout.prop(properties, "clips_edges")
    if properties.clips_edges:
        layout.prop(properties, "crease_angle")
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
