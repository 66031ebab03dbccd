# SPDX-License-Identifier: GPL-3.0-or-later
"""What a surfel object remembers about its conversion, `object.surfel_record`: its sources and the settings.

This makes it possible to convert again, and excludes the sources from rendering while the surfels are in the scene.
Sources have no reference to their surfels, because that would keep deleted surfels in the file.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

import bpy
from bpy.props import (
    BoolProperty,
    CollectionProperty,
    EnumProperty,
    FloatVectorProperty,
    PointerProperty,
    StringProperty,
)

from ..ids import OBJECT_SETTINGS, SURFEL_RECORD
from ..registration import OVERRIDABLE, with_property
from .mesh_settings import ConversionProperties, SurfelConversionSettings, chosen_density
from .points_settings import PointsProperties


class SurfelPointsSettings(PointsProperties, bpy.types.PropertyGroup):
    """The settings of a points conversion."""


class SurfelSource(bpy.types.PropertyGroup):
    """One source; `name` is the one it had."""

    object: PointerProperty(name="Source", type=bpy.types.Object)
    shape: StringProperty(name="Shape", description="What it was made of when it was converted, as checksums")


class SurfelRecord(bpy.types.PropertyGroup):
    sources: CollectionProperty(type=SurfelSource)
    kind: EnumProperty(
        name="Kind",
        description="Whether surfaces or points of the sources were converted",
        items=(("MESH", "Surfaces", "Their surfaces were sampled"), ("POINTS", "Points", "Their points were taken")),
    )
    mesh: PointerProperty(type=SurfelConversionSettings)
    points: PointerProperty(type=SurfelPointsSettings)
    unread: StringProperty(name="Not Sampled", description="Material inputs that could not be read, one per line")
    place: FloatVectorProperty(
        name="Place", description="Matrix of the surfels in the space of the first source, when converted", size=16
    )
    hides_sources: BoolProperty(
        name="Hides Its Sources",
        description="The sources were hidden by the conversion, and are again when its surfels are shown",
    )
    origin: FloatVectorProperty(name="Origin", description="Origin of the surfels, in the space of the first source")
    is_hidden_source: BoolProperty(
        name="Hidden for Surfels",
        description="This object was hidden when it was converted, and comes back when its surfels are deleted",
        override=OVERRIDABLE,
    )
    was_disabled_in_renders: BoolProperty(
        name="Disabled in Renders Before",
        description="This object was already disabled in renders when it was converted, and stays so",
        override=OVERRIDABLE,
    )


#: kind -> the mix-in whose properties are kept
_PROPERTIES = {"MESH": ConversionProperties, "POINTS": PointsProperties}


def record_of(owner: bpy.types.Object) -> SurfelRecord:
    return getattr(owner, SURFEL_RECORD)


def keep_record(made: bpy.types.Object, sources: Iterable[bpy.types.Object], kind: str, settings) -> None:
    """Record in a new surfel object what it was made from. settings: an object with the properties of that kind."""
    record = record_of(made)
    record.kind = kind
    record.sources.clear()
    for source in sources:
        entry = record.sources.add()
        entry.object, entry.name = source, source.name
    kept = record.mesh if kind == "MESH" else record.points
    for name in _PROPERTIES[kind].__annotations__:
        setattr(kept, name, getattr(settings, name))
    if kind == "MESH":
        kept.density = chosen_density(settings)


def sources_of(made: bpy.types.Object) -> list[bpy.types.Object]:
    """The objects that surfels were made from, except those removed from the file."""
    return [each.object for each in record_of(made).sources if each.object is not None]


def sources_in(scene: bpy.types.Scene, shows: Callable[[bpy.types.Object], bool] | None = None) -> set:
    """The sources of all surfel objects in a scene, in its background scenes, and in collections instanced there.

    shows: whether one in the scene itself counts, by default all.
    """
    found, seen, waiting = set(), set(), [scene.objects]
    while scene.background_set is not None:
        scene = scene.background_set
        waiting.append(scene.objects)
    judged = waiting[0] if shows else None
    while waiting:
        objects = waiting.pop()
        for made in objects:
            sources = sources_of(made) if made.type == "MESH" else ()
            if sources and (objects is not judged or shows(made)):
                found.update(sources)
            placed = made.instance_collection if made.instance_type == "COLLECTION" else None
            if placed is not None and placed not in seen:
                seen.add(placed)
                waiting.append(placed.all_objects)
    return found


def stood_in(depsgraph: bpy.types.Depsgraph) -> set[bpy.types.Object]:
    """The sources that surfels replace in a view or a render: of those in the scene, whose surfels are not hidden."""

    there: set[str] = set()

    def shows(made: bpy.types.Object) -> bool:
        shown = made.evaluated_get(depsgraph)
        if not shown.is_evaluated:
            return False
        if depsgraph.mode != "RENDER":
            return shown.visible_get(view_layer=depsgraph.view_layer_eval)
        # an excluded collection's objects are evaluated too if they are parents; Blender finds a name by looking at all
        there.update(there or depsgraph.view_layer.objects.keys())
        return not shown.hide_render and made.name in there

    return sources_in(depsgraph.scene.original, shows)


def is_stood_in(owner: bpy.types.Object, sources: set[bpy.types.Object]) -> bool:
    """Whether surfels replace an object in the file."""
    return owner in sources and getattr(owner, OBJECT_SETTINGS).render_as == "SCENE"


register, unregister = with_property(bpy.types.Object, SURFEL_RECORD, SurfelRecord, SurfelPointsSettings, SurfelSource)
