# SPDX-License-Identifier: GPL-3.0-or-later
"""The polygon pass: the attributes of the nearest polygon of each sample (Guennebaud et al. 2006, section 5.1).

Shading joins them with the splats' means (shaders/common/mean_surface.glsl).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from ..device.interface import Pipeline, PipelineDescription, Target
from ..frame_plan import FramePlan, PlannedPass
from ..methods import get_method
from ..shaders import load
from ..view import PlacedInstance
from .blocks import LINEAR_DEPTH, identity_defines, identity_varyings, material_defines, split_polygons
from .splats import SPLATS_BLOCK, splats_block
from .tile import TileContext

_SAMPLERS = ("polygon_uvs", "texture_atlas", "texture_table")
_PLANE_VARYINGS = (("flat", "vec3", "triangle_plane"),)
_TEXTURE_VARYINGS = (
    ("smooth", "vec2", "texture_uv"),
    ("flat", "float", "texture_slot"),
    ("flat", "vec3", "gradient_u"),
    ("flat", "vec3", "gradient_v"),
)


def describe(planned: PlannedPass, frame: FramePlan, textured: bool = False) -> PipelineDescription:
    """What the pass draws with. textured: for instances whose colours are looked up in textures."""
    colors = tuple(name for name in planned.writes if name != "polygon_depth")
    # what `material_defines` knows by the names of sums
    materials = material_defines(_needed_sums(frame))
    split_varyings, split_defines = split_polygons(frame)
    has_plane = "polygon_plane" in colors
    plain = PipelineDescription(
        name="polygons",
        vertex=load("polygons/attributes.vert.glsl"),
        fragment=load("polygons/attributes.frag.glsl"),
        block=SPLATS_BLOCK,
        samplers=("polygon_corners", *(("materials",) if materials else ()), *planned.reads),
        varyings=(
            ("smooth", "float", "depth_at"),
            ("smooth", "vec3", "corner_normal"),
            ("smooth", "vec3", "corner_color"),
            *split_varyings,
            *(_PLANE_VARYINGS if textured or has_plane else ()),
            *(("smooth", "vec3", name[:-4]) for name in _needed_sums(frame)),
            *identity_varyings(planned),
        ),
        outputs=tuple(("vec2" if name == "polygon_identity" else "vec4", name) for name in colors),
        defines=(
            *materials,
            *identity_defines(planned),
            *((("MATERIAL_OUTPUT", "1"),) if "polygon_material" in colors else ()),
            *((("SEEN_POLYGONS", "1"),) if planned.reads else ()),
            *split_defines,
            *((("PLANE", "1"),) if textured or has_plane else ()),
            *((("PLANE_OUTPUT", "1"),) if has_plane else ()),
            *(LINEAR_DEPTH if frame.linear_depth else ()),
        ),
        depth_test=True,
        depth_write=True,
        fragment_depth=frame.linear_depth,
        sample_shading=frame.sample_shading,
    )
    if not textured:
        return plain
    variance = get_method(frame.method).pixel_variance / (frame.multisamples if frame.sample_shading else 1)
    return replace(
        plain,
        name="textured_polygons",
        samplers=(*plain.samplers, *_SAMPLERS),
        varyings=(*plain.varyings, *_TEXTURE_VARYINGS),
        defines=(*plain.defines, ("TEXTURED", "1"), ("PIXEL_VARIANCE", repr(variance))),
    )


def _needed_sums(frame: FramePlan) -> tuple[str, ...]:
    """The sums over materials that the frame would have of splats."""
    needed = {"material_sum": frame.material is None, "emission_sum": frame.emission is None}
    written = {"material_sum": "polygon_material", "emission_sum": "polygon_emission"}
    return tuple(name for name, is_needed in needed.items() if is_needed and written[name] in frame.textures)


def draw_polygons(
    tile: TileContext, pipeline: Pipeline, target: Target, placed_ones: Iterable[PlacedInstance], viewport=None
) -> None:
    """One draw call an instance; the first of the block's options is how far behind it splats may lie."""
    resources = tile.resources
    for placed in placed_ones:
        instance = placed.instance
        made_here = {
            "polygon_corners": lambda i=instance: resources.polygons(i.polygons),
            "polygon_uvs": lambda i=instance: resources.polygon_uvs(i.polygons),
            "materials": lambda i=instance: resources.materials(i, None, "polygon_emission" in tile.plan.textures),
            "texture_atlas": lambda i=instance: resources.atlas(i.textures)[0],
            "texture_table": lambda i=instance: resources.atlas(i.textures)[1],
        }
        textures = tile.textures(pipeline.description.samplers, made_here)
        block = splats_block(tile, placed, placed.overlap)
        resources.device.draw_triangles(pipeline, target, instance.polygons.triangles, block, textures, viewport)


def run(tile: TileContext, planned: PlannedPass) -> Target:
    """Fill the polygons' textures."""
    *colors, depth = planned.writes
    target = tile.target(tuple(colors), depth)
    target.clear(color=0.0, depth=1.0)
    for textured in (False, True):
        seen = (p for p in tile.view.polygons if not p.instance.is_holdout)
        placed = [p for p in seen if p.instance.is_textured is textured]
        if placed:
            draw_polygons(tile, tile.resources.pipeline(describe(planned, tile.plan, textured)), target, placed)
    return target
