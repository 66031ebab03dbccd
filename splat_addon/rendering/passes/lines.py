# SPDX-License-Identifier: GPL-3.0-or-later
"""The line pass: how much of each sample lies on a silhouette or a crease, before it is shaded."""

from __future__ import annotations

from ..device.interface import PipelineDescription, Target
from ..frame_plan import FramePlan, PlannedPass
from ..shaders import load
from .blocks import polygon_defines, sum_defines
from .shading import SHADING_BLOCK, fill
from .tile import TileContext


def describe(planned: PlannedPass, frame: FramePlan) -> PipelineDescription:
    """What the pass draws with; of hardware samples it takes the mean."""
    return PipelineDescription(
        name="lines",
        vertex=load("fullscreen.vert.glsl"),
        fragment=load("lines.frag.glsl"),
        block=SHADING_BLOCK,
        samplers=planned.reads,
        multisampled=tuple(name for name in planned.reads if frame.multisamples_of(name)),
        outputs=(("float", "lines"),),
        defines=(
            ("SAMPLES", str(frame.samples)),
            *((("MEAN_OF", str(frame.multisamples)),) if frame.multisamples else ()),
            *polygon_defines(planned, frame),
            *sum_defines(planned.reads, frame.accumulation),
            *((("SEEN_RANGE", "1"),) if "seen_range" in planned.reads else ()),
        ),
    )


def run(tile: TileContext, planned: PlannedPass) -> Target:
    """Fill the texture of lines."""
    return fill(tile, planned, describe(planned, tile.plan))
