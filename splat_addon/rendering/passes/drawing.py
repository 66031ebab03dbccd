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
from ..plan.graph import Pass, Pause
from ..plan.hosts import SPLAT_HOSTS
from ..plan.numbering import first_noted
from ..plan.together import batches_of, pool_of, pooled_batches_of
from ..plan.uniforms import DRAW, std140
from ..upload.packing import PLAIN_TEXELS, MaterialTexels
from ..upload.storages import STORAGES
from ..view import DrawItem, Items

if TYPE_CHECKING:
    from ..plan.tile import TileContext
    from ..upload.cuts import Cut

#: Triangles of a draw call, after which drawing may pause.
AT_ONCE = 1 << 15


def _stored(tile: TileContext, placed: DrawItem, sampler: str) -> DeviceTexture:
    return pooled(tile, placed, sampler) or tile.stored(placed.instance).parts[placed.part][sampler]


def pooled(
    tile: TileContext, placed: DrawItem, sampler: str, more: MaterialTexels = PLAIN_TEXELS
) -> DeviceTexture | None:
    """The texture of the pool that an object is drawn from; None if it has its own. more: as of `Pool.texture`."""
    return None if placed.items.places is None else pool_of(tile, placed.items).texture(sampler, more)


def _corners(tile: TileContext, placed: DrawItem) -> DeviceTexture:
    return pooled(tile, placed, "polygon_corners") or tile.resources.polygons(placed.instance.polygons)


#: sampler -> the texture of the object being drawn
DRAWN = {name: partial(_stored, sampler=name) for storage in STORAGES.values() for name in storage.samplers} | {
    "polygon_corners": _corners,
}
#: Which of them take long to arrive, and whether an instance needs them.
ARRIVES = {name: lambda instance: True for storage in STORAGES.values() for name in storage.samplers}


def draw_splats(tile: TileContext, p: Pass, target, items: Items, vertex, *variants, viewport=None) -> Generator[Pause]:
    """Draw instances, many at once where they are alike, or part by part; pauses after each draw call.

    variants: of the pass's programs. viewport: as `Device.draw_triangles` takes it.
    """
    programs = Programs(tile, p, vertex, *variants)
    yield from _draw_pooled(tile, p, target, items, programs, viewport)
    for batch in batches_of(tile, items):
        if batch.show_nearest and p.host in SPLAT_HOSTS:
            continue
        if len(batch) == 1 and batch.step is None:
            yield from draw_parts(tile, p, target, tile.in_parts(batch.item(0)), programs, viewport)
            continue
        own, first, clipped, last = _whole(tile, batch)
        own = (*own, *_kinds(batch.item(0)))
        for more, which in ((own, range(clipped, last)), ((*own, "clipped"), range(first, clipped))):
            if which:
                program = yield from programs.of("together", *more)
                yield from _draw_together(tile, p, target, batch, program, which, viewport)


def _whole(tile: TileContext, batch: Items) -> tuple[tuple[str, ...], int, int, int]:
    """What is drawn of each instance: variants of programs, and where its splats begin, clipped ones end, and all
    end."""
    surfels = batch.item(0).instance.surfels
    if batch.step is None:
        return (), 0, surfels.clipped_count, len(surfels)
    steps = tile.steps(batch.item(0).instance)
    if not steps.errors[batch.step, 0]:
        return (), 0, surfels.clipped_count, len(surfels)
    return ("cut",), *(int(ends[batch.step]) for ends in (steps.first, steps.clipped, steps.last))


def _kinds(placed: DrawItem) -> tuple[str, ...]:
    """Further variants of the programs that draw an instance's surfels."""
    return ("with_holes",) if placed.instance.has_holes else ()


