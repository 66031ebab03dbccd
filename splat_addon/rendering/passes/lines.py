# SPDX-License-Identifier: GPL-3.0-or-later
"""The line pass: how much of each sample lies on a silhouette or a crease, before it is shaded."""

from __future__ import annotations

from ..device.interface import PipelineDescription, Target
from ..frame_plan import FramePlan, PlannedPass
from .shading import fill
from .tile import TileContext
from .words import pipeline, sum_words


def describe(planned: PlannedPass, frame: FramePlan) -> PipelineDescription:
    """What the pass draws with; of hardware samples it takes the mean."""
    words = {"lines", *sum_words(planned.reads, planned)}
    words |= {"polygons"} if "polygon_color" in planned.reads else set()
    words |= {"depth_bounds"} if "seen_range" in planned.reads else set()
    return pipeline(
        "lines",
        "fullscreen.vert",
        "lines.frag",
        words,
        frame,
        {"samples": "mean" if frame.multisamples else "each"},
        (("SAMPLES", str(frame.samples)), ("MEAN_OF", str(frame.multisamples))),
        samplers=planned.reads,
        multisampled=tuple(name for name in planned.reads if frame.multisamples_of(name)),
        outputs=(("float", "lines"),),
    )


def run(tile: TileContext, planned: PlannedPass) -> Target:
    """Fill the texture of lines."""
    return fill(tile, planned, describe(planned, tile.plan))
