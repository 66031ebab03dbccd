# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers by which visibility notes which splat is nearest: objects have those of the scene, and the stored splats
of all kinds that may show the nearest one follow one another."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ..passes.decisions import nearest_kinds
from ..scene import Instance, Placed
from ..view import DrawItem
from .together import made_pool

if TYPE_CHECKING:
    from ..upload.pools import Pool
    from .tile import TileContext


class Noted(NamedTuple):
    """Stored splats that follow one another: of the kind of an instance, or of the pool that it is in. first: number of
    the first one. count: of them."""

    placed: Placed
    first: int
    count: int
    is_pooled: bool


def noted(tile: TileContext) -> dict[int, Noted]:
    """Where the stored splats of each kind are, by the id of one of its instances, which the plan keeps."""
    return tile.shared.kept("noted", lambda: _found(tile, made_pool(tile, Instance)))


def _found(tile: TileContext, pool: Pool | None) -> dict[int, Noted]:
    found, first, of_pool = {}, 0, None
    for placed in tile.plan.find(nearest_kinds):
        is_pooled = pool is not None and id(placed) in pool.rows
        if is_pooled and of_pool:
            found[id(placed)] = of_pool
        elif is_pooled or tile.levels(placed) is not None:
            places = (pool.first + pool.counts - 1) if is_pooled else tile.stored(placed).places
            made = found[id(placed)] = Noted(placed, first, int(places.max()) + 1, is_pooled)
            of_pool, first = made if is_pooled else of_pool, first + made.count
    return found


def first_noted(tile: TileContext, placed: DrawItem) -> float:
    """The number of the first stored splat of an object; -1 if visibility does not note its splats."""
    if not placed.items.show_nearest:
        return -1.0
    table = placed.items.table
    kind = table.prototypes.kinds[table.of[placed.row]]
    return float(noted(tile)[id(table.every_kind[kind])].first)
