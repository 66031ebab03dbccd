# SPDX-License-Identifier: GPL-3.0-or-later
"""What the contents of shadow maps depend on, as values that are equal as long as the maps need not be drawn again.

Nothing in them keeps surfels or polygons in memory. Scenes are compared by what is in them, because a final render
exports another one for each frame.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields
from operator import attrgetter
from weakref import ref

from ...hierarchy import Hierarchy
from ..contents import digest
from ..scene import Instance, Placed, PolygonInstance
from ..scene.camera import Camera
from ..scene.table import InstanceTable
from .atlas import ShadowMap

#: Fields that are compared in another way, or change nothing in a map.
_APART = {
    *("shape", "matrix_world", "stream", "materials", "light_set", "name", "index", "split_distance", "split_length")
}
_OF = {
    kind: attrgetter(*(field.name for field in fields(kind) if field.name not in _APART))
    for kind in (Instance, PolygonInstance, Camera)
}


def contents(table: InstanceTable, maps: Sequence[ShadowMap], levels: Callable[[Instance], Hierarchy | None]) -> tuple:
    """All of a scene that its shadow maps depend on, but for the camera of the picture.

    levels: gives the hierarchy of an instance, or None.
    """
    casters = table.casting
    kinds = [(ref(kind.placed.shape), _OF[type(kind.placed)](kind.placed), _levels(levels, kind.placed))
             for kind in casters.kinds]  # fmt: skip
    each_map = [
        (
            m.camera.matrix_world.tobytes(),
            _OF[Camera](m.camera),
            m.place,
            m.used,
            m.is_smaller,
            digest(m.casters.numbers),
        )
        for m in maps
    ]
    return digest(*casters.told), kinds, each_map


def _levels(levels: Callable[[Instance], Hierarchy | None], placed: Placed) -> ref | None:
    own = levels(placed) if isinstance(placed, Instance) else None
    return None if own is None else ref(own)
