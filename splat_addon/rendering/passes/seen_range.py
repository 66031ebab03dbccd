# SPDX-License-Identifier: GPL-3.0-or-later
"""How far each sample sees, for methods that work in the picture and compare depths themselves."""

from __future__ import annotations

from ..device.interface import PipelineDescription, Target
from ..frame_plan import FramePlan, PlannedPass
from ..shaders import load
from .blocks import FILTERS_SILHOUETTES, HOLDOUT, LAYER, LINEAR_DEPTH
from .shading import SHADING_BLOCK, fill
from .tile import TileContext


def describe(planned: PlannedPass, frame: FramePlan) -> PipelineDescription:
    """What the pass draws with."""
    return PipelineDescription(
        name="seen_range",
        vertex=load("fullscreen.vert.glsl"),
        fragment=load("seen_range.frag.glsl"),
        block=SHADING_BLOCK,
        samplers=planned.reads,
        outputs=(("vec4", "seen_range"),),
        defines=(
            *(LAYER if planned.layer else ()),
            *(LINEAR_DEPTH if frame.linear_depth else ()),
            *(FILTERS_SILHOUETTES if frame.filters_silhouettes else ()),
            *(HOLDOUT if "holdout_depth" in planned.reads else ()),
        ),
    )


def run(tile: TileContext, planned: PlannedPass) -> Target:
    """Fill the texture."""
    return fill(tile, planned, describe(planned, tile.plan))
