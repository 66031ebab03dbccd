# SPDX-License-Identifier: GPL-3.0-or-later
"""The visibility pass: depth, every splat moved back by its epsilon (Botsch et al. 2005, section 3); and whose it is,
where that is asked for.
"""

from __future__ import annotations

from dataclasses import replace

from ..device.interface import PipelineDescription, Target
from ..frame_plan import TEXTURES, VISIBILITY_ROWS, FramePlan, PlannedPass
from ..storages import get_storage
from ..view import View
from .polygons import draw_polygons
from .splats import draw_splats, drawn_by
from .tile import TileContext
from .words import identity_varyings, kind, pipeline, says_whose, split


def describe(planned: PlannedPass, frame: FramePlan, has_door: bool = False) -> PipelineDescription:
    """What the pass draws splats with. has_door: they leave as much out of a shadow map as shows through them."""
    door = ("transparent_shadows",) if has_door else ()
    return _described(
        planned,
        frame,
        "visibility",
        "visibility.vert",
        (*split(frame), *door),
        (*get_storage(frame.storage).samplers, *planned.reads),
        (("flat", "vec2", "opacity_surface"),) if has_door else (),
    )


def describe_polygons(planned: PlannedPass, frame: FramePlan) -> PipelineDescription:
    """What it draws polygons with."""
    varyings = (("smooth", "vec3", "split_place"),) if split(frame) else ()
    words = (*split(frame), "of_polygons")
    return _described(
        planned, frame, "polygon_visibility", "polygon_visibility.vert", words, ("polygon_corners",), varyings
    )


def _described(planned, frame, name, vertex, words, samplers, varyings) -> PipelineDescription:
    layer = ("transparency",) if planned.layer else ()
    return pipeline(
        name,
        vertex,
        "visibility.frag",
        (*words, *says_whose(planned), *layer, kind(planned), "moved_back"),
        frame,
        samplers=samplers,
        varyings=(
            ("smooth", "vec3", "place_depth"),
            *((("smooth", "vec3", "across_offset"),) if frame.linear_depth else ()),
            *identity_varyings(planned),
            *varyings,
        ),
        outputs=(("vec2", "identity"),) if says_whose(planned) else (),
        depth_test=True,
        depth_write=True,
        fragment_depth=frame.linear_depth,
        sample_shading=frame.sample_shading,
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
