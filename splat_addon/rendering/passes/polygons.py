# SPDX-License-Identifier: GPL-3.0-or-later
"""The polygon pass: the attributes of the nearest polygon of each sample (Guennebaud et al. 2006, section 5.1).

Shading joins them with the splats' means (shaders/common/mean_surface.glsl).
"""

from __future__ import annotations

from collections.abc import Iterable

from ..device.interface import Pipeline, PipelineDescription, Target
from ..frame_plan import FramePlan, PlannedPass
from ..view import PlacedInstance
from .splats import draw_block
from .tile import TileContext
from .words import identity_varyings, pipeline, pixel_variance, says_whose, split

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
    needed = _needed_sums(frame)
    has_plane = textured or "polygon_plane" in colors
    words = {*says_whose(planned), *split(frame)}
    words |= {"materials"} if "material_sum" in needed else set()
    words |= {"emission", "gbuffer_emission"} if "emission_sum" in needed else set()
    words |= {"polygon_material"} if "polygon_material" in colors else set()
    words |= {"polygon_plane"} if has_plane else set()
    words |= {"writes_polygon_plane"} if "polygon_plane" in colors else set()
    words |= {"polygons", "depth_bounds"} if planned.reads else set()
    words |= {"textures"} if textured else set()
    return pipeline(
        "textured_polygons" if textured else "polygons",
        "polygons.vert",
        "polygons.frag",
        words,
        frame,
        constants=(
            *((("PIXEL_VARIANCE", pixel_variance(frame)),) if textured else ()),
            *((("TEXELS_PER_MATERIAL", "2" if "emission_sum" in needed else "1"),) if needed else ()),
        ),
        samplers=(
            "polygon_corners",
            *(("materials",) if needed else ()),
            *planned.reads,
            *(_SAMPLERS if textured else ()),
        ),
        varyings=(
            ("smooth", "float", "depth_at"),
            ("smooth", "vec3", "corner_normal"),
            ("smooth", "vec3", "corner_color"),
            *((("smooth", "vec3", "split_place"),) if split(frame) else ()),
            *(_PLANE_VARYINGS if has_plane else ()),
            *(("smooth", "vec3", name[:-4]) for name in needed),
            *identity_varyings(planned),
            *(_TEXTURE_VARYINGS if textured else ()),
        ),
        outputs=tuple(("vec2" if name == "polygon_identity" else "vec4", name) for name in colors),
        depth_test=True,
        depth_write=True,
        fragment_depth=frame.linear_depth,
        sample_shading=frame.sample_shading,
    )


def _needed_sums(frame: FramePlan) -> tuple[str, ...]:
    """The sums over materials that the frame would have of splats."""
    needed = {"material_sum": frame.material is None, "emission_sum": frame.emission is None}
    written = {"material_sum": "polygon_material", "emission_sum": "polygon_emission"}
    return tuple(name for name, is_needed in needed.items() if is_needed and written[name] in frame.textures)


def draw_polygons(
    tile: TileContext, program: Pipeline, target: Target, placed_ones: Iterable[PlacedInstance], viewport=None
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
        textures = tile.textures(program.description.samplers, made_here)
        blocks = tile.blocks(program.description.blocks, draw_block(tile, placed, placed.overlap))
        resources.device.draw_triangles(program, target, instance.polygons.triangles, blocks, textures, viewport)


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
