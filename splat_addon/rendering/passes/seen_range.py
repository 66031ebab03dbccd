# SPDX-License-Identifier: GPL-3.0-or-later
"""How far each sample sees, for methods that work in the picture and compare depths themselves."""

from __future__ import annotations

from ..device.interface import PipelineDescription, Target
from ..frame_plan import FramePlan, PlannedPass
from ..shaders import load
from .blocks import FILTERS_SILHOUETTES, HAS_ROWS, HOLDOUT, LAYER, LINEAR_DEPTH
from .shading import SHADING_BLOCK, fill
from .tile import TileContext


def describe(planned: PlannedPass, frame: FramePlan) -> PipelineDescription:
    """What the pass draws with."""
    writes_depth = "visibility_depth" in planned.writes
    return PipelineDescription(
        name="seen_range",
        vertex=load("fullscreen.vert.glsl"),
        fragment=load("seen_range.frag.glsl"),
        block=SHADING_BLOCK,
        samplers=planned.reads,
        outputs=(("vec4", "seen_range"), *((("vec2", "identity"),) if "identity" in planned.writes else ())),
        defines=(
            *(LAYER if planned.layer else ()),
            *(LINEAR_DEPTH if frame.linear_depth else ()),
            *(FILTERS_SILHOUETTES if frame.filters_silhouettes else ()),
            *(HOLDOUT if {"holdout_depth", "row_holdout_depth"} & set(planned.reads) else ()),
            *(HAS_ROWS if writes_depth else ()),
            *((("IDENTITY", "1"),) if "identity" in planned.writes else ()),
        ),
        depth_test=writes_depth,
        depth_write=writes_depth,
        fragment_depth=writes_depth,
    )


def run(tile: TileContext, planned: PlannedPass) -> Target:
    """Fill the texture; and the depths of the samples, where visibility has more rows than they."""
    return fill(tile, planned, describe(planned, tile.plan))
