# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes whose surfels are in a file of their own (`streaming`): `mesh.surfel_splatting.file`.

Such a mesh has only the coarsest surfels, as ordinary point attributes: they are seen and clicked in other shading
modes, and drawn while the file is missing. It has no file again once a conversion fills it.
"""

from __future__ import annotations

import bpy
import numpy as np
from bpy.props import StringProperty

from ...streaming import Stream
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


def keep_coarsest(mesh: bpy.types.Mesh, path: str, relative: str) -> tuple[int, np.ndarray]:
    """Fill the mesh with the coarsest surfels of a file, and name the file in it; returns how many the file holds, and
    their (3,) origin, which becomes the object's location.

    path: absolute. relative: the path to name. Raises OSError or ValueError if the file cannot be used.
    """
    stream = Stream(path, 0)
    try:
        fill(mesh, surfels_from_rec709(stream.at_most(KEPT)))
        getattr(mesh, MESH_SETTINGS).file = relative
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


class SurfelMeshSettings(bpy.types.PropertyGroup):
    """A mesh's settings: `mesh.surfel_splatting`."""

    file: StringProperty(
        name="Surfel File",
        description=(
            "File from which views read the surfels that they need. The mesh has the coarsest ones, which are drawn "
            "while the file is missing"
        ),
        subtype="FILE_PATH",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
    )


register, unregister = with_property(bpy.types.Mesh, MESH_SETTINGS, SurfelMeshSettings)
