# SPDX-License-Identifier: GPL-3.0-or-later
"""A new object that stores surfels, wherever they come from: a mesh, bare points or a file."""

from __future__ import annotations

from collections.abc import Iterable

import bpy
from mathutils import Matrix

from ...surfels import Surfels
from ..geometry.attributes import fill, write_surfels
from ..geometry.points_proxy import show_as_points


def add_surfel_object(
    name: str,
    surfels: Surfels,
    matrix_world: Matrix,
    collections: Iterable[bpy.types.Collection],
    materials: Iterable[bpy.types.Material | None] = (),
) -> bpy.types.Object:
    """The new object in `collections`; matrix_world: of the space in which `surfels.origin` is given."""
    mesh = write_surfels(name, surfels)
    for material in materials:
        mesh.materials.append(material)
    made = bpy.data.objects.new(mesh.name, mesh)
    show_as_points(made)
    for collection in collections:
        collection.objects.link(made)
    made.matrix_world = matrix_world @ Matrix.Translation(surfels.origin)
    return made


def refill(made: bpy.types.Object, surfels: Surfels, materials: Iterable[bpy.types.Material | None]) -> None:
    """Other surfels in place of those that an object has; all objects that share its mesh have them too."""
    fill(made.data, surfels)
    made.data.materials.clear()
    for material in materials:
        made.data.materials.append(material)


def collections_of(source: bpy.types.Object, fallback: bpy.types.Collection) -> list[bpy.types.Collection]:
    """Those that `source` is in and that can be changed; `fallback` where all belong to a linked library."""
    return [collection for collection in source.users_collection if collection.library is None] or [fallback]


def select_only(context: bpy.types.Context, made: list[bpy.types.Object]) -> None:
    """Select the new objects and nothing else; the last is active."""
    # a command line has no window, whose context would name them
    for selected in list(context.view_layer.objects.selected):
        selected.select_set(False)
    for new in made:
        new.select_set(True)
        context.view_layer.objects.active = new
