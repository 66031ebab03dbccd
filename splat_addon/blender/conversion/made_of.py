# SPDX-License-Identifier: GPL-3.0-or-later
"""Which surfels were made of an object. They know their sources, which have no reference to them; so the file is
searched, once for as long as the same objects are in it."""

from __future__ import annotations

import bpy
import numpy as np

from .source_record import record_of, sources_of

#: session_uid of each object in the file when it was searched; the places among them of those that were made of others;
#: session_uid of a source -> the places of its surfels.
_objects = np.empty(0, np.int32)
_converted: list[int] = []
_made: dict[int, list[int]] = {}


def surfels_of(source: bpy.types.Object) -> list[bpy.types.Object]:
    """The surfel objects in the active view layer that were made of an object, as far as views may show them."""
    _search_if_changed()
    made = (bpy.data.objects[place] for place in _made.get(source.session_uid, ()))
    # in another view layer, objects are neither visible nor hidden
    return [each for each in made if each.visible_get() or each.hide_get()]


def converted() -> list[bpy.types.Object]:
    """All surfel objects in the file that were made of others, which may be gone."""
    _search_if_changed()
    return [bpy.data.objects[place] for place in _converted]


def forget() -> None:
    """Search again, because a record has changed."""
    global _objects
    _objects = np.empty(0, np.int32)


def _search_if_changed() -> None:
    global _objects
    found = np.empty(len(bpy.data.objects), np.int32)
    bpy.data.objects.foreach_get("session_uid", found)
    if np.array_equal(found, _objects):
        return
    _objects = found
    _made.clear()
    _converted[:] = [k for k, each in enumerate(bpy.data.objects) if each.type == "MESH" and record_of(each).sources]
    for place in _converted:
        for source in sources_of(bpy.data.objects[place]):
            _made.setdefault(source.session_uid, []).append(place)
