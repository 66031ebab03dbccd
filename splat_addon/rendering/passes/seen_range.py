# SPDX-License-Identifier: GPL-3.0-or-later
"""How far each sample sees, for methods that work in the picture and compare depths themselves."""

from __future__ import annotations

from ..device.interface import PipelineDescription, Target
from ..frame_plan import FILTER_MARGIN, VISIBILITY_ROWS, FramePlan, PlannedPass
from .shading import fill
from .tile import TileContext
from .words import filters, kind, pipeline


def describe(planned: PlannedPass, frame: FramePlan) -> PipelineDescription:
    """What the pass draws with."""
    writes_depth, holes = "visibility_depth" in planned.writes, {"holdout_depth", "row_holdout_depth"}
    known = {planned.reads[0]: "seen_depth", **dict.fromkeys(holes, "holes")}
    words = {*filters(frame), kind(planned)}
    words |= {"transparency"} if planned.layer else set()
    words |= {"holdout"} if holes & set(planned.reads) else set()
    words |= {"writes_depth"} if writes_depth else set()
    words |= {"object_id"} if "identity" in planned.writes else set()
    return pipeline(
        "seen_range",
        "fullscreen.vert",
        "seen_range.frag",
        words,
        frame,
        constants=(("ROWS", str(VISIBILITY_ROWS if writes_depth else 1)),),
        samplers=tuple(known.get(name, name) for name in planned.reads),
        outputs=(("vec4", "seen_range"), *((("vec2", "identity"),) if "identity" in planned.writes else ())),
        depth_test=writes_depth,
        depth_write=writes_depth,
        fragment_depth=writes_depth,
    )


def run(tile: TileContext, planned: PlannedPass) -> Target:
    """Fill the texture; and the depths of the samples, where visibility has more rows than they."""
    return fill(tile, planned, describe(planned, tile.plan))
