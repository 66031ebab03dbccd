# SPDX-License-Identifier: GPL-3.0-or-later
"""The shadow pass: what each light sees first, one map beside the other in an atlas (Botsch et al. 2005, section 5)."""

from __future__ import annotations

from dataclasses import replace

from ..camera import Camera
from ..device.interface import Target
from ..frame_plan import PlannedPass
from ..view import View
from . import visibility
from .tile import TileContext

#: Of polygons, in texels of a map: a filter reaches two, over which planes may differ by that much at 45 degrees.
SETBACK = 2.0


def run(tile: TileContext, planned: PlannedPass) -> Target:
    """Fill the atlas, a visibility pass a map. Parallel cameras store the hardware's depth, others depth / far."""
    target = tile.target((), planned.writes[0])
    target.clear(depth=1.0)
    for made, view in zip(tile.plan.shadow_maps, tile.shadow_views, strict=True):
        linear_depth = not made.camera.is_orthographic
        seen = replace(tile.plan, linear_depth=linear_depth, samples=1, multisamples=0, sample_shading=False)
        view = _as_cast(view, made.camera)
        from_light = TileContext(tile.resources, seen, tile.scene, made.camera, tile.settings, view)
        visibility.draw_visible(from_light, planned, target, view.placed, (*made.place, *made.camera.size))
    return target


def _as_cast(view: View, camera: Camera) -> View:
    """What casts shadows into a map: what is split by its distance from another camera is whole, and polygons lie some
    texels farther, so that they do not shadow themselves where their shading normals are not their own.
    """
    left, right, _, _ = camera.window
    texel = (right - left) / camera.size[0] * (view.scale if camera.is_orthographic else 1.0)
    polygons = tuple(replace(p, split=0.0, setback=SETBACK * texel) for p in view.polygons)
    return replace(view, placed=tuple(replace(p, split=0.0) for p in view.placed), polygons=polygons)
