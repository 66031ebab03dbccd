# SPDX-License-Identifier: GPL-3.0-or-later
"""What a frame tells about how it was drawn."""

from __future__ import annotations

from .detail.streamed import Streamed
from .device import Device
from .features.back_culling import backs
from .plan.frame_plan import FramePlan
from .plan.tile import TileContext
from .plan.together import coarse


def new_stats(device: Device, frame_plan: FramePlan, streamed: Streamed) -> dict:
    """The statistics of a frame before anything is drawn."""
    culled, culled_of = frame_plan.find(backs)
    return {
        "backend": device.backend,
        "device": device.renderer,
        "plan": frame_plan,
        "splats": 0,
        "splats_drawn": 0,
        "polygons": 0,
        "instances": 0,
        "instances_outside": 0,
        "instances_degenerate": 0,
        "instances_hidden": 0,
        "surfels_coarse": 0,
        "short_of_memory": streamed.short,
        "unread": streamed.unread,
        "layers": 0,
        "culled": culled,
        "culled_of": culled_of,
        "passes": {},
        "texture_bytes": 0,
    }


def counted(tile: TileContext) -> dict[str, int]:
    """The statistics of a tile that was drawn."""
    view, are_hidden = tile.view, tile.hidden[tile.view.placed.table.numbers]
    return {
        "splats": int(view.placed.table.counts.sum()),
        "polygons": int(view.polygons.table.triangles.sum()),
        "instances": len(view.placed) + len(view.polygons),
        "instances_outside": view.outside,
        "instances_hidden": int(are_hidden.sum()),
        "splats_drawn": int(tile.drawn_counts(view.placed)[~are_hidden].sum()),
        "surfels_coarse": coarse(tile, view.placed),
    }
