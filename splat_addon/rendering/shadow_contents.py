# SPDX-License-Identifier: GPL-3.0-or-later
"""What the contents of shadow maps depend on, as values that are equal as long as the maps need not be drawn again.

Nothing in them keeps surfels or polygons in memory. Scenes are compared by what is in them, because a final render
exports another one for each frame.
"""

from __future__ import annotations

from dataclasses import fields
from operator import attrgetter
from typing import TYPE_CHECKING
from weakref import ref

from .scene import Instance, PolygonInstance
from .scene.camera import Camera
from .shadow import casting

if TYPE_CHECKING:
    from .plan.executor import TileContext
    from .plan.graph import Pass

#: Fields of instances that are compared in another way, or change nothing in a map.
_APART = {"shape", "matrix_world", "stream", "materials", "light_set", "name", "index"}
_OF = {
    kind: attrgetter(*(field.name for field in fields(kind) if field.name not in _APART))
    for kind in (Instance, PolygonInstance, Camera)
}


def contents(tile: TileContext, p: Pass) -> tuple:
    """All that the pass that draws a frame's shadow maps depends on, but for the camera of the picture."""
    casters, slots = casting(tile.scene).shown, tile.identities.slots
    each = [(ref(c.shape), c.matrix_world.tobytes(), _OF[type(c)](c), slots(c), _levels(tile, c)) for c in casters]
    numbers = {placed: number for number, placed in enumerate(casters)}
    maps = [
        (
            m.camera.matrix_world.tobytes(),
            _OF[Camera](m.camera),
            m.place,
            m.used,
            m.is_smaller,
            *map(numbers.get, m.casters),
        )
        for m in tile.plan.facts["shadow_maps"]
    ]
    return p._replace(once=None, reason=""), tile.plan.choices, tile.settings, each, maps


def _levels(tile: TileContext, placed: Instance | PolygonInstance) -> ref | None:
    own = tile.levels(placed) if isinstance(placed, Instance) else None
    return None if own is None else ref(own)
