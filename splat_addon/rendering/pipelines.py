# SPDX-License-Identifier: GPL-3.0-or-later
"""The inputs, outputs and state of each pass's pipeline, as values that any device can build."""

from __future__ import annotations

from functools import partial

from .device.interface import PipelineDescription
from .methods import get_method
from .plan import FramePlan, PlannedPass
from .shaders import load

#: options: epsilon, near, 1 for orthographic, 1 / far.
#: sides: -1 for a mirrored object and 1 for others, 1 where backs are hidden, the least offset of visibility (as a
#:     share of the distance; of an orthographic camera a length).
_SPLATS = (
    "Splats",
    "splats",
    (
        ("mat4", "model_view"),
        ("mat4", "projection"),
        ("mat4", "normal_matrix"),
        ("vec4", "options"),
        ("vec4", "sides"),
        ("vec4", "window"),
    ),
)
#: In both, window: left, bottom and step of one sample on the plane at depth 1.
#: world: radiance, alpha of the background.
#: material: of all surfels, and in w the view-to-world length. options: 1 for orthographic, number of lights, 1 / far.
_SHADING = (
    "Shading",
    "shading",
    (
        ("mat4", "view_to_world"),
        ("mat4", "projection"),
        ("vec4", "window"),
        ("vec4", "world"),
        ("vec4", "material"),
        ("vec4", "options"),
    ),
)
_MATERIAL_VARYING = ("flat", "vec3", "material")
_LINEAR_DEPTH = (("LINEAR_DEPTH", "1"),)


def describe(planned: PlannedPass, frame: FramePlan) -> PipelineDescription:
    """The pipeline of one planned pass."""
    return _DESCRIPTIONS[planned.name](planned, frame)


def _visibility(planned, frame):
    return PipelineDescription(
        name="visibility",
        vertex=load("visibility.vert.glsl"),
        fragment=load("visibility.frag.glsl"),
        block=_SPLATS,
        samplers=("surfels",),
        varyings=(
            ("smooth", "vec3", "place_depth"),
            *((("smooth", "vec3", "across_offset"),) if frame.linear_depth else ()),
        ),
        defines=_LINEAR_DEPTH if frame.linear_depth else (),
        depth_test=True,
        depth_write=True,
        fragment_depth=frame.linear_depth,
    )


def _attributes(planned, frame):
    makers = {"space": _space_attributes, "picture": _picture_attributes}
    return makers[get_method(frame.method).works_in](planned, frame)


def _space_attributes(planned, frame):
    with_material = "material_sum" in planned.writes
    return PipelineDescription(
        name="attributes",
        vertex=load("attributes.vert.glsl", method=frame.method),
        fragment=load("attributes.frag.glsl", method=frame.method),
        block=_SPLATS,
        samplers=("surfels", "materials") if with_material else ("surfels",),
        varyings=(
            ("smooth", "vec3", "place_depth"),
            ("flat", "vec4", "color_weight"),
            ("flat", "vec3", "normal"),
            *((_MATERIAL_VARYING,) if with_material else ()),
        ),
        outputs=tuple(("vec4", name) for name in planned.writes),
        defines=(
            *((("MATERIAL_TARGET", "1"),) if with_material else ()),
            *(_LINEAR_DEPTH if frame.linear_depth else ()),
        ),
        blend="add",
        depth_test=True,
        fragment_depth=frame.linear_depth,
    )


def _picture_attributes(planned, frame):
    with_material = "material_sum" in planned.writes
    return PipelineDescription(
        name="attributes",
        vertex=load("screen/attributes.vert.glsl", method=frame.method),
        fragment=load("screen/attributes.frag.glsl", method=frame.method),
        block=_SPLATS,
        samplers=("surfels", *(("materials",) if with_material else ()), "visibility_depth"),
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
        outputs=tuple(("vec4", name) for name in planned.writes),
        defines=(
            ("VISIBILITY_SAMPLES", str(frame.visibility_samples)),
            *((("MATERIAL_TARGET", "1"),) if with_material else ()),
            *(_LINEAR_DEPTH if frame.linear_depth else ()),
        ),
        blend="add",
    )


def _fullscreen(planned, frame, fragment):
    kinds = {"depth": "float"}
    return PipelineDescription(
        name=planned.name,
        vertex=load("fullscreen.vert.glsl"),
        fragment=load(fragment, shading=frame.shading),
        block=_SHADING,
        samplers=planned.reads,
        outputs=tuple((kinds.get(name, "vec4"), name) for name in planned.writes),
        defines=(
            ("SAMPLES", str(frame.samples)),
            ("VISIBILITY_SAMPLES", str(frame.visibility_samples)),
            *((("MATERIAL_TARGET", "1"),) if "material_sum" in planned.reads else ()),
            *((("LIGHTS", "1"),) if "lights" in planned.reads else ()),
            *((("NORMAL_OUTPUT", "1"),) if "normal_coverage" in planned.writes else ()),
            *(_LINEAR_DEPTH if frame.linear_depth else ()),
        ),
    )


_DESCRIPTIONS = {
    "visibility": _visibility,
    "attributes": _attributes,
    "shading": partial(_fullscreen, fragment="shading.frag.glsl"),
    "sample_shading": partial(_fullscreen, fragment="sample_shading.frag.glsl"),
    "resolve": partial(_fullscreen, fragment="resolve.frag.glsl"),
}
