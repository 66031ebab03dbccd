# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by the operators that read and write large files: from a button, a dialog or the file browser, a thread works;
from a script or in background mode, `execute` does."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from typing import Protocol

import bpy

from ...interchange import ReadingCancelled
from ...sampling import SamplingCancelled
from ...streaming import WritingCancelled, own_file, write_blocks
from ...surfels import Surfels
from ..spoken import said
from .file_paths import file_sentence, storing_in
from .modal_thread import ModalThread, Work

#: What ends work that was cancelled.
_CANCELLED = (ReadingCancelled, SamplingCancelled, WritingCancelled)


class FileWork(Work, Protocol):
    """Work on files."""

    def run(self, told: Callable[[float], None] = ...) -> None:
        """Work to the end, in any thread. Raises OSError, ValueError, or one of `_CANCELLED`."""

    def cancelled(self) -> str:
        """What is reported after Esc."""


class Writing:
    """A file that is being written, and appears once it is complete. path: where, which is another one if somebody
    else's file is there. share: the finished share. is_cancelled: set from outside.

    expected: about how many surfels the parts have. own: the id of the file that may be replaced, see `own_file`.
    """

    def __init__(self, path: str, parts: Iterable[Surfels], expected: int, own: str = ""):
        self.path, self._own = path, own
        self.share, self.is_cancelled = 0.0, False
        self._parts, self._expected = parts, expected

    def run(self, told: Callable[[float], None] = lambda share: None) -> None:
        """Write the file, from any thread. Raises OSError, ValueError, WritingCancelled."""

        def progress(share: float, step: str) -> bool:
            self.share = share
            told(share)
            return not self.is_cancelled

        with storing_in(self.path), own_file(self.path, self._own) as self.path, storing_in(self.path):
            self._write(progress)

    def _write(self, progress: Callable[[float, str], bool]) -> None:
        write_blocks(self.path, self._parts, progress, expected=self._expected)

    def status(self) -> str:
        return said("Storing surfels: {percent:.0f}%   Esc cancels", percent=100 * self.share)

    def cancelled(self) -> str:
        return said("Storing was cancelled; nothing was changed")


class ModalWork(ModalThread):
    """A mix-in for operators, which do one thing after another. Nothing is changed in Blender before `_finish`."""

    def _begin(self, context: bpy.types.Context) -> FileWork:
        """What to do. Raises OSError or ValueError with a sentence."""
        raise NotImplementedError

    def _beginnings(self, context: bpy.types.Context) -> Iterable[Callable[[], FileWork]]:
        """A way to begin each thing, which is called once those before it are finished. What cannot be done is reported
        and the next begins."""
        return [partial(self._begin, context)]

    def _finish(self, context: bpy.types.Context, work: FileWork) -> None:
        """Use what is complete, and report. Raises OSError or ValueError with a sentence."""
        raise NotImplementedError

    def _sentence(self, error: Exception) -> str:
        return file_sentence(error)

    def run_now(self, context: bpy.types.Context) -> set[str]:
        """Work to the end. Whatever ends it early, Ctrl-C too, leaves nothing of what was being done."""
        manager = context.window_manager
        manager.progress_begin(0.0, 1.0)
        self._prepare(context)
        try:
            while work := self._next():
                self._conclude(context, work, partial(work.run, manager.progress_update))
        finally:
            manager.progress_end()
        return self._ended()

    def run_in_thread(self, context: bpy.types.Context) -> set[str]:
        """Begin; `modal` goes on."""
        if bpy.app.background:
            return self.run_now(context)
        self._prepare(context)
        work = self._next()
        return self._begin_thread(context, work) if work else self._ended()

    def _advance(self, context):
        if self._job is not None:
            self._conclude(context, self._work, self._job.result)
            self._work = None if self._work.is_cancelled else self._next()
        if self._work:
            return self._submit(self._work.run)
        self._end_thread(context)
        return self._ended()

    def _prepare(self, context: bpy.types.Context) -> None:
        self._waiting, self._done, self._refused = iter(self._beginnings(context)), 0, []

    def _next(self) -> FileWork | None:
        """The next work that can begin."""
        for begin in self._waiting:
            try:
                return begin()
            except Exception as error:
                self._refused.append(self._sentence(error))
        return None

    def _conclude(self, context: bpy.types.Context, work: FileWork, result: Callable[[], None]) -> None:
        """Use what a work gave. result: ends once it is complete, and raises its errors."""
        try:
            result()
            self._finish(context, work)
            self._done += 1
        except _CANCELLED:
            self.report({"INFO"}, work.cancelled())
        except Exception as error:
            self._refused.append(self._sentence(error))

    def _ended(self) -> set[str]:
        # an error makes a script's call fail, which would hide from it that others were finished
        for sentence in self._refused:
            self.report({"WARNING" if self._done else "ERROR"}, sentence)
        return {"FINISHED"} if self._done else {"CANCELLED"}
