# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows sources again that were hidden by a conversion, once their surfels have been deleted."""

from __future__ import annotations

import bpy
import numpy as np

from ..doors import unattended, with_handlers
from .source_record import record_of, sources_in

#: session_uid of each object in the file at the last check.
_objects = np.empty(0, np.int32)


def hide_source(source: bpy.types.Object) -> None:
    """Hide an object in the viewport and in renders for as long as it has surfels."""
    record = record_of(source)
    if not record.is_hidden_source:
        record.was_disabled_in_renders = source.hide_render
    source.hide_set(True)
    record.is_hidden_source = source.hide_render = True


def is_disabled_in_renders(source: bpy.types.Object) -> bool:
    """Whether renders leave an object out, apart from a conversion that hid it."""
    record = record_of(source)
    return record.was_disabled_in_renders if record.is_hidden_source else source.hide_render


def bring_back() -> None:
    """Show all hidden sources that have no surfels left; those that were disabled in renders before stay so."""
    hidden = [owner for owner in bpy.data.objects if record_of(owner).is_hidden_source]
    needed = set().union(*map(sources_in, bpy.data.scenes)) if hidden else set()
    for source in hidden:
        if source not in needed:
            show_source(source)


def show_source(source: bpy.types.Object) -> None:
    """Show a source that a conversion hid, unless it was disabled in renders before."""
    record = record_of(source)
    if record.is_hidden_source:
        record.is_hidden_source = False
        source.hide_render = record.was_disabled_in_renders
    for scene in source.users_scene:
        for view_layer in scene.view_layers:
            if source.name in view_layer.objects:
                source.hide_set(False, view_layer=view_layer)


@unattended("Showing sources whose surfels are gone")
def _after_update(scene, depsgraph) -> None:
    """Check the file when other objects are in it."""
    global _objects
    found = np.empty(len(bpy.data.objects), np.int32)
    bpy.data.objects.foreach_get("session_uid", found)
    if not np.array_equal(found, _objects):
        _objects = found
        bring_back()


register, unregister = with_handlers((bpy.app.handlers.depsgraph_update_post, _after_update))
