# SPDX-License-Identifier: GPL-3.0-or-later
"""Conversion settings: the same properties on the operator and, for the sidebar, on the scene."""

from __future__ import annotations

import math

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty

from ...sampling import (
    LARGEST_ERROR,
    LEAST_ERROR,
    LEAST_GRAZING_ANGLE,
    REDUCTIONS,
    SamplingOptions,
)
from ..density import Density, Measure
from ..density_properties import (
    DENSITIES,
    normal_fields_property,
    pixels_property,
    resolution_property,
    spacing_property,
    splat_size_property,
    texture_mapped_property,
)
from ..ids import CONVERSION_SETTINGS, TEXTS
from ..registration import with_property
from .choices import Choices
from .quality import QUALITIES, choose_error, choose_quality, error_of, quality_of


def follow_property():
    return BoolProperty(
        name="Follow Source",
        description=(
            "Let the surfels follow their source, with its parent, animation and constraints. If off, they are a "
            "frozen copy"
        ),
        default=True,
    )


class ConversionProperties:
    """A mix-in; Blender collects the annotations of all bases."""

    density: EnumProperty(
        name="Density",
        description="How the distance between surfels is chosen",
        items=[(name, density.label, density.description, density.number) for name, density in DENSITIES.items()],
        default="AUTOMATIC",
    )
    resolution: resolution_property("the object's", min=0, soft_max=4096)
    spacing: spacing_property(", in the units of the chosen space", min=0.0)
    count: IntProperty(
        name="Count",
        description="Approximate number of surfels for each object",
        default=100_000,
        min=0,
        soft_min=1_000,
        soft_max=10_000_000,
    )
    pixels: pixels_property("Doubling it makes a quarter of the surfels", min=0.0, soft_min=0.25)
    join: BoolProperty(
        name="Join",
        description=(
            "Make one surfel object of the whole selection, in the place of the active object. The density then "
            "refers to the whole"
        ),
        default=False,
    )
    space: EnumProperty(
        name="Space",
        translation_context=TEXTS,
        description="The space in which surfels are spaced evenly and lengths are measured",
        items=(
            ("OBJECT", "Object", "The object's own space, so that its scale also scales the spacing"),
            (
                "WORLD",
                "World",
                "World space, so that scaled objects are as dense as others; the surfel object has a scale of 1",
            ),
        ),
        default="OBJECT",
    )
    reduction: EnumProperty(
        name="Reduction",
        description="The surface is sampled along three axes; this chooses which of these samples become surfels",
        items=[(name.upper(), reduction.label, reduction.description) for name, reduction in REDUCTIONS.items()],
        default=SamplingOptions.reduction.upper(),
    )
    grazing_angle: FloatProperty(
        name="Grazing Angle",
        description=(
            "Drop samples where the normal of the surface is more than this angle away from the axis of sampling. "
            "90 degrees keeps all samples"
        ),
        subtype="ANGLE",
        default=SamplingOptions.grazing_angle,
        min=LEAST_GRAZING_ANGLE,
        max=math.pi / 2,
    )
    use_adaptive: BoolProperty(
        name="Adaptive",
        description=(
            "Use larger surfels inside faces that are flat and look the same everywhere, as those of buildings and"
            " machines"
        ),
        default=SamplingOptions.tolerance is not None,
    )
    tolerance: FloatProperty(
        name="Tolerance",
        description=(
            "How far a larger surfel may be from the surface that it covers, in the units of the chosen space. Above 0,"
            " surfels also become larger across nearly flat faces, but conversion takes longer"
        ),
        default=SamplingOptions.tolerance.distance,
        min=0.0,
        soft_max=1.0,
        precision=5,
        step=0.01,
    )
    bake_materials: BoolProperty(
        name="Bake Materials",
        description=(
            "Let Cycles bake material inputs that cannot be read directly, such as Ambient Occlusion. This is "
            "slow: each input may take longer than the rest of the conversion"
        ),
        default=False,
    )
    texture_mapped: texture_mapped_property()
    normal_fields: normal_fields_property()
    clips_edges: BoolProperty(
        name="End at Edges",
        description=(
            "End surfels at creases, at borders between colours and at open borders, and make their blend depth no "
            "larger than their surface needs. Edges stay sharp, but conversion takes longer, and frames take slightly "
            "longer"
        ),
        default=SamplingOptions.crease_angle is not None,
    )
    crease_angle: FloatProperty(
        name="Crease Angle",
        description=(
            "A crease is where the surface or its shading turns by more than this angle. Beside faces that are "
            "larger than a surfel a smaller angle is enough, down to a sixth of this one"
        ),
        subtype="ANGLE",
        default=SamplingOptions.crease_angle,
        min=math.radians(1),
        max=math.pi,
    )
    splat_size: splat_size_property(
        "Half-axis of a splat, in spacings. 1.25 covers every surface; smaller splats are sharper but leave dark "
        "specks. The papers' surfel quads have 0.5",
        soft_max=2.0,
    )
    source: EnumProperty(
        name="Source",
        description="What happens to the object that was converted",
        items=(
            ("KEEP", "Keep", "Leave the object as it is, in the same place as its surfels"),
            ("HIDE", "Hide", "Hide the object in the viewport and in renders, so that only its surfels are seen"),
        ),
        default="KEEP",
    )
    follow: follow_property()


