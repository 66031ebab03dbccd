# SPDX-License-Identifier: GPL-3.0-or-later
"""The attribute pass: what is visible adds its weighted attributes to their sums (Botsch et al. 2005, section 4)."""

from __future__ import annotations

from ..device.interface import Target
from ..frame_plan import TEXTURES, FramePlan, PlannedPass
from ..methods import get_method
from ..storages import get_storage
from .splats import draw_splats, drawn_by
from .tile import TileContext
from .words import filters, identity_varyings, kind, pipeline, pixel_variance, says_whose, split, sum_words

#: Of the sums that are not vec4.
_OUTPUT_TYPES = {"depth_sum": "vec2", "overdraw_sum": "float", "identity": "vec2", "rest_weight": "vec2"}
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


def _material_varyings(planned: PlannedPass) -> tuple[tuple[str, str, str], ...]:
    return tuple(("flat", "vec3", name) for name in ("material", "emission") if f"{name}_sum" in planned.writes)


#: where a method works -> its host
_HOSTS = {"space": "object_space", "picture": "screen_space", "sprites": "point_sprite"}
_PLANE_VARYINGS = (
    ("flat", "vec4", "plane_ab"),
    ("flat", "vec4", "plane_center_gh"),
    ("flat", "vec4", "plane_depths"),
    ("flat", "vec4", "plane_det_radius"),
    ("flat", "vec3", "footprint_map"),
    ("flat", "vec2", "footprint_middle"),
)
_PLACE_VARYINGS = {
    "space": (("smooth", "vec3", "place_depth"),),
    "picture": _PLANE_VARYINGS,
    "sprites": (("smooth", "vec2", "place"), ("flat", "vec3", "tilt_depth")),
}


def describe(planned: PlannedPass, frame: FramePlan, textured: bool = False, what: str = "attributes"):
    """What the pass draws with, by the space that the method works in.

    textured: for instances whose colours are looked up in textures; the others do not pay for them. A sprite has one
    colour. what: "attributes", "rest" or "rims".
    """
    works_in, sums = get_method(frame.method).works_in, _sums(planned)
    textured = textured and works_in != "sprites"
    in_picture, is_rims, is_rest = works_in == "picture", what == "rims", what == "rest"
    straddles = in_picture and frame.has("STRADDLING")
    culls = "coarse_depth" in planned.reads
    own_materials = any(name in sums for name in ("material_sum", "emission_sum"))
    words = {*says_whose(planned), *split(frame), kind(planned)}
    words |= {"gbuffer", *sum_words(sums, planned)} if not (is_rims or is_rest) else set()
    words |= {"oit", "rest"} if is_rest else set()
    words |= {"rims"} if is_rims else set()
    words |= {"transparency"} if planned.layer else set()
    words |= {"straddling"} if straddles else set()
    words |= {"hiz"} if culls else set()
    words |= {"textures"} if textured else set()
    if in_picture and not is_rims:
        words |= {"visibility"} | ({"depth_bounds"} if not is_rest else set())
        words |= {"holdout"} if frame.has("HOLDOUT") and not planned.layer else set()
        words |= set(filters(frame)) if not is_rest else set()
    seen = ()
    if in_picture and not is_rest:
        seen = ("visibility_depth",) if is_rims else ("seen_range",)
    return pipeline(
        what if not textured else f"textured_{what}",
        f"{_HOSTS[works_in]}.vert",
        f"{_HOSTS[works_in]}.frag",
        words,
        frame,
        samplers=(
            *get_storage(frame.storage).samplers,
            *(("materials",) if own_materials else ()),
            *seen,
            *(("coarse_depth",) if culls else ()),
            *(name for name in planned.reads if name in _LAYER_SAMPLERS and planned.layer),
            *(_TEXTURE_SAMPLERS if textured else ()),
            *(("lit_splats",) if is_rest else ()),
        ),
        varyings=(
            *((("flat", "float", "straddling"),) if straddles else ()),
            *_PLACE_VARYINGS[works_in],
            ("flat", "vec4", "color_weight"),
            ("flat", "vec3", "normal"),
            *((("flat", "float", "opacity"),) if planned.layer else ()),
            *_material_varyings(planned),
            *identity_varyings(planned),
            *(_TEXTURE_VARYINGS if textured else ()),
            *(_AXES_VARYINGS if textured and works_in == "space" else ()),
        ),
        outputs=_outputs(planned),
        constants=(
            *((("PIXEL_VARIANCE", pixel_variance(frame)),) if textured else ()),
            *((("TEXELS_PER_MATERIAL", "2" if "emission_sum" in sums else "1"),) if own_materials else ()),
        ),
        blend="add" if works_in != "sprites" and not is_rims else "none",
        depth_test=not is_rest and (works_in != "picture" or is_rims or not frame.linear_depth),
        depth_write=works_in == "sprites" or is_rims,
        fragment_depth=works_in == "space" and frame.linear_depth,
        sample_shading=works_in == "space" and frame.sample_shading,
    )


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
