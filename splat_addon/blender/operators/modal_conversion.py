# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by the converting operators: from a button or a menu, sampling runs in a thread; from a script, in background
mode or from the redo panel, `execute` runs it to the end."""

from __future__ import annotations

import bpy

from ..conversion.batch import Batch
from ..conversion.mesh_settings import follow_property
from ..conversion.source_record import sources_of
from ..conversion.ties import tie
from ..ids import ENGINE, ENGINE_LABEL
from ..spoken import said
from .modal_thread import ModalThread


def was_converted(context: bpy.types.Context) -> bool:
    """Whether surfels that know their sources are selected; used by Adjust Last Operation before it undoes the
    conversion."""
    return any(sources_of(made) for made in context.selected_objects if made.type == "MESH")


class ModalConversion(ModalThread):
    """A mix-in for operators that have the properties `source` ("KEEP" or "HIDE") and `follow`."""

    follow: follow_property()

    def _new_batch(self, context: bpy.types.Context) -> Batch:
        """A batch for the selection, according to the properties."""
        raise NotImplementedError

    #: The kind under which the record stores the conversion.
    kind = ""

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
        batch = self._new_batch(context)
        if not batch.has_sources:
            self._report_already()
            return {"CANCELLED"}
        self._prepared = batch.prepared(context)
        return self._begin_thread(context, batch)

    def _advance(self, context):
        if self._job is not None:
            self._job.result()
        conversion = None if self._work.is_cancelled else next(self._prepared, None)
        if conversion is None:
            self._end_thread(context)
            return self._finish(context, self._work)
        return self._submit(self._work.sample, conversion)

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
