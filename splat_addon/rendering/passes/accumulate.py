# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds a sample's picture to the sum of those before (Haeberli & Akeley 1990): each tile to its part of the whole."""

from __future__ import annotations

from ..device.interface import Target
from ..frame_plan import PlannedPass
from .tile import TileContext
from .words import pipeline


def run(tile: TileContext, planned: PlannedPass) -> Target:
    """Add the tile, without its margin."""
    target = tile.target(planned.writes)
    description = pipeline(
        planned.name,
        "fullscreen.vert",
        "accumulate.frag",
        (),
        tile.plan,
        samplers=planned.reads,
        outputs=(("vec4", planned.writes[0]),),
        blend="add",
    )
    made, reads = tile.resources.pipeline(description), tile.textures(planned.reads, {})
    blocks = tile.blocks(description.blocks)
    tile.resources.device.draw_fullscreen(made, target, blocks, reads, viewport=tile.rectangle)
    return target
