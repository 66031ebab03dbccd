# SPDX-License-Identifier: GPL-3.0-or-later
"""The depths of what cuts holes, alone: the visibility pass's where a hole is seen, to the last digit."""

from __future__ import annotations

from dataclasses import replace

from ..device.interface import Target
from ..frame_plan import PlannedPass
from . import visibility
from .tile import TileContext


def run(tile: TileContext, planned: PlannedPass) -> Target:
    """Fill the depth texture."""
    kinds = {name: getattr(tile.view, name) for name in ("placed", "polygons")}
    cutting = {name: tuple(p for p in placed if p.instance.is_holdout) for name, placed in kinds.items()}
    return visibility.run(replace(tile, view=replace(tile.view, **cutting)), planned)