#: Properties that the operator and the scene share.
PROPERTY_NAMES = tuple(ConversionProperties.__annotations__)


def choices(properties: ConversionProperties) -> Choices:
    """The properties as `Choices`."""
    density = _density(properties)
    return Choices(
        density=density,
        splat_size=properties.splat_size,
        reduction=properties.reduction.lower(),
        grazing_angle=properties.grazing_angle,
        tolerance=_tolerance(properties, density),
        texture_mapped=properties.texture_mapped,
        normal_fields=properties.normal_fields,
        crease_angle=properties.crease_angle if properties.clips_edges else None,
        space=properties.space.lower(),
        join=properties.join,
        bake=properties.bake_materials,
    )


def _tolerance(properties: ConversionProperties, density: Density) -> float | None:
    """The tolerance for larger surfels, or None if all have the same size. Those inside flat faces alone, which a
    tolerance of 0 asks for, need blend depths; where samples are merged or counted, none replaces others."""
    are_possible = properties.clips_edges and REDUCTIONS[properties.reduction.lower()].merge is None
    is_wanted = properties.tolerance > 0 or (are_possible and density.measure != Measure.COUNT)
    return properties.tolerance if properties.use_adaptive and is_wanted else None


def _density(properties: ConversionProperties) -> Density:
    chosen = chosen_density(properties)
    name = DENSITIES[chosen].property
    return Density(Measure.AUTOMATIC if chosen == "AUTOMATIC" else Measure(name), getattr(properties, name))


def chosen_density(properties: ConversionProperties) -> str:
    """A name in `DENSITIES`. If a script gives the operator a number without a kind, the number decides."""
    chosen = properties.density
    if isinstance(properties, bpy.types.Operator) and not properties.properties.is_property_set("density"):
        is_set = properties.properties.is_property_set
        given = [name for name, kind in DENSITIES.items() if kind.property != "pixels" and is_set(kind.property)]
        chosen = given[0] if len(given) == 1 else chosen
    return chosen


class SurfelConversionSettings(ConversionProperties, bpy.types.PropertyGroup):
    """The settings of the sidebar for the next conversion, and those that a surfel object was converted with."""

    quality: EnumProperty(
        name="Quality",
        description="How many surfels there are; under Advanced is a density for everything else",
        items=[
            *((name, one.label, one.description, k) for k, (name, one) in enumerate(QUALITIES.items())),
            ("OTHER", "Other", "The density chosen under Advanced", len(QUALITIES)),
        ],
        get=quality_of,
        set=choose_quality,
    )
    error: FloatProperty(
        name="Error",
        description=(
            "How far surfels look from the mesh, as the mean perceived difference over what an object covers, "
            "and the density that this takes. Larger models are closer than it says"
        ),
        min=LEAST_ERROR,
        max=LARGEST_ERROR,
        precision=3,
        get=error_of,
        set=choose_error,
    )


register, unregister = with_property(bpy.types.Scene, CONVERSION_SETTINGS, SurfelConversionSettings)
