# SPDX-License-Identifier: GPL-3.0-or-later
"""Whose the samples are that see nothing but what a filter spreads over a splat's rim: the nearest such splat's."""

from __future__ import annotations

from ..device.interface import PipelineDescription, Target
from ..frame_plan import FramePlan, PlannedPass
from . import attributes
from .splats import draw_splats, drawn_by
from .tile import TileContext


def describe(planned: PlannedPass, frame: FramePlan) -> PipelineDescription:
    """What the pass draws with: the footprints of the attribute pass, of which the nearest wins."""
    return attributes.describe(planned, frame, what="rims")


def run(tile: TileContext, planned: PlannedPass) -> Target:
    """Fill what the visibility pass left empty of the numbers."""
    color, depth = planned.writes
    target = tile.target((color,), depth)
    target.clear(depth=1.0)
    draw_splats(tile, tile.resources.pipeline(describe(planned, tile.plan)), target, drawn_by(planned, tile))
    return target
