# SPDX-License-Identifier: GPL-3.0-or-later
"""Which surfels were made of an object. They know their sources, which have no reference to them; so the file is
searched, once for as long as the same objects are in it."""

from __future__ import annotations

import bpy
import numpy as np

from .source_record import sources_of

#: session_uid of each object in the file when it was searched, and of a source -> the places of its surfels among them.
_objects = np.empty(0, np.int32)
_made: dict[int, list[int]] = {}


def surfels_of(source: bpy.types.Object) -> list[bpy.types.Object]:
    """The surfel objects in the file that were made of an object."""
    _search_if_changed()
    return [bpy.data.objects[place] for place in _made.get(source.session_uid, ())]


def surfels_with_sources() -> list[bpy.types.Object]:
    """All surfel objects in the file that know their sources."""
    _search_if_changed()
    return [bpy.data.objects[place] for place in sorted(set().union(*_made.values()))]


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
    for place, made in enumerate(bpy.data.objects):
        for source in sources_of(made) if made.type == "MESH" else ():
            _made.setdefault(source.session_uid, []).append(place)
