# SPDX-License-Identifier: GPL-3.0-or-later
"""Render Meshes as Surfels: the scene's settings in the render properties, an object's own in its properties."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty

from .conversion_settings import DENSITIES
from .ids import ENGINE, OBJECT_SETTINGS, RENDER_SETTINGS
from .sources import has_surfaces, owner_of

#: density -> the property of `MeshSamplingProperties` that holds the number, and the kind of fineness that it is.
_FINENESS = {
    "RESOLUTION": ("mesh_resolution", "resolution"),
    "SPACING": ("mesh_spacing", "spacing"),
    "CAMERA": ("mesh_pixels", "pixels"),
}


def _read_again(settings, context) -> None:
    """A 3D view reads the scene only when Blender tells it of a change; it is not told of one that a script makes."""
    settings.id_data.update_tag()


_DENSITY_ITEMS = [(name, DENSITIES[name].label, DENSITIES[name].description) for name in _FINENESS]


class MeshSamplingProperties:
    """A mix-in of the scene's render settings."""

    render_meshes: BoolProperty(
        name="Render Meshes as Surfels",
        description=(
            "Sample meshes, curves, texts and metaballs as they are on each frame, without converting them. A mesh "
            "that keeps its triangles keeps its surfels, so deformation flickers a third as much. A frame costs 1 "
            "to 3 microseconds a surfel where the mesh deforms, and next to nothing where it does not"
        ),
        default=False,
        update=_read_again,
    )
    mesh_density: EnumProperty(
        name="Density",
        description="How it is said how close the surfels of meshes lie",
        items=_DENSITY_ITEMS,
        default="RESOLUTION",
        update=_read_again,
    )
    mesh_resolution: IntProperty(
        name="Resolution",
        description=(
            "Grid cells along the longest edge of each object's bounding box. "
            "Twice as many show details half the size, for four times the surfels, memory and time"
        ),
        default=256,
        min=1,
        soft_min=8,
        soft_max=2048,
        update=_read_again,
    )
    mesh_spacing: FloatProperty(
        name="Spacing",
        description=(
            "Distance between surfels in world units, where the object's scale spreads them most. "
            "Half of it shows details half the size, for four times the surfels, memory and time"
        ),
        default=0.01,
        min=1e-6,
        soft_max=10.0,
        precision=4,
        step=0.1,
        update=_read_again,
    )
    mesh_pixels: FloatProperty(
        name="Pixels per Surfel",
        description=(
            "Distance between surfels in pixels of the render, where the object comes closest to the scene's camera. "
            "An object is sampled anew when it comes a quarter closer, or is far too fine"
        ),
        default=1.0,
        min=0.1,
        soft_max=10.0,
        update=_read_again,
    )
    mesh_textures: BoolProperty(
        name="Texture-Mapped",
        description=(
            "Base colours that are one image are looked up in it at every pixel, instead of once a surfel: sharp "
            "textures with few surfels, 20 to 28 dB truer on a globe of text for 3.6 to 6 times the time in software"
        ),
        default=False,
    )


def are_meshes_texture_mapped(scene: bpy.types.Scene) -> bool:
    return getattr(scene, RENDER_SETTINGS).mesh_textures


def mesh_fineness(scene: bpy.types.Scene) -> dict[str, float] | None:
    """How fine meshes are sampled: {"resolution" | "spacing" (world units) | "pixels": number}; None: not at all."""
    properties = getattr(scene, RENDER_SETTINGS)
    if not properties.render_meshes:
        return None
    name, kind = _FINENESS[properties.mesh_density]
    return {kind: getattr(properties, name)}


class SurfelObjectSettings(bpy.types.PropertyGroup):
    """What an object has to say: `object.surfel_splatting`."""

    render_as_surfels: BoolProperty(
        name="Render as Surfels",
        description=(
            "Sample this object, with its instances, where the scene's Render Meshes as Surfels is on. The conversion "
            "switches this off, since its surfels stand in the object's place; switch it on again if you delete them"
        ),
        default=True,
        update=_read_again,
    )


def renders_as_surfels(entry: bpy.types.DepsgraphObjectInstance) -> bool:
    """Whether nobody says otherwise: of an instance its instancer, and of one from a collection the object in there
    too, whose surfels the conversion has put beside it."""
    owner = owner_of(entry)
    asked = [owner, entry.object.original] if owner.instance_type == "COLLECTION" else [owner]
    return all(getattr(object_, OBJECT_SETTINGS).render_as_surfels for object_ in asked)


def leave_to_surfels(source: bpy.types.Object) -> None:
    """The object has been converted: it must not be drawn a second time."""
    getattr(source, OBJECT_SETTINGS).render_as_surfels = False


class RENDER_PT_surfel_meshes(bpy.types.Panel):
    bl_label = "Render Meshes as Surfels"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"

    @classmethod
    def poll(cls, context):
        return context.engine == ENGINE

    def draw_header(self, context):
        self.layout.prop(getattr(context.scene, RENDER_SETTINGS), "render_meshes", text="")

    def draw(self, context):
        properties = getattr(context.scene, RENDER_SETTINGS)
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        self.layout.active = properties.render_meshes
        self.layout.prop(properties, "mesh_density")
        self.layout.prop(properties, _FINENESS[properties.mesh_density][0])
        self.layout.prop(properties, "mesh_textures")


class OBJECT_PT_surfel_splatting(bpy.types.Panel):
    bl_label = "Surfel Splatting"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "object"

    @classmethod
    def poll(cls, context):
        return context.engine == ENGINE and context.object is not None and has_surfaces(context.object)

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        self.layout.prop(getattr(context.object, OBJECT_SETTINGS), "render_as_surfels")


_register_classes, _unregister_classes = bpy.utils.register_classes_factory(
    (SurfelObjectSettings, RENDER_PT_surfel_meshes, OBJECT_PT_surfel_splatting)
)


def register():
    _register_classes()
    setattr(bpy.types.Object, OBJECT_SETTINGS, PointerProperty(type=SurfelObjectSettings))


def unregister():
    delattr(bpy.types.Object, OBJECT_SETTINGS)
    _unregister_classes()
