# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers by which visibility notes which splat is nearest: objects have those of the scene, and the stored splats
of all kinds that may show the nearest one follow one another."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from ..passes.decisions import nearest_kinds
from ..scene import Placed
from ..view import DrawItem

if TYPE_CHECKING:
    from .tile import TileContext


class Noted(NamedTuple):
    """The stored splats of a kind. first: number of the first one. count: of them."""

    placed: Placed
    first: int
    count: int


def noted(tile: TileContext) -> dict[int, Noted]:
    """The stored splats of each kind, by the id of one of its instances, which the plan keeps."""
    return tile.shared.kept("noted", lambda: _found(tile))


def _found(tile: TileContext) -> dict[int, Noted]:
    found, first = {}, 0
    for placed in tile.plan.find(nearest_kinds):
        count = int(tile.stored(placed).places.max(initial=-1)) + 1
        found[id(placed)] = Noted(placed, first, count)
        first += count
    return found


def first_noted(tile: TileContext, placed: DrawItem) -> float:
    """The number of the first stored splat of an object; -1 if visibility does not note its splats."""
    if not placed.items.show_nearest:
        return -1.0
    table = placed.items.table
    return float(noted(tile)[id(table.every_kind[table.kind_of[placed.row]])].first)
