# SPDX-License-Identifier: GPL-3.0-or-later
"""What the path of a result means: a file, or a folder in which it gets a name. Every command reads it alike."""

from __future__ import annotations

import os
from pathlib import Path

import bpy

from ..operators.file_paths import absolute


def path_at(out: str, name: str) -> str:
    """The absolute path that an argument means: `name` in a folder, or else the argument itself.

    A folder ends with a slash or exists; a missing one is made when the result is written. As everywhere in Blender, //
    is the folder of the .blend. Raises ValueError if that was not saved yet.
    """
    path = absolute(out)
    is_folder = path.endswith(tuple(filter(None, (os.sep, os.altsep)))) or os.path.isdir(path)
    return os.path.join(Path(path).absolute(), name) if is_folder else str(Path(path).absolute())


def file_at(out: str, suffix: str, name: str = "") -> Path:
    """The file of a result. name: its name in a folder, without which it is that of the opened .blend. Raises
    ValueError if it does not end with `suffix`."""
    path = Path(path_at(out, f"{name or Path(bpy.data.filepath).stem}{suffix}"))
    if path.suffix != suffix:
        raise ValueError(f"The result is a {suffix} file, not {path.name!r}; end the path of a folder with a slash.")
    return path


def made_room(file: Path) -> Path:
    """The file of a result, whose folder exists now. Raises OSError."""
    file.parent.mkdir(parents=True, exist_ok=True)
    return file
