# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows sources again that were hidden by a conversion, once their surfels have been deleted."""

from __future__ import annotations

import bpy
from bpy.app.handlers import persistent

from .source_record import record_of, sources_in

#: Number of objects in the file at the last check.
_objects = 0


def hide_source(source: bpy.types.Object) -> None:
    """Hide an object in the viewport and in renders for as long as it has surfels."""
    source.hide_set(True)
    source.hide_render = True
    record_of(source).is_hidden_source = True


def bring_back() -> None:
    """Show all hidden sources that have no surfels left."""
    hidden = [owner for owner in bpy.data.objects if record_of(owner).is_hidden_source]
    needed = set().union(*map(sources_in, bpy.data.scenes)) if hidden else set()
    for source in hidden:
        if source in needed:
            continue
        record_of(source).is_hidden_source = source.hide_render = False
        for scene in source.users_scene:
            for view_layer in scene.view_layers:
                if source.name in view_layer.objects:
                    source.hide_set(False, view_layer=view_layer)


@persistent
def _after_update(scene, depsgraph) -> None:
    """Check the file when the number of objects has changed."""
    global _objects
    count = len(bpy.data.objects)
    if count != _objects:
        _objects = count
        bring_back()


def register():
    bpy.app.handlers.depsgraph_update_post.append(_after_update)


def unregister():
    bpy.app.handlers.depsgraph_update_post.remove(_after_update)
