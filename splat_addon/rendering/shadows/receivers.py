# SPDX-License-Identifier: GPL-3.0-or-later
"""What a picture looks up in shadow maps: the part of a map that its receivers need, and how finely they need it.

In float64, from the boxes of objects, before anything is drawn. A map is therefore the same for all tiles, samples and
parts of a picture.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ..depth_range import Seen, seen_by, visible_space
from ..scene import PolygonInstance
from ..scene.boxes import corners_times
from ..scene.camera import Camera
from ..scene.far_reaching import box_corners, seen_places, seen_places_in
from ..scene.from_eye import FromEye
from ..scene.light import MAX_SUN_HALF_ANGLE, Light
from ..scene.table import InstanceTable
from .hexahedra import places_in_pyramid
from .strays import among_others, near_things

#: A map has at least this many texels along the smallest pixel that looks it up, or as many as the settings allow.
#: Where its size changes, shadows move by parts of a texel, an eighth of a pixel, which cannot be seen.
TEXELS_PER_PIXEL = 8

#: The part of a map that is drawn ends at multiples of this share of it, so that it stays while a camera moves.
_STEP = 1 / 16

#: Texels that filters read on each side of a lookup (shaders/lib/shadow_taps).
FILTER_REACH = 4

#: The search for blockers begins at this share of the distance from a lamp; so it reaches, in half-axes of the lamp,
#: 1 / NEAREST_SHARE - 1 beside the lit position.
NEAREST_SHARE = 0.25

#: Half-axes of the ellipse that stands for a rectangle (shaders/features/shadows.glsl), over those of the rectangle.
_ROUND = 1.13

#: A position may be this many pixels beside the box of its object, because filters widen splats.
_BESIDE = 3


#: So many triangles are cut at the view volume in a millisecond.
QUICK = 4096


class Viewers(NamedTuple):
    """The cameras whose pictures look up the same shadow maps.

    sun: the camera that the maps of suns are fitted to. lamps: all those that the maps of lamps must suffice for, so
    that they are the same for all faces of a panorama and all points of a lens.
    """

    sun: Camera
    lamps: tuple[Camera, ...]


def viewers(camera: Camera, moved: Camera) -> Viewers:
    """The viewers of one sample of a camera's picture.

    moved: the camera of that sample. The maps of suns are fitted to it only if a lens moves the eye; otherwise all
    samples share those of `camera`, which looks through the pixels' centres.
    """
    return Viewers(moved if camera.lens else camera, (camera,))


@dataclass(frozen=True, eq=False)
class Receivers:
    """What a camera sees that light may fall on.

    corners: (n, 8, 3) world corners of boxes around objects. space: (8, 3) corners of the visible part of space.
    light_sets: (n,) of the objects. pixels: (n,) the least length of a pixel on each. beside: (n,) how far from its box
    its positions may be. outside: how far from the visible part of space positions may be. All in world units.
    """

    corners: np.ndarray
    space: np.ndarray
    light_sets: np.ndarray
    pixels: np.ndarray
    beside: np.ndarray
    outside: float

    def of(self, light: Light) -> Receivers | None:
        """Those that a light lights; None if it lights none of them."""
        if light.receivers is None:
            return self
        lit = np.isin(self.light_sets, light.receivers)
        own = (getattr(self, name)[lit] for name in ("light_sets", "pixels", "beside"))
        return Receivers(self.corners[lit], self.space, *own, self.outside) if lit.any() else None


class LookedUp(NamedTuple):
    """low, high: (2,) of the part of a map's window that is looked up. side: texels along the whole window that this
    needs."""

    low: np.ndarray
    high: np.ndarray
    side: float


def receivers(table: InstanceTable, camera: Camera, lights_splats: bool) -> Receivers | None:
    """What a camera may see of instances, through any point of its lens; None for nothing.

    lights_splats: whether splats are lit at their centres, which may lie outside the picture.
    """
    pixel, camera = 1.0 / camera.pixels_per_unit(), _through_lens(camera)
    seen, corners = _seen_near(table, camera)
    if not len(seen.table):
        return None
    near, far, space = visible_space(camera, seen)
    nearest, farthest = (np.clip(pick(seen.depths, axis=1), near, far) for pick in (np.min, np.max))
    if camera.is_orthographic:
        nearest = farthest = np.ones(len(seen.table))
    beside = _BESIDE * pixel * farthest
    return Receivers(
        corners=corners,
        space=space,
        light_sets=seen.table.light_sets,
        pixels=pixel * nearest,
        beside=beside,
        outside=float(beside.max()) + float(seen.table.radii.max()) * lights_splats,
    )


def _seen_near(table: InstanceTable, camera: Camera) -> tuple[Seen, np.ndarray]:
    """What `seen_by` finds, without strays, and (n, 8, 3) world corners of boxes around it; of far-reaching triangles
    only what is near the other things, on which their shadows may fall."""
    seen = seen_by(table, camera)
    is_other = np.ones(len(seen.table), bool)
    is_other[seen.table.reaching] = False
    others = np.flatnonzero(is_other)
    depths = _least_and_greatest(seen, others, camera)
    is_kept = is_other.copy()
    is_kept[others] = among_others(seen.table.triangles[others], *depths)
    if is_kept.all():
        return seen, seen.table.world_corners
    boxes, in_world = seen.from_eye.corners.copy("K"), seen.table.world_corners
    around = near_things(table, camera) if len(seen.table.reaching) else None
    for row in seen.table.reaching.tolist():
        places, world = seen_places_in(seen.table.placed[row], camera, around)
        is_kept[row] = len(places) > 0
        if len(places):
            boxes[row], in_world[row] = box_corners(places), box_corners(world)
    rows = np.flatnonzero(is_kept)
    table = seen.table.taken(rows)
    return seen._replace(table=table, from_eye=FromEye(table, camera, boxes[rows])), in_world[rows]


def _least_and_greatest(seen: Seen, rows: np.ndarray, camera: Camera) -> tuple[np.ndarray, np.ndarray]:
    """(k,) least and (k,) greatest depths of what is seen of some instances: of their boxes, or if the camera may be in
    one, and looking closer is quick, of its triangles in the view volume. Of what is not seen at all, both are the
    greatest."""
    least, greatest = seen.depths[rows].min(axis=1), seen.depths[rows].max(axis=1)
    table = seen.table
    are_polygons = table.of_kinds(lambda placed: isinstance(placed, PolygonInstance))[rows]
    for k in np.flatnonzero(are_polygons & (least < camera.near) & (table.triangles[rows] <= QUICK)).tolist():
        places = seen_places(table.placed[rows[k]], camera)
        least[k], greatest[k] = (-places[:, 2].max(), -places[:, 2].min()) if len(places) else (greatest[k],) * 2
    return least, greatest


def looked_up(light_camera: Camera, seen: Receivers, spread: float) -> LookedUp | None:
    """What a picture looks up in the map of a light; None for nothing.

    spread: how far from a position the lookups of a light with a size may be, world units.
    """
    low, high, depth, is_inside = _bounds(light_camera, seen.corners, seen.beside + spread)
    least, most, deepest, is_visible = _bounds(light_camera, seen.space[None], np.array([seen.outside + spread]))
    low, high = np.maximum(low, least), np.minimum(high, most)
    is_inside &= is_visible & (low < high).all(axis=1)
    if not is_inside.any():
        return None
    left, right, _, _ = light_camera.window
    pixel = seen.pixels / np.minimum(depth, deepest)
    side = TEXELS_PER_PIXEL * (right - left) / pixel[is_inside].min()
    return LookedUp(low[is_inside].min(axis=0), high[is_inside].max(axis=0), float(side) + 2 * FILTER_REACH)


def are_larger_than_pixels(side: int, needed: float) -> bool:
    """Whether the texels of a map with this side are larger than the smallest pixel that looks them up. needed: of
    `LookedUp`."""
    return side * TEXELS_PER_PIXEL < needed


def together(some: list[LookedUp | None]) -> LookedUp | None:
    """What several pictures look up."""
    some = [one for one in some if one is not None]
    if not some:
        return None
    low, high, sides = zip(*some, strict=True)
    return LookedUp(np.min(low, axis=0), np.max(high, axis=0), max(sides))


def used_texels(camera: Camera, looks: LookedUp) -> tuple[int, int, int, int]:
    """x, y, width and height of the texels of a map that lookups read, filters included, and few more."""
    left, right, bottom, top = camera.window
    start, size = np.array((left, bottom)), np.array(camera.size)
    density = size / (right - left, top - bottom)
    step = np.maximum(size * _STEP, 1)
    first = np.floor(((looks.low - start) * density - FILTER_REACH) / step) * step
    last = np.ceil(((looks.high - start) * density + FILTER_REACH) / step) * step
    first, last = np.clip(first.astype(int), 0, size), np.clip(np.ceil(last).astype(int), 0, size)
    return (*first.tolist(), *(last - first).tolist())


def _bounds(camera: Camera, corners: np.ndarray, reach: np.ndarray):
    """Where (n, 8, 3) world corners of boxes, and what is at most (n,) reach away from them, appear in a light's
    window: (n, 2) low, (n, 2) high, (n,) greatest depths (1 for a parallel camera), and (n,) whether they do."""
    view = corners_times(corners - camera.matrix_world[:3, 3], camera.matrix_world[:3, :3])
    left, right, bottom, top = camera.window
    low, high, reach = np.array((left, bottom)), np.array((right, top)), reach[:, None]
    if camera.is_orthographic:
        first, last = view[..., :2].min(axis=1) - reach, view[..., :2].max(axis=1) + reach
        is_inside = ((first < high) & (last > low)).all(axis=1)
        return np.maximum(first, low), np.minimum(last, high), np.ones(len(view)), is_inside
    places, count = places_in_pyramid(view, right, reach[:, 0])
    depth = -places[..., 2]
    nearest = np.where(count, depth, np.inf).min(axis=1)[:, None]
    farthest = np.where(count, depth, -np.inf).max(axis=1) + reach[:, 0]
    is_before, is_inside = nearest > 2 * reach, count.any(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        seen = places[..., :2] / depth[..., None]
        wider = reach * (1 + right) / (nearest - reach)
        first = np.where(count[..., None], seen, np.inf).min(axis=1) - wider
        last = np.where(count[..., None], seen, -np.inf).max(axis=1) + wider
    first, last = (np.where(is_before, edge, end) for edge, end in ((first, low), (last, high)))
    return np.maximum(first, low), np.minimum(last, high), farthest, is_inside


def _through_lens(camera: Camera) -> Camera:
    """A pinhole camera that sees everything that a camera sees through any point of its lens."""
    if camera.lens is None:
        return camera
    lens, (left, right, bottom, top) = camera.lens, camera.window
    turned = max(abs(1 / camera.near - 1 / lens.focus_distance), 1 / lens.focus_distance)
    wider = lens.radius * max(1.0, 1 / lens.ratio) * turned
    window = (left - wider, right + wider, bottom - wider, top + wider)
    return replace(camera, window=window, lens=None)


def spread_of(light: Light, camera: Camera) -> float:
    """How far from a position the taps of a light with a size may be, world units (shaders/lib/shadow.glsl)."""
    if light.kind == "sun":
        left, right, _, _ = camera.window
        return min(_tangent(light) * camera.far, (right - left) / 4)
    half = math.hypot(*np.ravel(light.half_axes)) if light.kind == "area" else light.size
    return (1 / NEAREST_SHARE - 1) * _ROUND * half


def _tangent(light: Light) -> float:
    return math.tan(min(light.size / 2, MAX_SUN_HALF_ANGLE))
