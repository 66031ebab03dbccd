# SPDX-License-Identifier: GPL-3.0-or-later
"""What the contents of shadow maps depend on, as values that are equal as long as the maps need not be drawn again.

Nothing in them keeps surfels or polygons in memory. Scenes are compared by what is in them, because a final render
exports another one for each frame.
"""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING
from weakref import ref

import numpy as np

from ..streaming import Stream
from ..surfels import Shape
from .plan.graph import Pass
from .scene import Instance
from .shadow import ShadowMap, casting

if TYPE_CHECKING:
    from .plan.executor import TileContext


def contents(tile: TileContext, p: Pass) -> tuple:
    """All that the pass that draws a frame's shadow maps depends on, but for the camera of the picture."""
    casters = casting(tile.scene).shown
    levels = (tile.levels(placed) if isinstance(placed, Instance) else None for placed in casters)
    each = [
        (_values(placed), tile.identities.slots(placed), own and ref(own))
        for placed, own in zip(casters, levels, strict=True)
    ]
    numbers = {placed: number for number, placed in enumerate(casters)}
    maps = [_of_map(made, numbers) for made in tile.plan.facts["shadow_maps"]]
    return p._replace(once=None, reason=""), tile.plan.choices, tile.settings, each, maps


def _of_map(made: ShadowMap, numbers: dict) -> tuple:
    return _values(made.camera), made.place, made.used, made.is_smaller, [numbers[placed] for placed in made.casters]


def _values(of: object) -> list:
    """The fields of a camera or an instance."""
    return [_value(getattr(of, field.name)) for field in fields(of)]


def _value(value: object) -> object:
    if isinstance(value, np.ndarray):
        return value.tobytes()
    return ref(value) if isinstance(value, Shape | Stream) else value
