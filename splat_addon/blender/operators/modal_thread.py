# SPDX-License-Identifier: GPL-3.0-or-later
"""Operators that work in a thread, so that the window shows progress and Esc cancels."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Protocol

import bpy

_TIMER_SECONDS = 0.05


class Work(Protocol):
    """What runs in the thread. share: the finished share. is_cancelled: set from outside."""

    share: float
    is_cancelled: bool

    def status(self) -> str:
        """What the status bar shows."""


class ModalThread:
    """A mix-in for operators, which owns the thread and the timer."""

    _work: Work | None = None
    _job: Future | None = None
    _status: str | None = None
    _timer = None

    def _advance(self, context: bpy.types.Context) -> set[str]:
        """Called while the thread has nothing to do: begins a job by `_submit`, or ends by `_end_thread`. Returns what
        `modal` does."""
        raise NotImplementedError

    def _begin_thread(self, context: bpy.types.Context, work: Work) -> set[str]:
        """Begin; `modal` goes on."""
        self._work, self._executor = work, ThreadPoolExecutor(1)
        self._timer = context.window_manager.event_timer_add(_TIMER_SECONDS, window=context.window)
        context.window_manager.progress_begin(0.0, 1.0)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def _submit(self, job: Callable, *arguments) -> set[str]:
        self._job = self._executor.submit(job, *arguments)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self._work.is_cancelled = True
        if event.type != "TIMER":
            return {"RUNNING_MODAL"}
        status = self._work.status()
        if status != self._status:  # each change has windows drawn again
            self._status = status
            context.window_manager.progress_update(self._work.share)
            context.workspace.status_text_set(status)
        return self._advance(context) if self._job is None or self._job.done() else {"RUNNING_MODAL"}

    def cancel(self, context):
        """Blender calls this when it closes or loads another file."""
        if self._work is not None:
            self._work.is_cancelled = True
            self._end_thread(context)

    def _end_thread(self, context):
        """End what `_begin_thread` began, once."""
        timer, self._timer = self._timer, None
        if timer is None:
            return
        self._executor.shutdown()
        context.window_manager.event_timer_remove(timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)
