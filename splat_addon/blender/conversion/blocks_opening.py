# SPDX-License-Identifier: GPL-3.0-or-later
"""Opens a file of blocks as an object with the coarsest of its surfels, for the importing operator and the command."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

import bpy
from mathutils import Matrix

from ...streaming.layout import MAGIC, SUFFIX
from ..geometry.attributes import set_offset
from ..geometry.scene_offset import taken_from
from ..geometry.stored_surfels import read_surfels
from ..geometry.surfel_files import keep_coarsest, relative_path
from .file_import import doubts_of_place
from .placement import placed
from .surfel_objects import active_collection, add_object_of


def holds_blocks(path: str) -> bool:
    """Whether a file is one of surfels in blocks, by its contents, or else by its name, so that a damaged one is told
    so."""
    with suppress(OSError, ValueError), open(path, "rb") as stream:
        if stream.read(len(MAGIC)) == MAGIC:
            return True
    return os.fspath(path).endswith(SUFFIX)


def open_blocks(
    context: bpy.types.Context, path: str, name: str, is_own: bool
) -> tuple[bpy.types.Object, int, list[str]]:
    """Add the object to the active collection; returns it, how many surfels the file holds, and sentences about its
    place. path: absolute. is_own: the file was written for the object. Raises OSError or ValueError."""
    mesh = bpy.data.meshes.new(Path(name).stem)
    try:
        count, origin = keep_coarsest(mesh, path, relative_path(path), is_own)
        place, offset = placed(Matrix(), origin - taken_from(context.scene, origin))
    except BaseException:
        bpy.data.meshes.remove(mesh)
        raise
    set_offset(mesh, offset)
    made = add_object_of(mesh, place, [active_collection(context)])
    return made, count, doubts_of_place(made, read_surfels(mesh)[0].scales)