def draw_parts(
    tile: TileContext, p: Pass, target, parts: Iterable[tuple[DrawItem, Cut]], programs: Programs, viewport=None
) -> Generator[Pause]:
    """Draw the parts of `TileContext.in_parts`, their splats with clip lines, which are stored first, apart."""
    for placed, cut in parts:
        own = (*(() if cut.numbers is None else ("cut",)), *_kinds(placed))
        for more, first, end in ((own, cut.clipped, cut.count), ((*own, "clipped"), 0, cut.clipped)):
            if first < end:
                program = yield from programs.of(*more)
                yield from _draw(tile, p, target, placed, program, range(first, end), viewport)


def draw_polygons(
    tile: TileContext, p: Pass, target, items: Items, vertex, *variants, viewport=None
) -> Generator[Pause]:
    """Draw polygons. Those with holes have a program of their own."""
    programs = Programs(tile, p, vertex, *variants)
    yield from _draw_pooled(tile, p, target, items, programs, viewport)
    for batch in batches_of(tile, items):
        placed = batch.item(0)
        more = tuple(kind for kind in ("cut_out", "bumped", "glossed") if getattr(placed.instance, f"is_{kind}"))
        if len(batch) == 1:
            program = yield from programs.of(*more)
            for which in triangle_runs(placed, tile.camera):
                yield from _draw(tile, p, target, placed, program, which, viewport)
        else:
            program, which = (yield from programs.of("together", *more)), range(placed.instance.polygons.triangles)
            yield from _draw_together(tile, p, target, batch, program, which, viewport)


class Programs:
    """The programs of a pass, which are found once. variants: of all of them."""

    def __init__(self, tile: TileContext, p: Pass, vertex: str, *variants: str):
        self._make = partial(tile.program, p, vertex, *variants)
        self._made: dict[tuple[str, ...], Pipeline] = {}

    def of(self, *more: str) -> Generator[Pause, None, Pipeline]:
        """The program of further variants; pauses, because compiling it may have taken this call's time."""
        if more not in self._made:
            self._made[more] = self._make(*more)
            yield Pause()
        return self._made[more]


def _draw(tile, p, target, placed: DrawItem, program: Pipeline, which: range, viewport) -> Generator[Pause]:
    """Draw one instance. which: numbers of the triangles."""
    blocks, textures = tile.blocks(program, placed, draw_block(tile, placed)), tile.textures(p, program, placed)
    for start in which[::AT_ONCE]:
        count = min(AT_ONCE, which.stop - start)
        tile.draw_triangles(program, target, count, blocks, textures, viewport, start)
        yield Pause(target)


def _draw_together(tile, p, target, batch: Items, program: Pipeline, which: range, viewport) -> Generator[Pause]:
    """Draw instances of one kind. which: numbers of the triangles of each."""
    placed, at_once = batch.item(0), max(AT_ONCE // len(which), 1)
    textures = tile.textures(p, program, placed)
    for start in range(0, len(batch), at_once):
        triangles = min(at_once, len(batch) - start) * len(which)
        blocks = tile.blocks(program, placed, draw_block(tile, placed, start, which.start, len(which)))
        tile.draw_triangles(program, target, triangles, blocks, textures, viewport)
        yield Pause(target)


def _draw_pooled(tile, p, target, items: Items, programs: Programs, viewport) -> Generator[Pause]:
    """Draw those of the items that are in a pool."""
    for batch, more, most in pooled_batches_of(tile, items):
        if batch.show_nearest and p.host in SPLAT_HOSTS:
            continue
        program = yield from programs.of("together", *more)
        yield from _draw_together(tile, p, target, batch, program, range(most), viewport)


def draw_block(
    tile: TileContext, placed: DrawItem, first_instance: int = 0, first: int = 0, stride: int = 1
) -> np.ndarray:
    """The values of `uniforms.DRAW`."""
    values = (
        tile.settings.epsilon,
        tile.settings.epsilon_length * tile.view.scale,
        max(tile.view.least_offset(tile.plan.linear_depth), placed.items.setback),
        tile.first_merged(placed),
        tile.rows_without_lines(placed),
        first_instance,
        first,
        stride,
        first_noted(tile, placed),
    )
    return std140(DRAW, values)
