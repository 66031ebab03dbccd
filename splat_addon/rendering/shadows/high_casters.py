# SPDX-License-Identifier: GPL-3.0-or-later
"""Casters so far above what is seen that a sun's map is too short for them: they are brought down into it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..scene import Placed, PolygonInstance
from ..scene.camera import Camera
from ..scene.far_reaching import pressed_above
from ..scene.numbers import MAX_LENGTH
from ..scene.table import InstanceTable, with_others
from .casters import sees
from .receivers import QUICK

#: How far a sun's map reaches, in halves of its side: its depths are then exact to a quarter of a texel. Polygons above
#: are brought down, and fewer surfels than this.
DEEPEST, _FEW_SURFELS = 4096, 1024
#: How much of those depths what is brought down gets; casters below begin at 0.005.
_PRESSED = 0.002


def brought_down(casters: InstanceTable, camera: Camera) -> InstanceTable:
    """The casters of a sun: those that are above its map are moved along the light, and pressed flat, into the first
    part of its depths. Their shadows stay the same. Of those that reach into it, too, the upper part is there a second
    time."""
    corners = casters.world_corners
    depths = (camera.matrix_world[:3, 3] - corners) @ camera.matrix_world[:3, 2]
    is_above, begins_above = depths.max(axis=1) < camera.near, depths.min(axis=1) < camera.near
    if begins_above.any():
        # what is beside the map is not seen
        is_over = sees(replace(camera, near=-MAX_LENGTH, far=MAX_LENGTH), corners)
        is_above, begins_above = is_above & is_over, begins_above & is_over
    if not begins_above.any():
        return casters
    is_moved = is_above & casters.of_kinds(comes_down)
    rows = np.flatnonzero(is_moved).tolist()
    made = [_pressed(casters.placed[k], camera, depths[k]) for k in rows]
    partly = np.flatnonzero(begins_above & ~is_above & casters.of_kinds(_can_be_pressed)).tolist()
    if upper := pressed_above([casters.placed[k] for k in partly], camera, _PRESSED * camera.far):
        made.append(PolygonInstance(upper, camera.matrix_world))
        rows.append(partly[0])
    return with_others(casters, np.array(rows, int), made, ~is_moved)


def _pressed(caster: Placed, camera: Camera, depths: np.ndarray) -> Placed:
    """A caster whose box has these depths, moved to those that a map has for it."""
    low, high = depths.min(), depths.max()
    share = min(1.0, _PRESSED * camera.far / max(high - low, 1e-300))
    along, press = camera.matrix_world[:3, 2], np.eye(4)
    press[:3, :3] += (share - 1) * np.outer(along, along)
    # a depth d becomes share (_PRESSED far + d - low)
    eye = along @ camera.matrix_world[:3, 3]
    press[:3, 3] = along * (eye * (1 - share) - share * (_PRESSED * camera.far - low))
    return replace(caster, matrix_world=press @ caster.matrix_world)


def _can_be_pressed(caster: Placed) -> bool:
    """Whether what is above a map may be cut off, because it has few triangles, and no holes."""
    return isinstance(caster, PolygonInstance) and not caster.is_cut_out and caster.polygons.triangles <= QUICK


def comes_down(caster: Placed) -> bool:
    """Whether a map may have another instance in its place: of many surfels, the device has levels of detail."""
    return isinstance(caster, PolygonInstance) or len(caster.shape) < _FEW_SURFELS
