# SPDX-License-Identifier: GPL-3.0-or-later
"""The files of surfels that one renderer reads, open as long as some object of the scene has them."""

from __future__ import annotations

import os

import bpy

from ...streaming import Stream
from ..geometry.points_proxy import is_points_modifier
from ..geometry.surfel_files import file_of, is_others
from ..preferences import stream_bytes
from ..working_space import from_rec709


class Streams:
    """Opens each file once, and again after it changed."""

    def __init__(self):
        self._open: dict[tuple, Stream] = {}
        self._current: set[tuple] = set()

    def begin_frame(self) -> None:
        self._current = set()

    def get(self, owner: bpy.types.Object) -> Stream | None:
        """The stream of an object in the .blend; None if its surfels are its mesh's.

        Raises ValueError with a sentence if its file cannot be used.
        """
        path = file_of(owner)
        if not path:
            return None
        try:
            status = os.stat(path)
            most, primaries = stream_bytes(), from_rec709()
            key = path, status.st_mtime_ns, status.st_size, most, primaries.tobytes()
            if key not in self._open:
                self._open[key] = Stream(path, most, primaries)
            if is_others(owner.data, self._open[key].file.id):
                raise ValueError(
                    f"What is in {path} was stored there by another object or another file; choose the object's own "
                    "file, or convert it again."
                )
        except (OSError, ValueError) as error:
            why = f"{path}: {error.strerror or error}." if isinstance(error, OSError) else str(error)
            raise ValueError(
                f"{owner.name} is drawn with its coarsest surfels only, because its file cannot be read. {why}"
            ) from None
        self._current.add(key)
        return self._open[key]

    def forget_unused(self) -> None:
        """Close the files that this frame did not need."""
        for key in self._open.keys() - self._current:
            self._open.pop(key).close()


def not_followed(owner: bpy.types.Object) -> str:
    """The sentence about changes of shape that surfels from a file do not follow, or an empty string."""
    changes = _shape_changes(owner)
    if not changes:
        return ""
    return f"{owner.name}: surfels from a file do not follow {changes[0]}; keep them in the mesh if they are to deform"


def _shape_changes(owner: bpy.types.Object) -> list[str]:
    """The names of an object's modifiers in renders, except the one that shows points, and of its shape keys."""
    changes = [m.name for m in owner.modifiers if m.show_render and not is_points_modifier(m)]
    has_keys = getattr(owner.data, "shape_keys", None) is not None
    return [*changes, *(["Shape Keys"] if has_keys else [])]
