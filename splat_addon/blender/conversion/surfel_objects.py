# SPDX-License-Identifier: GPL-3.0-or-later
"""Creates objects that store surfels, whether they come from a mesh, bare points or a file."""

from __future__ import annotations

from collections.abc import Iterable

import bpy
import numpy as np
from mathutils import Matrix

from ...surfels import Surfels
from ..geometry.attributes import fill, write_surfels
from ..geometry.offsets import offset_of
from ..geometry.points_proxy import show_as_points
from ..ids import MESH_SETTINGS
from .placement import placed


def add_surfel_object(
    name: str,
    surfels: Surfels,
    matrix_world: Matrix,
    collections: Iterable[bpy.types.Collection],
    materials: Iterable[bpy.types.Material | None] = (),
) -> bpy.types.Object:
    """Add a new object to `collections`; matrix_world: the space in which `surfels.origin` is given. Raises ValueError
    as `placed`."""
    place, offset = placed(matrix_world, surfels.origin)
    mesh = write_surfels(name, surfels, offset)
    for material in materials:
        mesh.materials.append(material)
    return add_object_of(mesh, place, collections)


def add_object_of(
    mesh: bpy.types.Mesh, matrix_world: Matrix, collections: Iterable[bpy.types.Collection]
) -> bpy.types.Object:
    """Add a new object of a mesh of surfels to `collections`."""
    made = bpy.data.objects.new(mesh.name, mesh)
    show_as_points(made)
    for collection in collections:
        collection.objects.link(made)
    made.matrix_world = matrix_world
    return made


def refill(
    made: bpy.types.Object, surfels: Surfels, origin: np.ndarray, materials: Iterable[bpy.types.Material | None]
) -> None:
    """Replace the surfels of an object, and of all objects that share its mesh. origin: where the old ones had their
    origin, in the space of the new one's."""
    made.matrix_basis, offset = placed(made.matrix_basis, offset_of(made.data) + (surfels.origin - origin))
    fill(made.data, surfels, offset)
    getattr(made.data, MESH_SETTINGS).file = ""
    made.data.materials.clear()
    for material in materials:
        made.data.materials.append(material)


def collections_of(source: bpy.types.Object, fallback: bpy.types.Collection) -> list[bpy.types.Collection]:
    """The collections of `source` that take new objects; `fallback` if none does."""
    return [collection for collection in source.users_collection if _takes_objects(collection)] or [fallback]


def active_collection(context: bpy.types.Context) -> bpy.types.Collection:
    """The active collection if it takes new objects, or else the scene's."""
    return context.collection if _takes_objects(context.collection) else context.scene.collection


def _takes_objects(collection: bpy.types.Collection) -> bool:
    """Whether objects may be added: not to what a library contains, nor to an override of it."""
    return collection.library is None and collection.override_library is None


def render_like(made: bpy.types.Object, source: bpy.types.Object) -> None:
    """Give a new object what renders of its source depend on besides the surface: pass index, ray visibility, Holdout
    and light linking, in the collections that both are in too."""
    for name in bpy.types.Object.bl_rna.properties.keys():
        if name.startswith("visible_") or name in _OF_RENDERS:
            setattr(made, name, getattr(source, name))
    for name in ("receiver_collection", "blocker_collection"):
        setattr(made.light_linking, name, getattr(source.light_linking, name))
    for collection in made.users_collection:
        members = dict(zip(collection.objects, collection.collection_objects, strict=True))
        if source in members:
            members[made].light_linking.link_state = members[source].light_linking.link_state


#: What `render_like` copies besides ray visibility, whose names differ between Blender's versions.
_OF_RENDERS = ("pass_index", "is_holdout", "is_shadow_catcher")


def select_only(context: bpy.types.Context, made: list[bpy.types.Object]) -> None:
    """Select only the new objects; the last one becomes active."""
    # on a command line there is no window, and so no context
    for selected in list(context.view_layer.objects.selected):
        selected.select_set(False)
    for new in made:
        new.select_set(True)
        context.view_layer.objects.active = new
