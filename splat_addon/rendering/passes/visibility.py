# SPDX-License-Identifier: GPL-3.0-or-later
"""The visibility pass: depth, every splat moved back by its epsilon (Botsch et al. 2005, section 3); and whose it is,
where that is asked for.
"""

from __future__ import annotations

from dataclasses import replace

from ..device.interface import PipelineDescription, Target
from ..frame_plan import TEXTURES, VISIBILITY_ROWS, FramePlan, PlannedPass
from ..shaders import load
from ..storages import get_storage
from ..view import View
from .blocks import LAYER, LINEAR_DEPTH, identity_defines, identity_varyings, says_whose, split_defines, split_polygons
from .polygons import draw_polygons
from .splats import SPLATS_BLOCK, draw_splats, drawn_by
from .tile import TileContext


def describe(planned: PlannedPass, frame: FramePlan, has_door: bool = False) -> PipelineDescription:
    """What the pass draws splats with. has_door: they leave as much out of a shadow map as shows through them."""
    return PipelineDescription(
        name="visibility",
        vertex=load("visibility.vert.glsl", storage=frame.storage),
        fragment=load("visibility.frag.glsl"),
        block=SPLATS_BLOCK,
        samplers=(*get_storage(frame.storage).samplers, *planned.reads),
        varyings=(
            ("smooth", "vec3", "place_depth"),
            *((("smooth", "vec3", "across_offset"),) if frame.linear_depth else ()),
            *identity_varyings(planned),
            *((("flat", "vec2", "opacity_surface"),) if has_door else ()),
        ),
        outputs=(("vec2", "identity"),) if says_whose(planned) else (),
        defines=(
            *(LINEAR_DEPTH if frame.linear_depth else ()),
            *(LAYER if planned.layer else ()),
            *identity_defines(planned),
            *split_defines(frame),
            *((("SCREEN_DOOR", "1"),) if has_door else ()),
        ),
        depth_test=True,
        depth_write=True,
        fragment_depth=frame.linear_depth,
        sample_shading=frame.sample_shading,
    )


def describe_polygons(planned: PlannedPass, frame: FramePlan) -> PipelineDescription:
    """What it draws polygons with."""
    splats = describe(planned, frame)
    varyings, defines = split_polygons(frame)
    return replace(
        splats,
        name="polygon_visibility",
        vertex=load("polygons/visibility.vert.glsl"),
        samplers=("polygon_corners",),
        varyings=(*splats.varyings, *varyings),
        defines=tuple(dict.fromkeys((*splats.defines, *defines))),
    )


def draw_visible(tile: TileContext, planned: PlannedPass, target: Target, splats, viewport=None) -> None:
    """splats: placed instances; and, where no transparent layer is made, all polygons of the tile's view."""
    if splats:
        has_door = planned.name == "shadow_maps" and tile.plan.has("SCREEN_DOOR")
        pipeline = tile.resources.pipeline(describe(planned, tile.plan, has_door))
        draw_splats(tile, pipeline, target, splats, viewport)
    if tile.view.polygons and not planned.layer:
        pipeline = tile.resources.pipeline(describe_polygons(planned, tile.plan))
        draw_polygons(tile, pipeline, target, tile.view.polygons, viewport)


def run(tile: TileContext, planned: PlannedPass) -> Target:
    """Fill the depth texture, and that of numbers."""
    depth, *colors = planned.writes
    target = tile.target(tuple(colors), depth)
    target.clear(color=0.0 if colors else None, depth=1.0)
    if TEXTURES[depth][1] == "row":
        tile = replace(tile, view=_seen_by_rows(tile.view, target.size[1]))
    draw_visible(tile, planned, target, drawn_by(planned, tile))
    return target


def _seen_by_rows(view: View, rows: int) -> View:
    """A view moved in the picture, so that the first of a sample's rows goes through its centre as the sample does."""
    projection = view.projection.copy()
    projection[1] -= projection[3] * (VISIBILITY_ROWS - 1) / rows
    return replace(view, projection=projection)
