# SPDX-License-Identifier: GPL-3.0-or-later
"""The last transparent layer: all that is left, without an order, each splat lit by itself (Guennebaud et al. 2006)."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..device.interface import PipelineDescription, Target
from ..frame_plan import FramePlan, PlannedPass
from ..packing import SPLATS_PER_ROW, row_count
from ..shaders import load
from ..storages import get_storage
from ..view import PlacedInstance
from . import attributes
from .blocks import material_defines, std140
from .shading import SHADING_BLOCK, shading_block, shading_defines, shading_textures
from .splats import draw_splats, drawn_by, instance_textures, instance_values
from .tile import TileContext

#: Of the instance whose splats are lit, beside what shading is told: sides and light_set as `SPLATS_BLOCK` has them.
LIGHT_BLOCK = (
    *SHADING_BLOCK[:2],
    (*SHADING_BLOCK[2], ("mat4", "model_view"), ("mat4", "normal_matrix"), ("vec4", "sides"), ("vec4", "light_set")),
)


def describe_light(planned: PlannedPass, frame: FramePlan) -> PipelineDescription:
    """What splats are lit with: one fragment each, at the texel of its number."""
    light = tuple(name for name in planned.reads if name not in ("visibility_depth", "peeled"))
    with_materials = material_defines(frame.textures)
    return PipelineDescription(
        name="lit_splats",
        vertex=load("fullscreen.vert.glsl"),
        fragment=load("lit_splats.frag.glsl", shading=frame.shading, storage=frame.storage),
        block=LIGHT_BLOCK,
        samplers=(*get_storage(frame.storage).samplers, *(("materials",) if with_materials else ()), *light),
        outputs=(("vec4", "lit_splats"),),
        defines=(
            *with_materials,
            *((("LIGHT_SET_TARGET", "1"),) if "light_set_sum" in frame.textures else ()),
            *shading_defines(light, frame),
        ),
    )


def describe(planned: PlannedPass, frame: FramePlan) -> PipelineDescription:
    """What lit splats are added up with: as attributes are, but behind the layers that are peeled, all of them."""
    drawn = attributes.describe(replace(planned, writes=planned.writes[1:]), frame)
    samplers = tuple(name for name in drawn.samplers if name != "seen_range")
    return replace(
        drawn,
        name="rest",
        samplers=(*samplers, "lit_splats"),
        defines=(*drawn.defines, ("REST", "1")),
        depth_test=False,
    )


def run(tile: TileContext, planned: PlannedPass) -> Target:
    """Fill the sums, one instance after the other, whose splats are lit first."""
    resources, (lit, *sums) = tile.resources, planned.writes
    light, add = (resources.pipeline(make(planned, tile.plan)) for make in (describe_light, describe))
    lit_target, target = tile.target((lit,)), tile.target(tuple(sums))
    target.clear(color=0.0)
    textures, block = shading_textures(tile), shading_block(tile)
    for placed in drawn_by(planned, tile):
        reads = tile.textures(light.description.samplers, {**textures, **instance_textures(tile, placed.instance)})
        viewport = 0, 0, SPLATS_PER_ROW, row_count(placed.instance.surfels)
        resources.device.draw_triangles(light, lit_target, 1, _light_block(block, placed), reads, viewport)
        draw_splats(tile, add, target, [placed])
    return target


def _light_block(block: np.ndarray, placed: PlacedInstance) -> np.ndarray:
    normal_matrix, orientation, light_set = instance_values(placed)
    sides = orientation, placed.hides_backs, 0.0, 0.0
    return np.concatenate([block, std140(placed.model_view, normal_matrix, sides, light_set)])
