# SPDX-License-Identifier: GPL-3.0-or-later
"""The visibility samples of each sample in short, by which methods that work in the picture hide splats early."""

from __future__ import annotations

from ..device.interface import PipelineDescription, Target
from ..frame_plan import FramePlan, PlannedPass
from ..shaders import load
from .blocks import LAYER
from .shading import SHADING_BLOCK, shading_block
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
        defines=(("VISIBILITY_SAMPLES", str(frame.visibility_samples)), *(LAYER if planned.layer else ())),
        depth_test=True,
        depth_write=True,
        fragment_depth=True,
    )


def run(tile: TileContext, planned: PlannedPass) -> Target:
    """Fill the range and the depth texture."""
    color, depth = planned.writes
    target = tile.target((color,), depth)
    target.clear(depth=1.0)
    pipeline = tile.resources.pipeline(describe(planned, tile.plan))
    tile.resources.device.draw_fullscreen(pipeline, target, shading_block(tile), tile.textures(planned.reads, {}))
    return target
