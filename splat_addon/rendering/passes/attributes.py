# SPDX-License-Identifier: GPL-3.0-or-later
"""The attribute pass: what is visible adds its weighted attributes to their sums (Botsch et al. 2005, section 4)."""

from __future__ import annotations

from dataclasses import replace

from ..device.interface import PipelineDescription, Target
from ..frame_plan import TEXTURES, FramePlan, PlannedPass
from ..methods import get_method
from ..shaders import load
from ..storages import get_storage
from .blocks import (
    FILTERS_SILHOUETTES,
    HOLDOUT,
    LAYER,
    LINEAR_DEPTH,
    identity_defines,
    identity_varyings,
    material_defines,
    split_defines,
    sum_defines,
)
from .splats import SPLATS_BLOCK, draw_splats, drawn_by
from .tile import TileContext

#: Of the sums that are not vec4.
_OUTPUT_TYPES = {"depth_sum": "vec2", "overdraw_sum": "float", "identity": "vec2", "rest_weight": "vec2"}
#: What is defined for sums that some scenes or models have.
_DEFINES = {"light_set_sum": "LIGHT_SET_TARGET", "overdraw_sum": "OVERDRAW_TARGET"}
#: Of texture-mapped splats: uv and slot, change of uv along the half-axes, where the map ends; and the half-axes.
_TEXTURE_VARYINGS = (
    ("flat", "vec3", "texture_place"),
    ("flat", "vec4", "texture_along"),
    ("flat", "vec2", "texture_border"),
)
_AXES_VARYINGS = (("flat", "vec3", "texture_axis_u"), ("flat", "vec3", "texture_axis_v"))
#: Of what transparent layers are tested with.
_LAYER_SAMPLERS = ("peeled", "visibility_depth")
_TEXTURE_SAMPLERS = ("surfel_uvs", "texture_atlas", "texture_table")


def _is_depth(texture: str) -> bool:
    return TEXTURES[texture][0] == "DEPTH32F"


def _sums(planned: PlannedPass) -> tuple[str, ...]:
    return tuple(name for name in planned.writes if not _is_depth(name))


def _outputs(planned: PlannedPass) -> tuple[tuple[str, str], ...]:
    return tuple((_OUTPUT_TYPES.get(name, "vec4"), name) for name in _sums(planned))


def _own_defines(planned: PlannedPass) -> tuple[tuple[str, str], ...]:
    return tuple((define, "1") for name, define in _DEFINES.items() if name in planned.writes)


def _material_varyings(planned: PlannedPass) -> tuple[tuple[str, str, str], ...]:
    return tuple(("flat", "vec3", name) for name in ("material", "emission") if f"{name}_sum" in planned.writes)


def describe(planned: PlannedPass, frame: FramePlan, textured: bool = False) -> PipelineDescription:
    """What the pass draws with, by the space that the method works in.

    textured: for instances whose colours are looked up in textures; the others do not pay for them. A sprite has one
    colour.
    """
    method = get_method(frame.method)
    plain = _MAKERS[method.works_in](planned, frame)
    if not textured or method.works_in == "sprites":
        return plain
    axes = _AXES_VARYINGS if method.works_in == "space" else ()
    # of what is evaluated once: a sample, or each of its hardware samples, which is a smaller piece of the pixel
    variance = method.pixel_variance / (frame.multisamples if frame.sample_shading else 1)
    return replace(
        plain,
        name="textured_attributes",
        samplers=(*plain.samplers, *_TEXTURE_SAMPLERS),
        varyings=(*plain.varyings, *_TEXTURE_VARYINGS, *axes),
        defines=(*plain.defines, ("TEXTURED", "1"), ("PIXEL_VARIANCE", repr(variance))),
    )


def _in_space(planned, frame):
    return _description(
        planned,
        frame,
        folder="",
        varyings=(("smooth", "vec3", "place_depth"),),
        blend="add",
        depth_test=True,
        fragment_depth=frame.linear_depth,
        sample_shading=frame.sample_shading,
    )


def _in_picture(planned, frame):
    straddling, culls = frame.has("STRADDLING"), "coarse_depth" in planned.reads
    return _description(
        planned,
        frame,
        folder="screen/",
        samplers=(
            "visibility_depth" if "identity" in planned.writes else "seen_range",
            *(("coarse_depth",) if culls else ()),
        ),
        varyings=(
            *((("flat", "float", "straddling"),) if straddling else ()),
            ("flat", "vec4", "plane_ab"),
            ("flat", "vec4", "plane_center_gh"),
            ("flat", "vec4", "plane_depths"),
            ("flat", "vec4", "plane_det_radius"),
            ("flat", "vec3", "footprint_map"),
            ("flat", "vec2", "footprint_middle"),
        ),
        defines=(
            *(FILTERS_SILHOUETTES if frame.filters_silhouettes else ()),
            *((("STRADDLING", "1"),) if straddling else ()),
            *((("CULLS_HIDDEN", "1"),) if culls else ()),
            *(HOLDOUT if frame.has("HOLDOUT") else ()),
        ),
        blend="add",
        depth_test=not frame.linear_depth,
    )


def _in_sprites(planned, frame):
    return _description(
        planned,
        frame,
        folder="sprites/",
        varyings=(("smooth", "vec2", "place"), ("flat", "vec3", "tilt_depth")),
        depth_test=True,
        depth_write=True,
    )


def _description(planned, frame, folder, varyings, samplers=(), defines=(), **state) -> PipelineDescription:
    """What every space has in common, and what one has beside it. folder: of its two shaders."""
    with_materials = material_defines(planned.writes)
    return PipelineDescription(
        name="attributes",
        vertex=load(f"{folder}attributes.vert.glsl", method=frame.method, storage=frame.storage),
        fragment=load(f"{folder}attributes.frag.glsl", method=frame.method),
        block=SPLATS_BLOCK,
        samplers=(
            *get_storage(frame.storage).samplers,
            *(("materials",) if with_materials else ()),
            *samplers,
            *(name for name in planned.reads if name in _LAYER_SAMPLERS and planned.layer),
        ),
        varyings=(
            *varyings,
            ("flat", "vec4", "color_weight"),
            ("flat", "vec3", "normal"),
            *((("flat", "float", "opacity"),) if planned.layer else ()),
            *_material_varyings(planned),
            *identity_varyings(planned),
        ),
        outputs=_outputs(planned),
        defines=(
            *defines,
            *with_materials,
            *_own_defines(planned),
            *identity_defines(planned),
            *split_defines(frame),
            *sum_defines(planned.writes, frame.accumulation),
            *(LAYER if planned.layer else ()),
            *(LINEAR_DEPTH if frame.linear_depth else ()),
        ),
        **state,
    )


_MAKERS = {"space": _in_space, "picture": _in_picture, "sprites": _in_sprites}


def run(tile: TileContext, planned: PlannedPass) -> Target:
    """Fill the sums, tested with the depth that the plan names."""
    description = describe(planned, tile.plan)
    depth = next(filter(_is_depth, (*planned.writes, *planned.reads)))
    target = tile.target(_sums(planned), depth if description.depth_test else None)
    target.clear(color=0.0, depth=1.0 if description.depth_write else None)
    for textured in (False, True):
        placed = [p for p in drawn_by(planned, tile) if p.instance.is_textured is textured]
        if placed:
            draw_splats(tile, tile.resources.pipeline(describe(planned, tile.plan, textured)), target, placed)
    return target
