# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes whose surfels are in a file of their own (`streaming`): `mesh.surfel_splatting.file`.

Such a mesh has only the coarsest surfels, as ordinary point attributes: they are seen and clicked in other shading
modes, and drawn while the file is missing. It has no file again once a conversion fills it.

A file that a mesh stored belongs to it: both have the id of what was written. Copies of the mesh, and of the .blend
under another name, read the file, but none of them replaces it.
"""

from __future__ import annotations

import os

import bpy
import numpy as np
from bpy.props import StringProperty

from ...streaming import Stream, id_of
from ..doors import unattended, with_handlers
from ..ids import MESH_SETTINGS
from ..registration import with_property
from ..working_space import surfels_from_rec709
from .attributes import fill

#: Surfels that a mesh keeps.
KEPT = 100_000


def file_of(owner: bpy.types.Object) -> str:
    """The absolute path of the file of an object in the .blend, or an empty string."""
    path = getattr(owner.data, MESH_SETTINGS).file if owner.type == "MESH" else ""
    return bpy.path.abspath(path, library=owner.data.library) if path else ""


def own_id(mesh: bpy.types.Mesh) -> str:
    """The id of the file that the mesh may replace; an empty string if there is none, or if other meshes or .blends may
    read it too: a copy of the mesh, or the .blend of which this one is a copy."""
    settings = getattr(mesh, MESH_SETTINGS)
    others = (getattr(each, MESH_SETTINGS).file_id for each in bpy.data.meshes if each != mesh)
    return "" if settings.file_blend != _blend_name() or settings.file_id in others else settings.file_id


def _blend_name() -> str:
    return os.path.basename(bpy.data.filepath)


def is_others(mesh: bpy.types.Mesh, file_id: str) -> bool:
    """Whether what is in the mesh's file by now is not what the mesh stored there."""
    return getattr(mesh, MESH_SETTINGS).file_id not in ("", file_id)


def keep_coarsest(mesh: bpy.types.Mesh, path: str, relative: str, is_own: bool) -> tuple[int, np.ndarray]:
    """Fill the mesh with the coarsest surfels of a file, and name the file in it; returns how many the file holds, and
    their (3,) origin, which is the mesh's offset until the object's location takes it over.

    path: absolute. relative: the path to name. is_own: the file was written for this mesh. Raises OSError or ValueError
    if the file cannot be used.
    """
    stream = Stream(path, 0)
    try:
        fill(mesh, surfels_from_rec709(stream.at_most(KEPT)), stream.file.origin)
        settings = getattr(mesh, MESH_SETTINGS)
        settings.file = relative
        if is_own:
            settings.file_id, settings.file_blend, settings.file_place = stream.file.id, _blend_name(), path
        return len(stream), stream.file.origin
    finally:
        stream.close()


def relative_path(path: str) -> str:
    """The path relative to the .blend where that is possible."""
    if not bpy.data.filepath:
        return path
    try:
        return bpy.path.relpath(path)
    except ValueError:  # on another drive
        return path


def _forget_id(settings: SurfelMeshSettings, context: bpy.types.Context) -> None:
    """A file that is named by hand is not the mesh's own."""
    if settings.file:
        settings.file_id = ""


class SurfelMeshSettings(bpy.types.PropertyGroup):
    """A mesh's settings: `mesh.surfel_splatting`.

    file_id: of what the mesh stored last, also after a conversion brought its surfels back. file_blend: the name of the
    .blend in which that was. file_place: the absolute path of the file then.
    """

    file: StringProperty(
        name="Surfel File",
        description=(
            "File from which views read the surfels that they need. The mesh has the coarsest ones, which are drawn "
            "while the file is missing"
        ),
        subtype="FILE_PATH",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
        update=_forget_id,
    )
    file_id: StringProperty(options={"HIDDEN"})
    file_blend: StringProperty(options={"HIDDEN"})
    file_place: StringProperty(options={"HIDDEN"})


@unattended("Finding the files of surfels")
def _find_again(*_) -> None:
    """Name the files again that a .blend does not find because it was saved in another folder: Blender keeps only paths
    of its own relative. A file is known by its id."""
    for mesh in bpy.data.meshes:
        settings = getattr(mesh, MESH_SETTINGS)
        file_id = settings.file_id
        if mesh.library or not (settings.file and file_id) or os.path.exists(bpy.path.abspath(settings.file)):
            continue
        if id_of(settings.file_place) == file_id:
            settings.file = relative_path(settings.file_place)
            settings.file_id = file_id


_register_settings, _unregister_settings = with_property(bpy.types.Mesh, MESH_SETTINGS, SurfelMeshSettings)
_register_handlers, _unregister_handlers = with_handlers(
    (bpy.app.handlers.load_post, _find_again), (bpy.app.handlers.save_post, _find_again)
)


def register():
    _register_settings()
    _register_handlers()


def unregister():
    _unregister_handlers()
    _unregister_settings()
