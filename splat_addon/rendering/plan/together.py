# SPDX-License-Identifier: GPL-3.0-or-later
"""What a tile draws by one call: instances of one kind, and small objects of different kinds from a pool."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ..detail import steps as detail
from ..passes.decisions import merging
from ..scene import Instance, Placed
from ..scene.kinds import Kinds
from ..upload.pools import MOST_POOLED, Pool, may_share
from ..upload.storages import get_storage
from ..view import Items
from .batches import batches, pooled_batches

if TYPE_CHECKING:
    from .tile import TileContext


def batches_of(tile: TileContext, items: Items) -> list[Items]:
    """The items in groups that are drawn together, except those of a pool."""
    return tile.repeats.found((items, "batches"), lambda: _made_batches(tile, items))


def _made_batches(tile: TileContext, items: Items) -> list[Items]:
    alone = items
    if pooled := pool_of(tile, items):
        alone = items.of_kinds(lambda placed: id(placed) not in pooled.rows)
    # a cut is its instance's own
    are_whole = alone.table.of_kinds(lambda placed: tile.levels(placed) is None)
    steps = tile.steps_of(alone)
    return batches(alone, alone.table.triangles * are_whole, steps, tile.show_nearest(alone, steps))


def pool_of(tile: TileContext, items: Items) -> Pool | None:
    """The pool that items of different kinds are drawn from, if there is one."""
    return made_pool(tile, type(items.table.placed[0])) if len(items) else None


def made_pool(tile: TileContext, kind: type) -> Pool | None:
    """The pool of surfels or of polygons, if there is one."""
    return tile.shared.kept(("pool", kind), lambda: _made_pool(tile, kind))


def _made_pool(tile: TileContext, kind: type) -> Pool | None:
    of = tile.shared.kept(("pooled", kind), lambda: kinds_in_pool(tile, kind))
    return tile.resources.pool(of, get_storage(tile.plan.storage)) if of else None


def kinds_in_pool(tile: TileContext, kind: type) -> list[Placed]:
    """One instance of each kind in the pool of surfels or of polygons: small ones of which there are few."""
    kinds, levels = tile.scene.table.kinds.of(kind), tile.plan.find(merging)
    numbers, triangles = kinds.find(_numbers_and_triangles)
    may = np.array(kinds.holds(may_share), bool) & (numbers < detail.LEAST_TOGETHER)
    rows = np.flatnonzero(may & ~np.array([k.placed.shape in levels for k in kinds] if levels else False))
    rows = rows[: int(np.searchsorted(np.cumsum(triangles[rows]), MOST_POOLED, "right"))]
    return [kinds[k].placed for k in rows.tolist()] if numbers[rows].sum() >= detail.LEAST_TOGETHER else []


def pooled_batches_of(tile: TileContext, items: Items) -> list[tuple[Items, tuple[str, ...], int]]:
    """What is drawn from the pool: groups, with the variants of their programs and the triangles of each item."""
    return tile.repeats.found((items, "pooled"), lambda: list(_found_in_pool(tile, items)))


def _found_in_pool(tile: TileContext, items: Items):
    if (pool := pool_of(tile, items)) is None:
        return
    every = items.table.every_kind
    # both are kept, so that their ids stay theirs
    rows, *_ = tile.shared.kept(("rows", id(pool), id(every)), lambda: (_rows_in(pool, every), pool, every))
    kinds = rows[items.table.kind_of]
    own, kinds = items.taken(kinds >= 0), kinds[kinds >= 0]
    first, clipped, counts = (array[kinds] for array in (pool.first, pool.clipped, pool.counts))
    nearest = tile.show_nearest(own)
    for more, start, size in (((), first + clipped, counts - clipped), (("clipped",), first, clipped)):
        for some in (np.flatnonzero(nearest), np.flatnonzero(~nearest)):
            for batch, most in pooled_batches(own.taken(some), start[some], size[some]):
                yield replace(batch, show_nearest=bool(nearest[some[0]])), more, most


def _rows_in(pool: Pool, every_kind: tuple[Placed, ...]) -> np.ndarray:
    """(k,) the row of each kind in a pool; -1 if it is not in it."""
    return np.array([pool.rows.get(id(placed), -1) for placed in every_kind], int)


def coarse(tile: TileContext, items: Items) -> int:
    """The number of surfels that the storage makes visibly less precise."""
    pool = pool_of(tile, items)
    alone = [kind for kind in items.table.kinds if not pool or id(kind.placed) not in pool.rows]
    return sum(kind.count * tile.stored(kind.placed).coarse for kind in alone) + (pool.coarse if pool else 0)


def _numbers_and_triangles(kinds: Kinds) -> tuple[np.ndarray, np.ndarray]:
    """(k,) of each kind its instances, and the triangles of one."""
    corners = [1 if isinstance(placed, Instance) else 3 for placed, _ in kinds]
    sizes = np.array([len(placed.shape) for placed, _ in kinds], int)
    return np.array([count for _, count in kinds], int), sizes // np.array(corners, int)
