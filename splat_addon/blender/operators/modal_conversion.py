# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by the converting operators: from a button or a menu, sampling runs in a thread, so that the window shows
progress and Esc cancels; from a script, in background mode or from the redo panel, `execute` runs it to the end."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import bpy

from ..conversion.batch import Batch
from ..conversion.mesh_settings import follow_property
from ..conversion.source_record import sources_of
from ..conversion.ties import tie
from ..ids import ENGINE, ENGINE_LABEL
from ..spoken import said

_TIMER_SECONDS = 0.05


def was_converted(context: bpy.types.Context) -> bool:
    """Whether surfels that know their sources are selected; used by Adjust Last Operation before it undoes the
    conversion."""
    return any(sources_of(made) for made in context.selected_objects if made.type == "MESH")


class ModalConversion:
    """A mix-in for operators that have the properties `source` ("KEEP" or "HIDE") and `follow`."""

    follow: follow_property()

    def _new_batch(self, context: bpy.types.Context) -> Batch:
        """A batch for the selection, according to the properties."""
        raise NotImplementedError

    #: The kind under which the record stores the conversion.
    kind = ""
    _timer = None

    def execute(self, context):
        batch = self._new_batch(context)
        if not batch.has_sources:
            self._report_already()
            return {"CANCELLED"}
        manager = context.window_manager
        manager.progress_begin(0.0, 1.0)
        try:
            for conversion in batch.prepared(context):
                batch.sample(conversion, manager.progress_update)
        finally:
            manager.progress_end()
        return self._finish(context, batch)

    def _report_already(self):
        self.report(
            {"ERROR"},
            said("The selected objects are surfels already; use Update to convert their sources again"),
        )

    def invoke(self, context, event):
        if bpy.app.background:
            return self.execute(context)
        self._batch = self._new_batch(context)
        if not self._batch.has_sources:
            self._report_already()
            return {"CANCELLED"}
        self._prepared = self._batch.prepared(context)
        self._executor, self._sampling = ThreadPoolExecutor(max_workers=1), None
        self._timer = context.window_manager.event_timer_add(_TIMER_SECONDS, window=context.window)
        context.window_manager.progress_begin(0.0, 1.0)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self._batch.is_cancelled = True
        if event.type == "TIMER":
            self._show_progress(context)
            if self._sampling is None or self._sampling.done():
                return self._next_source(context)
        return {"RUNNING_MODAL"}

    def cancel(self, context):
        """Blender calls this when it closes or loads another file."""
        self._batch.is_cancelled = True
        self._end_modal(context)

    def _next_source(self, context):
        if self._sampling is not None:
            self._sampling.result()
        conversion = None if self._batch.is_cancelled else next(self._prepared, None)
        if conversion is None:
            self._end_modal(context)
            return self._finish(context, self._batch)
        self._sampling = self._executor.submit(self._batch.sample, conversion)
        return {"RUNNING_MODAL"}

    def _show_progress(self, context):
        context.window_manager.progress_update(self._batch.share)
        percent = 100 * self._batch.share
        context.workspace.status_text_set(said("Converting to surfels: {percent:.0f}%   Esc cancels", percent=percent))

    def _end_modal(self, context):
        """End what `invoke` began, once."""
        timer, self._timer = self._timer, None
        if timer is None:
            return
        self._executor.shutdown()
        context.window_manager.event_timer_remove(timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)

    def _finish(self, context, batch):
        if batch.is_cancelled:
            self.report({"INFO"}, said("The conversion to surfels was cancelled; nothing was changed"))
            return {"CANCELLED"}
        made = batch.place_all(context) if batch.has_surfels else []
        for conversion, new in made:
            self.report({"INFO"}, f"{conversion.name}: {conversion.summary()}")
            for note in conversion.notes:
                self.report({"WARNING" if conversion.is_warning(note) else "INFO"}, f"{conversion.name}: {note}")
            for note in tie(conversion, new, self.kind, self, self.follow, self.source == "HIDE"):
                self.report({"WARNING"}, note)
        if made and context.scene.render.engine != ENGINE:
            self.report({"INFO"}, said("Choose the render engine {engine} to see the surfels", engine=ENGINE_LABEL))
        # An error makes a script's call fail, which would hide from it that other objects were converted.
        for name, sentence in batch.refused:
            self.report({"WARNING" if made else "ERROR"}, f"{name}: {sentence}")
        return {"FINISHED"} if made else {"CANCELLED"}
