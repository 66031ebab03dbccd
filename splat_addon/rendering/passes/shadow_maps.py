# SPDX-License-Identifier: GPL-3.0-or-later
"""The shadow pass: what each light sees first, one map beside the other in an atlas (Botsch et al. 2005, section 5)."""

from __future__ import annotations

from dataclasses import replace

from ..device.interface import Target
from ..frame_plan import PlannedPass
from ..view import View
from . import visibility
from .tile import TileContext


def run(tile: TileContext, planned: PlannedPass) -> Target:
    """Fill the atlas, a visibility pass a map. Parallel cameras store the hardware's depth, others depth / far."""
    target = tile.target((), planned.writes[0])
    target.clear(depth=1.0)
    for made, view in zip(tile.plan.shadow_maps, tile.shadow_views, strict=True):
        linear_depth = not made.camera.is_orthographic
        seen = replace(tile.plan, linear_depth=linear_depth, samples=1, multisamples=0, sample_shading=False)
        view = _whole(view)
        from_light = TileContext(tile.resources, seen, tile.scene, made.camera, tile.settings, view)
        visibility.draw_visible(from_light, planned, target, view.placed, (*made.place, *made.camera.size))
    return target


def _whole(view: View) -> View:
    """With what is split by its distance from the picture's camera, not from this one, drawn whole."""
    kinds = {name: tuple(replace(p, split=0.0) for p in getattr(view, name)) for name in ("placed", "polygons")}
    return replace(view, **kinds)
