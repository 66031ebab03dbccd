# SPDX-License-Identifier: GPL-3.0-or-later
"""Object > Store Surfels in a File: moves the surfels of an object from the .blend to a file beside it.

From a button, writing runs in a thread, so that the window shows progress and Esc cancels.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import bpy

from ...streaming import WritingCancelled, write_blocks
from ...streaming.layout import SUFFIX
from ...surfels import portions
from ..geometry.attributes import read_surfels
from ..geometry.sources import is_surfel_object
from ..geometry.surfel_files import file_of, keep_coarsest, relative_path
from ..ids import STORE_SURFELS
from ..spoken import said
from .file_paths import absolute, file_sentence, path_property

_TIMER_SECONDS = 0.1
#: Surfels that are sorted at once.
_PART = 1 << 20


class Storing:
    """One object's surfels on their way to a file. share: the finished share. is_cancelled: set from outside.

    Raises ValueError if there is no place for a file, or the surfels cannot be read.
    """

    def __init__(self, owner: bpy.types.Object, filepath: str):
        if owner.data.library is not None:
            raise ValueError(said("The surfels belong to a linked file; store them there"))
        self.path = absolute(filepath or f"//{bpy.path.clean_name(owner.name)}{SUFFIX}")
        self.share, self.is_cancelled = 0.0, False
        self._owner = owner
        self._surfels, self.unusable = read_surfels(owner.data)

    def write(self, told: Callable[[float], None] = lambda share: None) -> None:
        """Write the file, from any thread. Raises OSError, ValueError, WritingCancelled."""

        def progress(share: float, step: str) -> bool:
            self.share = share
            told(share)
            return not self.is_cancelled

        write_blocks(self.path, portions(self._surfels, _PART), progress)

    def finish(self) -> int:
        """Leave the coarsest surfels in the object; returns how many the file holds."""
        count, _ = keep_coarsest(self._owner.data, self.path, relative_path(self.path))
        return count


class OBJECT_OT_surfels_to_file(bpy.types.Operator):
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
        manager = context.window_manager
        manager.progress_begin(0.0, 1.0)
        try:
            storing = Storing(context.active_object, self.filepath)
            storing.write(manager.progress_update)
            return self._finish(storing)
        except (OSError, ValueError, MemoryError) as error:
            return self._fail(error)
        finally:
            manager.progress_end()

    def invoke(self, context, event):
        if bpy.app.background:
            return self.execute(context)
        try:
            self._storing = Storing(context.active_object, self.filepath)
        except (ValueError, MemoryError) as error:
            return self._fail(error)
        self._executor = ThreadPoolExecutor(1)
        self._writing = self._executor.submit(self._storing.write)
        self._timer = context.window_manager.event_timer_add(_TIMER_SECONDS, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self._storing.is_cancelled = True
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        percent = 100 * self._storing.share
        context.workspace.status_text_set(said("Storing surfels: {percent:.0f}%   Esc cancels", percent=percent))
        if not self._writing.done():
            return {"RUNNING_MODAL"}
        self._end_modal(context)
        try:
            self._writing.result()
            return self._finish(self._storing)
        except WritingCancelled:
            self.report({"INFO"}, said("Storing was cancelled; nothing was changed"))
            return {"CANCELLED"}
        except (OSError, ValueError, MemoryError) as error:
            return self._fail(error)

    def cancel(self, context):
        """Blender calls this when it closes or loads another file."""
        self._storing.is_cancelled = True
        self._end_modal(context)

    def _end_modal(self, context):
        self._executor.shutdown()
        context.window_manager.event_timer_remove(self._timer)
        context.workspace.status_text_set(None)

    def _finish(self, storing: Storing):
        count = storing.finish()
        if storing.unusable:
            self.report({"WARNING"}, said("Skipped {count:,} unusable surfels", count=storing.unusable))
        self.report({"INFO"}, said("{count:,} surfels -> {path}", count=count, path=storing.path))
        return {"FINISHED"}

    def _fail(self, error: Exception):
        self.report({"ERROR"}, file_sentence(error))
        return {"CANCELLED"}


register, unregister = bpy.utils.register_classes_factory((OBJECT_OT_surfels_to_file,))
