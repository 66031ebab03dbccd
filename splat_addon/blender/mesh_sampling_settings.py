# SPDX-License-Identifier: GPL-3.0-or-later
"""How meshes that are not surfels are rendered: scene settings in the render properties, and each object's own."""

from __future__ import annotations

from typing import NamedTuple

import bpy
from bpy.props import EnumProperty, FloatProperty, PointerProperty, StringProperty

from .density import Density, Measure
from .density_properties import (
    DENSITIES,
    normal_fields_property,
    pixels_property,
    resolution_property,
    spacing_property,
    texture_mapped_property,
)
from .doors import on_change
from .enum_values import check_choices
from .geometry.sources import asked_of
from .ids import OBJECT_SETTINGS, RENDER_SETTINGS
from .registration import OVERRIDABLE, with_property
from .scan_color_settings import ScanColorProperties
from .style_properties import SurfelObjectStyle

#: density -> the property of `MeshSamplingProperties` that holds its number, and what that counts.
NUMBERED = {
    "AUTOMATIC": ("mesh_pixels", Measure.AUTOMATIC),
    "RESOLUTION": ("mesh_resolution", Measure.RESOLUTION),
    "SPACING": ("mesh_spacing", Measure.SPACING),
    "CAMERA": ("mesh_pixels", Measure.PIXELS),
}


@on_change("Reading meshes again")
def _read_again(settings, context) -> None:
    """Make a 3D view read the scene again; Blender does not report changes that a script makes."""
    settings.id_data.update_tag()


def _meant(density: str):
    """Choose the density that a number belongs to when a script sets the number."""

    @on_change("Choosing the density")
    def update(settings, context) -> None:
        if settings.mesh_density == "AUTOMATIC":
            settings.mesh_density = density
        _read_again(settings, context)

    return update


#: The numbers match an earlier on/off property in old files.
_MESH_ITEMS = (
    (
        "POLYGONS",
        "Polygons",
        "Draw the triangles among the splats, with the same depth, light and shadows. The alpha of the base "
        "colour's image makes holes; meshes that are transparent in another way, or whose nodes are more than images, "
        "become surfels, unless their object is set to Polygons",
        0,
    ),
    (
        "SURFELS",
        "Surfels",
        (
            "Sample the mesh when it is first drawn; its surfels follow it as it deforms. Frames in which it "
            "deforms take longer"
        ),
        1,
    ),
    ("HIDDEN", "Nothing", "Do not draw them", 2),
)

#: The numbers match earlier files, which had no automatic density.
_NUMBERS = {"RESOLUTION": 0, "SPACING": 1, "CAMERA": 2, "AUTOMATIC": 3}

_DENSITY_ITEMS = [(name, DENSITIES[name].label, DENSITIES[name].description, _NUMBERS[name]) for name in NUMBERED]


class MeshSamplingProperties:
    """A mix-in for the scene's render settings."""

    render_meshes: EnumProperty(
        name="Render Meshes as",
        description="How meshes, curves, texts and metaballs are drawn if they have not been converted",
        items=_MESH_ITEMS,
        default="POLYGONS",
        update=_read_again,
    )
    mesh_density: EnumProperty(
        name="Density",
        description="How the distance between the surfels of meshes is chosen",
        items=_DENSITY_ITEMS,
        default="AUTOMATIC",
        update=_read_again,
    )
    mesh_resolution: resolution_property("each object's", min=1, soft_max=2048, update=_meant("RESOLUTION"))
    mesh_spacing: spacing_property(
        " in world units, where the object's scale spreads them most", min=1e-6, update=_meant("SPACING")
    )
    mesh_pixels: pixels_property("An object is sampled again when it comes much closer", min=0.1, update=_read_again)
    mesh_textures: texture_mapped_property()
    mesh_normal_fields: normal_fields_property()


def looks_of_meshes(scene: bpy.types.Scene) -> dict[str, bool]:
    """What surfels of meshes store to look more like these, as options of sampling."""
    properties = getattr(scene, RENDER_SETTINGS)
    return {"texture_mapped": properties.mesh_textures, "normal_fields": properties.mesh_normal_fields}


def density_of_meshes(scene: bpy.types.Scene) -> Density:
    """The density at which meshes are sampled; a spacing is in world units."""
    properties = getattr(scene, RENDER_SETTINGS)
    name, measure = NUMBERED[properties.mesh_density]
    return Density(measure, getattr(properties, name))


