# SPDX-License-Identifier: GPL-3.0-or-later
"""Splats of a few pixels or less do not blend with one another: visibility notes which is nearest, and one pass finds
its attributes once for each sample (Burns, Hunt, "The Visibility Buffer", 2013). What samples show is blended by the
filter of silhouettes, and by the mean of several samples.

Such splats cost about a third of others, and show small objects more as they are (docs/evidence/performance.md).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..passes.decisions import have_rows, nearest_kinds
from ..passes.drawing import draw_block
from ..passes.rasterizers import storage_samplers
from ..passes.sums import depth_parts
from ..passes.textures import COLOR_SUM, NORMAL_SUM, VISIBILITY_DEPTH, of_rows, rows_of
from ..plan.graph import Part, Pass, Texture
from ..plan.hosts import Host, Kind
from ..plan.numbering import noted
from ..plan.planning import count
from ..scene import Placed
from ..view import DrawItem, Items

#: Of the nearest splat 1 + the number of its object, and its own; 0 where it is not noted.
NEAREST = Texture("nearest_splat", "RG32F")
ROW_NEAREST = Texture("row_nearest_splat", "RG32F", of_rows)


def _texture(planning) -> Texture:
    return ROW_NEAREST if planning.find(have_rows) else NEAREST


def is_present(planning) -> bool:
    return bool(planning.shown and planning.find(nearest_kinds))


def passes(planning):
    if not is_present(planning):
        return
    kinds, seen = {id(placed) for placed in planning.find(nearest_kinds)}, _texture(planning)
    instances = count(lambda placed: id(placed) in kinds, planning.surfels)
    own = Part(
        "nearest_splats",
        reads=(seen, VISIBILITY_DEPTH),
        inputs=(*storage_samplers(planning), "instances"),
        writes=(COLOR_SUM,),
        called=((seen, NEAREST.name),),
        varyings=(("flat", "vec3", "normal"),),
        constants=(("ROWS", rows_of(seen)),),
        choices=(("instances", "noted"),),
    )
    parts = own, Part("gbuffer"), depth_parts(planning, Kind.OPAQUE, writes=(NORMAL_SUM,))
    why = f"splats of {instances:,} instances do not blend where they are small"
    yield Pass("nearest_splats", why, Host.NEAREST_SPLATS, run, parts, state={"blend": "add"}, adds=True)


def parts(planning, p):
    if p.host == Host.VISIBILITY and p.kind == Kind.OPAQUE:
        seen, varyings = _texture(planning), (("flat", "vec2", "told_splat"),)
        yield Part("nearest_splats", ("notes",), writes=(seen,), called=((seen, NEAREST.name),), varyings=varyings)


def run(tile, p: Pass):
    """Add the nearest splat of each sample, of one kind or pool after another."""
    target, program, drawn = tile.target(p), tile.program(p), tile.drawn_by(p)
    of_kinds = noted(tile)
    seen = {own: kind.placed for kind in drawn.table.kinds if (own := of_kinds.get(id(kind.placed)))}
    for own, of_kind in seen.items():
        placed = _any_of(tile, of_kind, own.is_pooled)
        blocks = tile.blocks(program, placed, draw_block(tile, placed, stride=own.count))
        call = blocks, tile.textures(p, program, placed), tile.seen_part(p)
        tile.repeats.call(tile.resources.device.draw_fullscreen, program, target, *call)
    return target


def _any_of(tile, of_kind: Placed, is_pooled: bool) -> DrawItem:
    """An instance of a kind, among all that may be noted."""
    items = tile.repeats.found("may be noted", lambda: _by_number(tile))
    if is_pooled:
        items = tile.repeats.found("in a pool", lambda: replace(items, places=np.zeros((len(items), 2))))
    return items.item(int(np.flatnonzero(items.table.of_kinds(lambda placed: placed is of_kind))[0]))


def _by_number(tile) -> Items:
    """The instances that may be noted, each in the row of its number in the scene; rows of others have any."""
    own = {id(placed) for placed in tile.plan.find(nearest_kinds)}
    items = tile.view.placed.of_kinds(lambda placed: id(placed) in own)
    rows = np.zeros(int(items.table.numbers.max(initial=-1)) + 1, int)
    rows[items.table.numbers] = np.arange(len(items))
    return replace(items.taken(rows), show_nearest=True)
