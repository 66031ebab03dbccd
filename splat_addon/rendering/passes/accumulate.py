# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds a sample's picture to the sum of those before (Haeberli & Akeley 1990): each tile to its part of the whole."""

from __future__ import annotations

from ..device.interface import PipelineDescription, Target
from ..frame_plan import PlannedPass
from ..shaders import load
from .blocks import std140
from .tile import TileContext

#: corner: where the pixel 0, 0 of what is read lies in the whole picture.
_BLOCK = ("Accumulation", "accumulation", (("vec4", "corner"),))


def run(tile: TileContext, planned: PlannedPass) -> Target:
    """Add the tile, without its margin."""
    target = tile.target(planned.writes)
    x, y, *_ = tile.rectangle
    description = PipelineDescription(
        name=planned.name,
        vertex=load("fullscreen.vert.glsl"),
        fragment=load("accumulate.frag.glsl"),
        block=_BLOCK,
        samplers=planned.reads,
        outputs=(("vec4", planned.writes[0]),),
        blend="add",
    )
    tile.resources.device.draw_fullscreen(
        tile.resources.pipeline(description),
        target,
        std140((x - tile.plan.margin, y - tile.plan.margin, 0.0, 0.0)),
        tile.textures(planned.reads, {}),
        viewport=tile.rectangle,
    )
    return target
