# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the splats and polygons of a view, for the passes of several features."""

from __future__ import annotations

from collections.abc import Generator, Iterable
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ..culling.polygon_runs import triangle_runs
from ..device.interface import Pipeline
from ..device.interface import Texture as DeviceTexture
from ..methods.method import RASTERIZERS
from ..plan.graph import Pass, Pause
from ..plan.uniforms import DRAW, std140
from ..scene.light import MAX_LIGHT_SETS
from ..upload.storages import STORAGES, get_storage
from ..view import DrawItem

if TYPE_CHECKING:
    from ..plan.executor import TileContext
    from ..upload.cuts import Cut

#: Triangles of a draw call, after which drawing may pause.
AT_ONCE = 1 << 15

#: Fragment shaders that add splats to sums.
SPLAT_HOSTS = tuple(f"{name}.frag" for name in RASTERIZERS)
#: Fragment shaders that light samples.
LIT_HOSTS = ("shading.frag", "deferred_lighting.frag")
#: Fragment shaders that light samples or individual splats.
LIGHTING_HOSTS = (*LIT_HOSTS, "lit_splats.frag")


def _stored(tile: TileContext, placed: DrawItem, sampler: str) -> DeviceTexture:
    return tile.stored(placed.instance).parts[placed.part][sampler]


#: sampler -> the texture of the object being drawn
DRAWN = {name: partial(_stored, sampler=name) for storage in STORAGES.values() for name in storage.samplers} | {
    "polygon_corners": lambda tile, placed: tile.resources.polygons(placed.instance.polygons),
}
#: Which of them take long to arrive, and whether an instance needs them.
ARRIVES = {name: lambda instance: True for storage in STORAGES.values() for name in storage.samplers}


def draw_splats(
    tile: TileContext, p: Pass, target, placed_ones: Iterable[DrawItem], vertex, *variants, viewport=None
) -> Generator[Pause]:
    """Draw each instance, part by part; pauses after each draw call.

    variants: of the pass's programs. viewport: as `Device.draw_triangles` takes it.
    """
    parts = (part for placed in placed_ones for part in tile.in_parts(placed))
    yield from draw_parts(tile, p, target, parts, vertex, *variants, viewport=viewport)


def draw_parts(
    tile: TileContext, p: Pass, target, parts: Iterable[tuple[DrawItem, Cut]], vertex, *variants, viewport=None
) -> Generator[Pause]:
    """Draw the parts of `TileContext.in_parts`, their splats with clip lines, which are stored first, apart."""
    programs = {}
    for placed, cut in parts:
        own = () if cut.numbers is None else ("cut",)
        for more, first, end in ((own, cut.clipped, cut.count), ((*own, "clipped"), 0, cut.clipped)):
            if first < end:
                if more not in programs:
                    programs[more] = tile.program(p, vertex, *variants, *more)
                    # compiling it may have taken this call's time
                    yield Pause()
                which = range(first, end)
                yield from _draw(tile, p, target, placed, tile.settings.epsilon, programs[more], which, viewport)


def draw_polygons(
    tile: TileContext, p: Pass, target, placed_ones: Iterable[DrawItem], vertex, *variants, viewport=None
) -> Generator[Pause]:
    """Draw polygons; epsilon: how far behind polygons splats may lie. Those with holes have a program of their own."""
    programs = {}
    for placed in placed_ones:
        kinds = {"cut_out": placed.instance.is_cut_out, "bumped": placed.instance.is_bumped}
        more = tuple(kind for kind, is_so in kinds.items() if is_so)
        program = programs[more] = programs.get(more) or tile.program(p, vertex, *variants, *more)
        for which in triangle_runs(placed, tile.camera, tile.view):
            yield from _draw(tile, p, target, placed, placed.overlap, program, which, viewport)


def _draw(
    tile, p, target, placed: DrawItem, epsilon: float, program: Pipeline, which: range, viewport
) -> Generator[Pause]:
    """Draw. which: numbers of the triangles."""
    blocks = tile.blocks(program, draw_block(tile, placed, epsilon))
    textures = tile.textures(p, program, placed)
    for start in which[::AT_ONCE]:
        count = min(AT_ONCE, which.stop - start)
        tile.resources.device.draw_triangles(program, target, count, blocks, textures, viewport, start)
        yield Pause(target)


def draw_block(tile: TileContext, placed: DrawItem, epsilon: float) -> np.ndarray:
    """The values of `uniforms.DRAW`."""
    normal_matrix = np.eye(4)
    normal_matrix[:3, :3] = placed.normal_matrix
    values = (
        placed.model_view,
        normal_matrix,
        np.eye(MAX_LIGHT_SETS)[placed.instance.light_set],
        float(np.sign(np.linalg.det(placed.normal_matrix))),
        placed.hides_backs,
        epsilon,
        max(tile.view.least_offset(tile.plan.linear_depth), placed.setback),
        *tile.identities.slots(placed.instance),
        placed.split_distance,
        tile.first_merged(placed),
        tile.rows_without_lines(placed),
    )
    return std140(DRAW, values)


def storage_samplers(storage: str) -> tuple[str, ...]:
    return get_storage(storage).samplers
