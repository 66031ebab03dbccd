# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether all that a picture needs is on the device, where large sets come in slices."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from ..features import ARRIVES, DRAWN
from ..scene import Instance
from ..upload.loading import NotYet
from ..view import DrawItem, Items
from .together import kinds_in_pool

if TYPE_CHECKING:
    from .tile import TileContext


def check_arrived(tile: TileContext) -> None:
    """Request everything of the scene's surfels that passes read; raises `NotYet` for what is on its way."""
    read, late = {name for p in tile.plan.passes for name in p.all("inputs")}, set()
    pooled = set(map(id, tile.shared.kept(("pooled", Instance), lambda: kinds_in_pool(tile, Instance))))
    for item in _one_of_each_kind(tile):
        instance = item.instance
        if not isinstance(instance, Instance) or id(instance) in pooled:
            continue
        if instance.is_cut:
            # the next view has another, so that it would never be there
            tile.resources.loading.exempt.add(instance.surfels)
            continue
        wanted = [name for name, is_needed in ARRIVES.items() if name in read and is_needed(instance)]
        for name in wanted:
            try:
                DRAWN[name](tile, item)
            except NotYet as reason:
                # the rest is made when it is known whether the surfels have levels
                late |= reason.surfels
                break
    if late:
        raise NotYet(late)


def _one_of_each_kind(tile: TileContext) -> Iterator[DrawItem]:
    """An instance of each kind of the scene as it is drawn by itself, whole."""
    every = tile.scene.table
    own = every.taken(every.first_of_kinds)
    none = np.zeros(len(own))
    return iter(Items(own, own.from_eye(tile.camera), 1.0, none.astype(bool), none, none))
