# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether all that a picture needs is on the device, where large sets come in slices."""

from __future__ import annotations

from types import SimpleNamespace
from typing import TYPE_CHECKING

from ..features import ARRIVES, DRAWN
from ..scene import Instance
from ..upload.loading import NotYet
from .together import kinds_in_pool

if TYPE_CHECKING:
    from .tile import TileContext

#: What stands for items of which each has textures of its own.
_WHOLE = SimpleNamespace(places=None, step=None)


def check_arrived(tile: TileContext) -> None:
    """Request everything of the scene's surfels that passes read; raises `NotYet` for what is on its way."""
    read, late = {name for p in tile.plan.passes for name in p.all("inputs")}, set()
    kinds = (kind.placed for kind in tile.scene.table.kinds)
    pooled = set(map(id, tile.shared.kept(("pooled", Instance), lambda: kinds_in_pool(tile, Instance))))
    for instance in (placed for placed in kinds if isinstance(placed, Instance) and id(placed) not in pooled):
        if instance.is_cut:
            # the next view has another, so that it would never be there
            tile.resources.loading.exempt.add(instance.surfels)
            continue
        wanted = [name for name, is_needed in ARRIVES.items() if name in read and is_needed(instance)]
        for name in wanted:
            try:
                DRAWN[name](tile, SimpleNamespace(instance=instance, part=0, items=_WHOLE))
            except NotYet as reason:
                # the rest is made when it is known whether the surfels have levels
                late |= reason.surfels
                break
    if late:
        raise NotYet(late)
