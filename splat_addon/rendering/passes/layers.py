# SPDX-License-Identifier: GPL-3.0-or-later
"""Before the first transparent layer, and after each (Guennebaud et al. 2006, section 6)."""

from __future__ import annotations

from ..device.interface import Target
from ..frame_plan import PlannedPass
from . import shading
from .tile import TileContext


def start(tile: TileContext, planned: PlannedPass) -> Target:
    """Nothing is peeled, and nothing seen: all 0."""
    peeled, *outputs = planned.writes
    for names in ((peeled,), outputs):
        target = tile.target(names)
        target.clear(color=0.0)
    return target


def peel(tile: TileContext, planned: PlannedPass) -> Target:
    """How deep each sample is peeled now and what lies before that hides; it is read as "peeled" then."""
    target = shading.run(tile, planned)
    tile.swap("peeled", "peeled_next")
    if "identity_next" in planned.writes:
        tile.swap("identity", "identity_next")
    return target
