# SPDX-License-Identifier: GPL-3.0-or-later
"""Object > Convert to Surfels: what is selected becomes surfel objects in the same place.

From a button or a menu the sampling runs in a thread, so that the window shows progress and Esc cancels; from a
script, in background and from the redo panel it runs to its end in `execute`.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import bpy

from ..conversion_batch import ConversionBatch
from ..conversion_settings import ConversionProperties, choices, draw_properties
from ..ids import SURFELS_FROM_MESH
from ..mesh_sampling_settings import leave_to_surfels
from ..sources import has_surfaces

_TIMER_SECONDS = 0.05


def selected_sources(context: bpy.types.Context) -> list[bpy.types.Object]:
    """What the operator converts: everything that may show a surface and is not surfels already."""
    return [source for source in context.selected_objects if has_surfaces(source)]


class OBJECT_OT_surfels_from_mesh(ConversionProperties, bpy.types.Operator):
    """Sample what is selected, as its modifiers make it, into new objects of surfels that lie exactly over it: \
meshes, curves, texts, metaballs, and the instances of Geometry Nodes and collections"""

    bl_idname = SURFELS_FROM_MESH
    bl_label = "Convert to Surfels"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 - Blender reads a set

    @classmethod
    def poll(cls, context):
        if context.mode != "OBJECT":
            cls.poll_message_set("Objects are converted in object mode; leave the current mode first")
        elif not selected_sources(context):
            cls.poll_message_set(
                "Select a mesh object, curve, text, metaball or collection instance, one that is not surfels already"
            )
        else:
            return True
        return False

    def draw(self, context):
        draw_properties(self.layout, self)

    def execute(self, context):
        batch = ConversionBatch(selected_sources(context), choices(self), context.active_object)
        manager = context.window_manager
        manager.progress_begin(0.0, 1.0)
        try:
            for conversion in batch.prepared(context):
                batch.sample(conversion, manager.progress_update)
        finally:
            manager.progress_end()
        return self._finish(context, batch)

    def invoke(self, context, event):
        if bpy.app.background:
            return self.execute(context)
        self._batch = ConversionBatch(selected_sources(context), choices(self), context.active_object)
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
        """Blender is closing or loading another file."""
        self._batch.is_cancelled = True
        self._end_modal(context)

    def _next_source(self, context):
        try:
            if self._sampling is not None:
                self._sampling.result()
            conversion = None if self._batch.is_cancelled else next(self._prepared, None)
        except BaseException:
            self._end_modal(context)
            raise
        if conversion is None:
            self._end_modal(context)
            return self._finish(context, self._batch)
        self._sampling = self._executor.submit(self._batch.sample, conversion)
        return {"RUNNING_MODAL"}

    def _show_progress(self, context):
        context.window_manager.progress_update(self._batch.share)
        context.workspace.status_text_set(f"Converting to surfels: {self._batch.share:.0%}   Esc cancels")

    def _end_modal(self, context):
        self._executor.shutdown()
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)

    def _finish(self, context, batch):
        if batch.is_cancelled:
            self.report({"INFO"}, "The conversion to surfels was cancelled; nothing was changed")
            return {"CANCELLED"}
        made = batch.place_all(context) if batch.has_surfels else []
        for conversion, _ in made:
            self.report({"INFO"}, f"{conversion.name}: {conversion.summary()}")
            for note in conversion.notes:
                self.report({"WARNING"}, f"{conversion.name}: {note}")
            for source in conversion.sources:
                leave_to_surfels(source)
                if self.source == "HIDE":
                    source.hide_set(True)
                    source.hide_render = True
        # An error fails a script's call; where others were converted, that would hide them from it.
        for name, sentence in batch.refused:
            self.report({"WARNING" if made else "ERROR"}, f"{name}: {sentence}")
        return {"FINISHED"} if made else {"CANCELLED"}


def draw_menu_entry(menu, context):
    menu.layout.separator()
    menu.layout.operator(SURFELS_FROM_MESH)


_register_classes, _unregister_classes = bpy.utils.register_classes_factory((OBJECT_OT_surfels_from_mesh,))


def register():
    _register_classes()
    bpy.types.VIEW3D_MT_object.append(draw_menu_entry)


def unregister():
    bpy.types.VIEW3D_MT_object.remove(draw_menu_entry)
    _unregister_classes()
