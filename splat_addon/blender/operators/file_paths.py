# SPDX-License-Identifier: GPL-3.0-or-later
"""Paths as Blender's file browser and its scripts give them, and what is said of files that cannot be used."""

from __future__ import annotations

import bpy
from bpy.props import StringProperty

#: Blender 5.2 warns scripts that hand // to a path that does not say that it takes it.
_OPTIONS = {"SKIP_PRESET"} | ({"PATH_SUPPORTS_BLEND_RELATIVE"} if bpy.app.version >= (5, 2, 0) else set())


def path_property(way: str, is_forgotten: bool = False):
    """The operator's `filepath`, as Blender's helpers have it. way: "reading from" or "writing to".
    is_forgotten: it is empty each time the operator is invoked, so that it then says whether a file was dropped.
    """
    description = f"Filepath used for {way} the file"
    options = _OPTIONS | ({"SKIP_SAVE"} if is_forgotten else set())
    return StringProperty(name="File Path", description=description, maxlen=1024, subtype="FILE_PATH", options=options)


def absolute(filepath: str) -> str:
    """The path with its leading // replaced by the folder of the .blend, which these stand for in Blender.

    Raises ValueError where the .blend has none yet.
    """
    if filepath.startswith("//") and not bpy.data.filepath:
        raise ValueError(
            f"The path {filepath!r} begins in the folder of the .blend, which has not been saved yet; save it, or "
            "give a whole path."
        )
    return bpy.path.abspath(filepath)


def file_sentence(error: Exception) -> str:
    """What is said of an error: a ValueError's own sentence, and an OSError's reason without its number."""
    if isinstance(error, OSError):
        return f"{error.strerror or error}."
    return str(error) or "The memory does not suffice; use fewer surfels."
