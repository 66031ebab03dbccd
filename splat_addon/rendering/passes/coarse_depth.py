# SPDX-License-Identifier: GPL-3.0-or-later
"""How far is seen in each cell of samples, which tells what splats are hidden before they are drawn."""

from __future__ import annotations

from ..device.interface import PipelineDescription, Target
from ..frame_plan import FramePlan, PlannedPass
from .shading import fill
from .tile import TileContext
from .words import pipeline


def describe(planned: PlannedPass, frame: FramePlan) -> PipelineDescription:
    """What the pass draws with."""
    return pipeline(
        "coarse_depth",
        "fullscreen.vert",
        "coarse_depth.frag",
        (),
        frame,
        samplers=planned.reads,
        outputs=(("float", "coarse_depth"),),
    )


def run(tile: TileContext, planned: PlannedPass) -> Target:
    """Fill the texture."""
    return fill(tile, planned, describe(planned, tile.plan))
