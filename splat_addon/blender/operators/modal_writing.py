# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by the operators that write a file of surfels in blocks: from a button, a dialog or the file browser, a thread
writes, so that the window shows progress and Esc cancels; from a script or in background mode, `execute` does."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor

import bpy

from ...streaming import WritingCancelled, own_file, write_blocks
from ...surfels import Surfels
from ..spoken import said
from .file_paths import file_sentence

_TIMER_SECONDS = 0.1


class Writing:
    """A file that is being written, and appears once it is complete. path: where, which is another one if somebody
    else's file is there. share: the finished share. is_cancelled: set from outside.

    expected: about how many surfels the parts have. own: the id of the file that may be replaced, see `own_file`.
    """

    def __init__(self, path: str, parts: Iterable[Surfels], expected: int, own: str = ""):
        self.path, self._own = path, own
        self.share, self.is_cancelled = 0.0, False
        self._parts, self._expected = parts, expected

    def write(self, told: Callable[[float], None] = lambda share: None) -> None:
        """Write the file, from any thread. Raises OSError, ValueError, WritingCancelled."""

        def progress(share: float, step: str) -> bool:
            self.share = share
            told(share)
            return not self.is_cancelled

        with own_file(self.path, self._own) as self.path:
            write_blocks(self.path, self._parts, progress, expected=self._expected)


class ModalWriting:
    """A mix-in for operators. Nothing is changed in Blender before `_finish`."""

    _timer = None

    def _begin(self, context: bpy.types.Context) -> Writing:
        """The file to write. Raises OSError or ValueError with a sentence."""
        raise NotImplementedError

    def _finish(self, context: bpy.types.Context, writing: Writing) -> None:
        """Use the complete file, and report. Raises OSError or ValueError with a sentence."""
        raise NotImplementedError

    def _sentence(self, error: Exception) -> str:
        return file_sentence(error)

    def write_now(self, context: bpy.types.Context) -> set[str]:
        """Write to the end. Whatever ends it early, Ctrl-C too, leaves neither a file nor any other change."""
        manager = context.window_manager
        manager.progress_begin(0.0, 1.0)
        try:
            writing = self._begin(context)
            writing.write(manager.progress_update)
            self._finish(context, writing)
        except Exception as error:
            return self._fail(error)
        finally:
            manager.progress_end()
        return {"FINISHED"}

    def write_in_thread(self, context: bpy.types.Context) -> set[str]:
        """Begin writing; `modal` goes on."""
        if bpy.app.background:
            return self.write_now(context)
        try:
            self._writing = self._begin(context)
        except Exception as error:
            return self._fail(error)
        self._executor = ThreadPoolExecutor(1)
        self._written = self._executor.submit(self._writing.write)
        self._timer = context.window_manager.event_timer_add(_TIMER_SECONDS, window=context.window)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self._writing.is_cancelled = True
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        percent = 100 * self._writing.share
        context.workspace.status_text_set(said("Storing surfels: {percent:.0f}%   Esc cancels", percent=percent))
        if not self._written.done():
            return {"RUNNING_MODAL"}
        self._end_modal(context)
        try:
            self._written.result()
            self._finish(context, self._writing)
        except WritingCancelled:
            self.report({"INFO"}, said("Storing was cancelled; nothing was changed"))
            return {"CANCELLED"}
        except Exception as error:
            return self._fail(error)
        return {"FINISHED"}

    def cancel(self, context):
        """Blender calls this when it closes or loads another file."""
        if hasattr(self, "_writing"):
            self._writing.is_cancelled = True
            self._end_modal(context)

    def _end_modal(self, context):
        """End what `invoke` began, once."""
        timer, self._timer = self._timer, None
        if timer is None:
            return
        self._executor.shutdown()
        context.window_manager.event_timer_remove(timer)
        context.workspace.status_text_set(None)

    def _fail(self, error: Exception):
        self.report({"ERROR"}, self._sentence(error))
        return {"CANCELLED"}
