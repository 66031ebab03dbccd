# SPDX-License-Identifier: GPL-3.0-or-later
"""Object > Store Surfels in a File: moves the surfels of an object from the .blend to a file beside it."""

from __future__ import annotations

import bpy

from ...streaming import PORTION
from ...streaming.layout import SUFFIX
from ...surfels import portions
from ..conversion.color_watch import refresh
from ..doors import register_classes_factory
from ..geometry.sources import is_surfel_object
from ..geometry.stored_surfels import read_surfels
from ..geometry.surfel_files import file_of, keep_coarsest, own_id, relative_path
from ..geometry.world_surfels import as_in_files
from ..ids import STORE_SURFELS
from ..spoken import said
from .file_paths import absolute, path_property
from .modal_work import ModalWork, Writing

#: Letters of an object's name in that of its file: in UTF-8, and with a suffix, they fit in 255 bytes.
_LONGEST_NAME = 50


class Storing(Writing):
    """One object's surfels on their way to a file.

    Raises ValueError if there is no place for a file, or the surfels cannot be read.
    """

    def __init__(self, owner: bpy.types.Object, filepath: str):
        if owner.data.library is not None:
            raise ValueError(said("The surfels belong to a linked file; store them there"))
        path = absolute(filepath or f"//{bpy.path.clean_name(owner.name)[:_LONGEST_NAME]}{SUFFIX}")
        self._owner = owner
        refresh(bpy.context)
        surfels, self.unusable = read_surfels(owner.data)
        parts = portions(as_in_files(surfels, owner), PORTION)
        super().__init__(path, parts, len(surfels), own_id(owner.data))

    def finish(self) -> int:
        """Leave the coarsest surfels in the object; returns how many the file holds."""
        count, _ = keep_coarsest(self._owner.data, self.path, relative_path(self.path), is_own=True)
        return count


class OBJECT_OT_surfels_to_file(ModalWork, bpy.types.Operator):
    """Move the surfels to a file beside the .blend, from which each view reads what it needs"""

    bl_idname = STORE_SURFELS
    bl_label = "Store Surfels in a File"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 - Blender reads a set

    filepath: path_property("writing to", is_forgotten=True)

    @classmethod
    def poll(cls, context):
        owner = context.active_object
        if context.mode == "OBJECT" and owner is not None and is_surfel_object(owner) and not file_of(owner):
            return True
        cls.poll_message_set(said("Select an object whose surfels are in the .blend, in Object Mode"))
        return False

    def execute(self, context):
        return self.run_now(context)

    def invoke(self, context, event):
        return self.run_in_thread(context)

    def _begin(self, context):
        return Storing(context.active_object, self.filepath)

    def _finish(self, context, storing):
        count = storing.finish()
        if storing.unusable:
            self.report({"WARNING"}, said("Skipped {count:,} unusable surfels", count=storing.unusable))
        self.report({"INFO"}, said("{count:,} surfels -> {path}", count=count, path=storing.path))


register, unregister = register_classes_factory((OBJECT_OT_surfels_to_file,))