class SurfelObjectSettings(ScanColorProperties, bpy.types.PropertyGroup):
    """An object's own settings: `object.surfel_splatting`."""

    render_as: EnumProperty(
        name="Render as",
        description=(
            "How this object and its instances are drawn. From Scene draws its surfels instead of the object for as "
            "long as they exist"
        ),
        items=[
            ("SCENE", "From Scene", "Follow the setting Render Meshes as in the render properties"),
            *(item[:3] for item in _MESH_ITEMS),
            (
                "DISTANCE",
                "Split by Distance",
                (
                    "Draw polygons up to a distance from the camera and surfels beyond it. "
                    "This takes longer than surfels alone"
                ),
            ),
            (
                "GROUP",
                "Split by Vertex Group",
                "Draw polygons where the weights of a vertex group are 0.5 or more, and surfels elsewhere",
            ),
            (
                "SPACING",
                "Split by Spacing",
                "Draw polygons where the surfels would be too far apart in the picture, and surfels elsewhere",
            ),
        ],
        default="SCENE",
        update=_read_again,
        override=OVERRIDABLE,
    )
    split_distance: FloatProperty(
        name="Distance",
        description="Distance from the camera up to which the object is drawn as polygons",
        subtype="DISTANCE",
        default=10.0,
        min=1e-6,
        soft_max=1000.0,
        update=_read_again,
        override=OVERRIDABLE,
    )
    split_pixels: FloatProperty(
        name="Pixels per Surfel",
        description="The object is drawn as polygons where its surfels are more pixels apart than this",
        default=2.0,
        min=0.1,
        soft_max=10.0,
        update=_read_again,
        override=OVERRIDABLE,
    )
    split_group: StringProperty(
        name="Vertex Group",
        description="The object is drawn as polygons where its weights are 0.5 or more",
        update=_read_again,
        override=OVERRIDABLE,
    )
    style: PointerProperty(name="Style", type=SurfelObjectStyle, override=OVERRIDABLE)
    detail: FloatProperty(
        name="Object Detail",
        description=(
            "How many times closer together this object's surfels are than the density says. 2 makes four times "
            "as many surfels"
        ),
        default=1.0,
        min=0.01,
        soft_min=0.25,
        soft_max=4.0,
        max=100.0,
        update=_read_again,
        override=OVERRIDABLE,
    )


#: kind of split -> the property, and field of `Form`, that it needs.
SPLIT_BY = {"DISTANCE": "split_distance", "SPACING": "split_pixels", "GROUP": "split_group"}


class Form(NamedTuple):
    """How a mesh is rendered.

    kind: one of the items of `render_as`.
    split_distance: distance from the camera up to which it is polygons.
    split_pixels: pixels between its surfels above which it is polygons.
    split_group: vertex group whose weights decide between polygons and splats.
    is_default: whether its object leaves the choice to the scene.
    """

    kind: str
    split_distance: float | None = None
    split_pixels: float | None = None
    split_group: str = ""
    is_default: bool = False

    @property
    def has_polygons(self) -> bool:
        return self.kind in ("POLYGONS", "DISTANCE", "SPACING", "GROUP")

    @property
    def has_surfels(self) -> bool:
        return self.kind in ("SURFELS", "DISTANCE", "SPACING", "GROUP")

    @property
    def of_surfels(self) -> Form:
        """The form of a mesh that polygons cannot show as it is: it is only drawn as polygons if the object demands
        it."""
        return self._replace(kind="SURFELS") if self.is_default and self.kind == "POLYGONS" else self


def form_of(entry: bpy.types.DepsgraphObjectInstance, scene: bpy.types.Scene) -> Form:
    """The form of an instance. Its instancer decides; for an instance from a collection the object inside comes first,
    unless one of them is hidden. Raises ValueError if the settings are incomplete."""
    asked = [getattr(each, OBJECT_SETTINGS) for each in asked_of(entry)]
    for settings in asked:
        check_choices(settings, "object properties")
    chosen = [settings for settings in asked if settings.render_as != "SCENE"]
    if any(settings.render_as == "HIDDEN" for settings in chosen):
        return Form("HIDDEN")
    if not chosen:
        return Form(getattr(scene, RENDER_SETTINGS).render_meshes, is_default=True)
    kind, settings = chosen[0].render_as, chosen[0]
    if kind == "GROUP" and not settings.split_group:
        raise ValueError("It is split by a vertex group, and none is chosen; choose one in its object properties.")
    name = SPLIT_BY.get(kind)
    return Form(kind, **{name: getattr(settings, name)} if name else {})


register, unregister = with_property(bpy.types.Object, OBJECT_SETTINGS, SurfelObjectSettings, SurfelObjectStyle)
