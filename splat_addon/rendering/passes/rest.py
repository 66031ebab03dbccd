# SPDX-License-Identifier: GPL-3.0-or-later
"""The last transparent layer: all that is left, without an order, each splat lit by itself (Guennebaud et al. 2006)."""

from __future__ import annotations

from dataclasses import replace

from ..device.interface import PipelineDescription, Target
from ..frame_plan import FramePlan, PlannedPass
from ..packing import SPLATS_PER_ROW, row_count
from ..storages import get_storage
from . import attributes
from .shading import light_choices, light_words, shading_textures
from .splats import draw_block, draw_splats, drawn_by, instance_textures
from .tile import TileContext
from .words import pipeline, sum_words


def describe_light(planned: PlannedPass, frame: FramePlan) -> PipelineDescription:
    """What splats are lit with: one fragment each, at the texel of its number."""
    light = tuple(name for name in planned.reads if name not in ("visibility_depth", "peeled"))
    with_materials = {"material_sum", "emission_sum"} & set(frame.textures)
    sums = tuple(name for name in ("material_sum", "emission_sum", "light_set_sum") if name in frame.textures)
    return pipeline(
        "lit_splats",
        "fullscreen.vert",
        "lit_splats.frag",
        set(sum_words(sums, planned)) | light_words(light, frame) - {"split"},
        frame,
        light_choices(light),
        (("TEXELS_PER_MATERIAL", "2" if "emission_sum" in sums else "1"),) if with_materials else (),
        samplers=(*get_storage(frame.storage).samplers, *(("materials",) if with_materials else ()), *light),
        outputs=(("vec4", "lit_splats"),),
    )


def describe(planned: PlannedPass, frame: FramePlan) -> PipelineDescription:
    """What lit splats are added up with: as attributes are, but behind the layers that are peeled, all of them."""
    return attributes.describe(replace(planned, writes=planned.writes[1:]), frame, what="rest")


def run(tile: TileContext, planned: PlannedPass) -> Target:
    """Fill the sums, one instance after the other, whose splats are lit first."""
    resources, (lit, *sums) = tile.resources, planned.writes
    light, add = (resources.pipeline(make(planned, tile.plan)) for make in (describe_light, describe))
    lit_target, target = tile.target((lit,)), tile.target(tuple(sums))
    target.clear(color=0.0)
    textures = shading_textures(tile)
    for placed in drawn_by(planned, tile):
        reads = tile.textures(light.description.samplers, {**textures, **instance_textures(tile, placed.instance)})
        viewport = 0, 0, SPLATS_PER_ROW, row_count(placed.instance.surfels)
        blocks = tile.blocks(light.description.blocks, draw_block(tile, placed, tile.settings.epsilon))
        resources.device.draw_triangles(light, lit_target, 1, blocks, reads, viewport)
        draw_splats(tile, add, target, [placed])
    return target

