# SPDX-License-Identifier: GPL-3.0-or-later
"""Paths from Blender's file browser and from scripts, and messages about files that cannot be used."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterator
from contextlib import contextmanager

import bpy
from bpy.props import StringProperty

from ...claims import WritingError
from ...faults import sentence_of

#: Blender warns scripts that pass // to a path that does not declare support for it; 4.5 knows the option, 5.2 warns.
_OPTIONS = {"SKIP_PRESET", "PATH_SUPPORTS_BLEND_RELATIVE"}

#: Errors of a disk that has no room.
_FULL = {errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC), errno.EFBIG}


def path_property(way: str, is_forgotten: bool = False):
    """The operator's `filepath`, like that of Blender's helpers. way: "reading from" or "writing to".

    is_forgotten: it is cleared each time the operator is invoked, so that a value means that a file was dropped.
    """
    description = f"Filepath used for {way} the file"
    options = _OPTIONS | ({"SKIP_SAVE"} if is_forgotten else set())
    return StringProperty(name="File Path", description=description, maxlen=1024, subtype="FILE_PATH", options=options)


def absolute(filepath: str) -> str:
    """The path with a leading // replaced by the folder of the .blend, as in Blender.

    Raises ValueError if the .blend has not been saved yet.
    """
    if filepath.startswith("//") and not bpy.data.filepath:
        raise ValueError(
            f"The path {filepath!r} begins in the folder of the .blend, which has not been saved yet; save it, or "
            "give a whole path."
        )
    return bpy.path.abspath(filepath)


def file_sentence(error: Exception) -> str:
    """The message for an error beside a file's name: an OSError's reason without its number, or the sentence."""
    return f"{error.strerror}." if isinstance(error, OSError) and error.strerror else sentence_of(error)


@contextmanager
def storing_in(path: str | os.PathLike) -> Iterator[None]:
    """Let an error of the system about a file of blocks that is being written name it, as what is beside the message is
    the file that it is made from. Raises WritingError with a sentence for those."""
    try:
        yield
    except OSError as error:
        if not error.errno or error.filename is None or os.path.realpath(error.filename) != os.path.realpath(path):
            raise
        cure = "; it needs up to twice its size while it is written" if error.errno in _FULL else ""
        raise WritingError(f"{path} cannot be written: {error.strerror}{cure}. Nothing was changed.") from error
