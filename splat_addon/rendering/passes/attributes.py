# SPDX-License-Identifier: GPL-3.0-or-later
"""The attribute pass: what is visible adds its weighted attributes to their sums (Botsch et al. 2005, section 4)."""

from __future__ import annotations

from ..device.interface import PipelineDescription, Target
from ..methods import get_method
from ..plan import FramePlan, PlannedPass
from ..shaders import load
from ..storages import get_storage
from .blocks import HALF_SUMS, LINEAR_DEPTH
from .splats import SPLATS_BLOCK, draw_splats
from .tile import TileContext

#: Of the sums that are not vec4.
_OUTPUT_TYPES = {"depth_sum": "vec2"}
_MATERIAL_VARYING = ("flat", "vec3", "material")


def describe(planned: PlannedPass, frame: FramePlan) -> PipelineDescription:
    """What the pass draws with, by the space that the method works in."""
    return _MAKERS[get_method(frame.method).works_in](planned, frame)


def _in_space(planned, frame):
    with_material = "material_sum" in planned.writes
    return PipelineDescription(
        name="attributes",
        vertex=load("attributes.vert.glsl", method=frame.method, storage=frame.storage),
        fragment=load("attributes.frag.glsl", method=frame.method),
        block=SPLATS_BLOCK,
        samplers=(*get_storage(frame.storage).samplers, *(("materials",) if with_material else ())),
        varyings=(
            ("smooth", "vec3", "place_depth"),
            ("flat", "vec4", "color_weight"),
            ("flat", "vec3", "normal"),
            *((_MATERIAL_VARYING,) if with_material else ()),
        ),
        outputs=tuple((_OUTPUT_TYPES.get(name, "vec4"), name) for name in planned.writes),
        defines=(
            *((("MATERIAL_TARGET", "1"),) if with_material else ()),
            *(HALF_SUMS if frame.accumulation == "float16" else ()),
            *(LINEAR_DEPTH if frame.linear_depth else ()),
        ),
        blend="add",
        depth_test=True,
        fragment_depth=frame.linear_depth,
    )


def _in_picture(planned, frame):
    with_material = "material_sum" in planned.writes
    return PipelineDescription(
        name="attributes",
        vertex=load("screen/attributes.vert.glsl", method=frame.method, storage=frame.storage),
        fragment=load("screen/attributes.frag.glsl", method=frame.method),
        block=SPLATS_BLOCK,
        samplers=(
            *get_storage(frame.storage).samplers,
            *(("materials",) if with_material else ()),
            "visibility_depth",
        ),
        varyings=(
            ("flat", "float", "straddling"),
            ("flat", "vec4", "plane_ab"),
            ("flat", "vec4", "plane_center_gh"),
            ("flat", "vec4", "plane_depths"),
            ("flat", "vec2", "plane_gradient"),
            ("flat", "vec4", "color_weight"),
            ("flat", "vec3", "normal"),
            *((_MATERIAL_VARYING,) if with_material else ()),
        ),
        outputs=tuple((_OUTPUT_TYPES.get(name, "vec4"), name) for name in planned.writes),
        defines=(
            ("VISIBILITY_SAMPLES", str(frame.visibility_samples)),
            *((("MATERIAL_TARGET", "1"),) if with_material else ()),
            *(HALF_SUMS if frame.accumulation == "float16" else ()),
            *(LINEAR_DEPTH if frame.linear_depth else ()),
        ),
        blend="add",
    )


_MAKERS = {"space": _in_space, "picture": _in_picture}


def run(tile: TileContext, planned: PlannedPass) -> Target:
    """Fill the sums. A method that works in the picture compares depths itself and needs no depth buffer."""
    pipeline = tile.resources.pipeline(describe(planned, tile.plan))
    target = tile.target(planned.writes, "visibility_depth" if pipeline.description.depth_test else None)
    target.clear(color=0.0)
    draw_splats(tile, pipeline, target)
    return target
