# SPDX-License-Identifier: GPL-3.0-or-later
"""Shadow maps: the cameras from which lights see shadow casters, and the data with which shaders look up the maps.

Sources: Williams 1978, "Casting Curved Shadows on Curved Surfaces"; Botsch et al. 2005, section 6 (splats
seen by a light are a visibility pass from there).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ..depth_range import are_outside
from ..scene import Placed, PolygonInstance, Scene
from ..scene.camera import Camera, look_at
from ..scene.far_reaching import highest_over, pressed_above
from ..scene.light import MAX_SUN_HALF_ANGLE, Light
from ..scene.numbers import MAX_LENGTH
from ..scene.table import InstanceTable, corners_times, with_others
from ..view import View
from .casters import in_the_way
from .receivers import (
    FILTER_REACH,
    QUICK,
    Receivers,
    Viewers,
    are_larger_than_pixels,
    looked_up,
    receivers,
    spread_of,
    together,
    used_texels,
)

#: Maximum number of maps in the atlas; the last lights cast no shadow if there are more.
MAX_MAPS = 64

#: A face of an omnidirectional light has a margin for filters.
FACE_WINDOW = 1.05
#: Wider spots use cube faces like a point light.
MAX_SPOT_WINDOW = 2.5
#: Smaller maps than this are not cheaper.
LEAST_SIDE = 32
#: The map of a sun covers all that is visible, so where its texels would be larger than pixels, it has up to this many
#: times as many along its side; of several suns, fewer. No map grows beyond the larger of this side and the settings'.
FINER_SUN, LARGEST_SIDE = 4, 4096
#: How far a sun's map reaches, in halves of its side: its depths are then exact to a quarter of a texel. Polygons above
#: are brought down, and fewer surfels than this.
DEEPEST, _FEW_SURFELS = 4096, 1024
#: How much of those depths what is brought down gets; casters below begin at 0.005.
_PRESSED = 0.002
#: The nearest distance of a caster, as a share of the farthest one's; closer casters cast no shadow.
NEAREST = 1e-4
#: Where something so far away would leave out whole casters, the nearest distance as a share of the nearest one's.
_JUST_BEFORE = 0.1


@dataclass(frozen=True, eq=False)
class ShadowMap:
    """light: number in the scene. camera: the light's view. place: (x, y) of the map in the atlas, in texels.

    is_face: whether it is one face of a cube around a light, and continues in the adjacent faces.
    is_smaller: whether it has fewer texels than the settings say, because these are far smaller than pixels.
    used: x, y, width and height of the part that is drawn, which holds all that the picture looks up.
    casters: the instances that may block the light on its way to what is seen. around: all instances that cast shadows.
    """

    light: int
    camera: Camera
    place: tuple[int, int]
    is_face: bool
    is_smaller: bool
    used: tuple[int, int, int, int]
    casters: InstanceTable
    around: InstanceTable

    @property
    def drawn(self) -> Camera:
        """The light's view of the part that is drawn."""
        return self.camera if self.used == (0, 0, *self.camera.size) else self.camera.cropped(*self.used)

    @property
    def viewport(self) -> tuple[int, int, int, int]:
        """That part in the atlas."""
        return self.place[0] + self.used[0], self.place[1] + self.used[1], *self.used[2:]


def shadow_maps(
    scene: Scene, viewers: Viewers, resolution: int, lights_splats: bool = False
) -> tuple[tuple[ShadowMap, ...], int]:
    """The maps that a picture needs, and the number of lights left without. lights_splats: as in `receivers`.

    resolution: texels along a map's side; fewer where the picture's pixels are so large that these suffice, and more
    for suns (`FINER_SUN`).

    How many lights there is room for does not depend on the camera, so that none loses its shadow while it moves.
    """
    if not any(light.casts_shadow for light in scene.lights):
        return (), 0
    casters = scene.table.casting
    if not len(casters):
        return (), 0
    corners = casters.world_corners
    suns = sum(light.casts_shadow and light.kind == "sun" for light in scene.lights)
    lamps = sum(light.casts_shadow and light.kind != "sun" for light in scene.lights)
    for_sun = receivers(scene.table.seen, replace(viewers.sun, lens=None), lights_splats) if suns else None
    for_lamps = [receivers(scene.table.seen, camera, lights_splats) for camera in viewers.lamps] if lamps else []
    finest = max(min(resolution * (FINER_SUN // atlas_columns(suns)), LARGEST_SIDE), resolution)
    made, without, count = [], 0, 0
    for number, light in enumerate(scene.lights):
        if light.casts_shadow:
            whole = _CAMERAS[light.kind](light, casters, for_sun, resolution)
            own = [c for c in whole if c.is_orthographic or sees(c, corners).any()]
            if count + len(own) > MAX_MAPS:
                without += 1
                continue
            count += len(own)
            seen = [one and one.of(light) for one in ([for_sun] if light.kind == "sun" else for_lamps)]
            most = finest if light.kind == "sun" else resolution
            made += _needed(number, light, own, most, [one for one in seen if one], casters, len(whole) > 1)
    return _placed(made), without


def _needed(
    number, light, cameras: list[Camera], most: int, seen: list[Receivers], casters: InstanceTable, are_faces
) -> list[ShadowMap]:
    """The maps of a light that a picture looks up, with as many texels as it needs. most: texels along a side. seen: by
    each camera of the picture."""
    looks = [together([looked_up(c, one, spread_of(light, c)) for one in seen]) for c in cameras]
    if not any(looks):
        return []
    # the next face of a cube has the same texels
    resolution, needed = cameras[0].size[0], max(one.side for one in looks if one)
    side = enough(needed, resolution)
    while 2 * side <= most and are_larger_than_pixels(side, needed):
        side *= 2
    found = []
    cameras = [resized(camera, side) for camera in cameras]
    if light.kind == "sun":
        casters = brought_down(casters, cameras[0])
    for camera in cameras:
        spread = spread_of(light, camera)
        if one := together([looked_up(camera, one, spread) for one in seen]):
            corners = casters.world_corners
            block = sees(camera, corners) & in_the_way(light, texel_of(camera), seen, spread, corners)
            if block.any():
                found.append(
                    ShadowMap(
                        number,
                        camera,
                        place=(0, 0),
                        is_face=are_faces,
                        is_smaller=side < resolution,
                        used=used_texels(camera, one),
                        casters=casters.taken(block),
                        around=casters,
                    )
                )
    return found


def enough(needed: float, resolution: int) -> int:
    """Texels along a map's side: the resolution or three quarters of it, halved as often as leaves the needed number.

    A size is kept until a third more or fewer texels are needed, so an animation changes it rarely. Sizes remain
    multiples of 4, the side of the masks of transparent surfaces, if the resolution is one of 16.
    """
    side = resolution
    while side % 2 == 0 and side // 2 >= max(needed, LEAST_SIDE):
        side //= 2
    less = side // 4 * 3
    return less if side % 16 == 0 and less >= max(needed, LEAST_SIDE) else side


def resized(camera: Camera, side: int) -> Camera:
    """A light's view with other texels; if there are fewer, with so much more around its window as filters read."""
    if side >= camera.size[0]:
        return replace(camera, size=(side, side))
    wider = side / (side - 2 * FILTER_REACH)
    return replace(camera, window=tuple(edge * wider for edge in camera.window), size=(side, side))


def _placed(maps: list[ShadowMap]) -> tuple[ShadowMap, ...]:
    """The maps at their places in the atlas: in rows, the largest first."""
    sides = [made.camera.size[0] for made in maps]
    order = sorted(range(len(maps)), key=lambda k: -sides[k])
    least, most = min(sides, default=1), max(sides, default=0)
    across = max(atlas_columns(sum(side * side for side in sides) / least**2) * least, most)
    places, x, y, height = {}, 0, 0, 0
    for k in order:
        side = maps[k].camera.size[0]
        if x + side > across:
            x, y, height = 0, y + height, 0
        places[k] = x, y
        x, height = x + side, max(height, side)
    return tuple(replace(made, place=places[k]) for k, made in enumerate(maps))


def sees(camera: Camera, corners: np.ndarray) -> np.ndarray:
    """(n,) whether the boxes with these (n, 8, 3) world corners may be in the camera's picture."""
    return ~are_outside(corners_times(corners - camera.matrix_world[:3, 3], camera.matrix_world[:3, :3]), camera)


def atlas_columns(maps: float) -> int:
    """Maps of one size side by side in the atlas."""
    return max(math.ceil(math.sqrt(maps)), 1)


def atlas_size(maps: tuple[ShadowMap, ...]) -> tuple[int, int]:
    """Width and height in texels."""
    return tuple(max(m.place[k] + m.camera.size[k] for m in maps) for k in (0, 1))


def texel_of(camera: Camera) -> float:
    """The length of a map's texel, world units; of a lamp's at distance 1."""
    left, right, _, _ = camera.window
    return (right - left) / camera.size[0]


def pack_shadow_maps(maps, views: tuple[View, ...], camera: Camera, scale: float) -> np.ndarray:
    """(M, 18, 4) float32. views: of `view.build_view`, one for each map. camera, scale: of the picture that is shaded.

    Rows of the map from its view space to the light's (3 texels) | window's left, bottom, 1 / width, 1 / height |
    place in the atlas, resolution, 1 for a parallel camera | depth = x stored + y, texel's size (at depth 1 of a
    perspective), 1 for a face of a cube | of such a one the faces to the left, right, below and above, each as rows
    from its view to theirs, with place in the atlas and the factor of depths (3 texels; a factor of 0 for none).
    """
    texels = np.zeros((len(maps), 18, 4))
    for row, made, view in zip(texels, maps, views, strict=True):
        light, rotation = made.camera, made.camera.matrix_world[:3, :3].T
        row[:3, :3] = rotation @ camera.matrix_world[:3, :3] * (view.scale / scale)
        row[:3, 3] = rotation @ (camera.matrix_world[:3, 3] - light.matrix_world[:3, 3]) * view.scale
        left, right, bottom, top = (v * (view.scale if light.is_orthographic else 1.0) for v in light.window)
        row[3] = left, bottom, 1 / (right - left), 1 / (top - bottom)
        row[4] = *made.place, light.size[0], light.is_orthographic
        near, far = (view.first, view.far) if light.is_orthographic else (0.0, view.far)
        row[5] = far - near, near, max(right - left, top - bottom) / light.size[0], made.is_face
        if made.is_face:
            row[6:] = _beside(made, maps, [v.far * view.scale / v.scale for v in views])
    return texels.astype(np.float32)


def _beside(made: ShadowMap, maps, depths) -> np.ndarray:
    """(12, 4) of a cube's face: see `pack_shadow_maps`. depths: the factor of each map, in the scale of this one."""
    texels = np.zeros((4, 3, 4))
    own = made.camera.matrix_world[:3, :3]
    for other, depth in zip(maps, depths, strict=True):
        turn = other.camera.matrix_world[:3, :3].T @ own
        sides = turn[2] @ np.array([(1, -1, 0, 0), (0, 0, 1, -1), (0, 0, 0, 0)])
        if other.light == made.light and sides.max() > 0.5:
            texels[sides.argmax(), :, :3] = turn
            texels[sides.argmax(), :, 3] = *other.place, depth
    return texels.reshape(12, 4)


def map_ranges(maps: tuple[ShadowMap, ...], lights: int) -> np.ndarray:
    """(lights, 2) the first map of each light, and the number of its maps."""
    owners = np.array([m.light for m in maps], int)
    counts = np.bincount(owners, minlength=lights)
    return np.stack([np.concatenate([[0], np.cumsum(counts)[:-1]]), counts], axis=1)


# Each gives the cameras of a light. seen: by the camera, if anything.


def _sun(light: Light, casters: InstanceTable, seen: Receivers | None, resolution: int) -> list[Camera]:
    """One parallel camera for a sun. It covers what is both in the picture and in the scene, plus casters beside it
    that soften its shadows, up to as much again. It extends back to the farthest caster above that and no farther,
    because depths are stored as 24-bit fractions of its length."""
    frame = look_at((0, 0, 0), light.direction)
    to_light = frame[:3, :3].T
    if seen is None:
        return []
    lit, visible = (places @ to_light.T for places in (seen.corners.reshape(-1, 3), seen.space))
    lowest = np.maximum(lit.min(axis=0), visible.min(axis=0))
    low, high = lowest[:2], np.minimum(lit.max(axis=0), visible.max(axis=0))[:2]
    if not (low < high).all():
        return []
    margin = 0.02 * (high - low).max()
    middle, half = (low + high) / 2, max((high - low).max() / 2 + margin, 1e-30)
    nearest = _nearest_over(casters, to_light, middle, half)
    if light.is_sized and nearest is not None:
        softens = math.tan(min(light.size / 2, MAX_SUN_HALF_ANGLE)) * max(nearest - lowest[2], 0.0)
        half += min(softens, half)
        nearest = _nearest_over(casters, to_light, middle, half)
    if nearest is None:
        return []
    if nearest - lowest[2] > DEEPEST * half:
        top = _nearest_over(casters.taken(~casters.of_kinds(_comes_down)), to_light, middle, half)
        nearest = max(lowest[2] + DEEPEST * half, lowest[2] if top is None else top)
    reach = max(nearest - lowest[2], half) * 1.01
    frame[:3, 3] = frame[:3, :3] @ (*middle, nearest + 0.005 * reach)
    return [Camera(frame, (-half, half, -half, half), (resolution, resolution), 0.0, reach, is_orthographic=True)]


def brought_down(casters: InstanceTable, camera: Camera) -> InstanceTable:
    """The casters of a sun: those that are above its map are moved along the light, and pressed flat, into the first
    part of its depths. Their shadows stay the same. Of those that reach into it, too, the upper part is there a second
    time."""
    depths = (camera.matrix_world[:3, 3] - casters.world_corners) @ camera.matrix_world[:3, 2]
    is_above, begins_above = depths.max(axis=1) < camera.near, depths.min(axis=1) < camera.near
    if begins_above.any():
        # what is beside the map is not seen
        is_over = sees(replace(camera, near=-MAX_LENGTH, far=MAX_LENGTH), casters.world_corners)
        is_above, begins_above = is_above & is_over, begins_above & is_over
    if not begins_above.any():
        return casters
    is_moved = is_above & casters.of_kinds(_comes_down)
    made = [_pressed(casters.placed[k], camera, depths[k]) for k in np.flatnonzero(is_moved).tolist()]
    rows = [*np.flatnonzero(is_moved).tolist()]
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


def _comes_down(caster: Placed) -> bool:
    """Whether a map may have another instance in its place: of many surfels, the device has levels of detail."""
    return isinstance(caster, PolygonInstance) or len(caster.shape) < _FEW_SURFELS


def _nearest_over(casters: InstanceTable, frame: np.ndarray, middle: np.ndarray, half: float) -> float | None:
    """The highest place of casters over a square, in a frame of the light, whose axes are the rows; None if there is
    none."""
    boxes = corners_times(casters.world_corners, frame.T)
    least, most = boxes.min(axis=1)[:, :2], boxes.max(axis=1)[:, :2]
    is_over = ((least <= middle + half) & (most >= middle - half)).all(axis=1)
    reaching = casters.reaching[is_over[casters.reaching]]
    is_over[reaching] = False
    tops = [boxes[is_over, :, 2].max(initial=-np.inf)]
    tops += [highest_over(casters.placed[k], frame, middle, half) for k in reaching.tolist()]
    return max(tops) if max(tops) > -np.inf else None


def _spot(light: Light, casters: InstanceTable, seen, resolution: int) -> list[Camera]:
    half = math.tan(min(light.spot_angle / 2, 1.5)) * FACE_WINDOW
    if half > MAX_SPOT_WINDOW:
        return _faces(light, casters, resolution, np.eye(3))
    return _perspectives(light, casters, resolution, [look_at((0, 0, 0), light.direction)], half)


def _point(light: Light, casters: InstanceTable, seen, resolution: int) -> list[Camera]:
    return _faces(light, casters, resolution, np.eye(3))


def _area(light: Light, casters: InstanceTable, seen, resolution: int) -> list[Camera]:
    """The front of an area light, and the halves of the sides that it illuminates."""
    axes = look_at((0, 0, 0), light.direction)[:3, :3].T
    return _faces(light, casters, resolution, axes)[:-1]


_CAMERAS = {"sun": _sun, "point": _point, "spot": _spot, "area": _area}


def _faces(light: Light, casters: InstanceTable, resolution: int, axes: np.ndarray) -> list[Camera]:
    """Six square cameras; axes: (3, 3), of which the last's back comes first and its front last. The sides of their
    pictures lie along the axes too, or there would be gaps between them."""
    x, y, z = axes
    looks = (-z, y), (x, z), (-x, z), (y, z), (-y, z), (z, y)
    frames = [look_at((0, 0, 0), direction, up) for direction, up in looks]
    return _perspectives(light, casters, resolution, frames, FACE_WINDOW)


def _nearest_beside(position: np.ndarray, corners: np.ndarray) -> float:
    """The distance from a lamp to the nearest of the boxes (n, 8, 3) that it is not in; infinite if it is in all."""
    low, high = corners.min(axis=1), corners.max(axis=1)
    distances = np.linalg.norm(np.maximum(np.maximum(low - position, position - high), 0), axis=1)
    return float(distances[distances > 0].min(initial=np.inf))


def _perspectives(light: Light, casters: InstanceTable, resolution: int, frames, half: float) -> list[Camera]:
    position, corners = np.asarray(light.position, np.float64), casters.world_corners
    far = float(np.linalg.norm(corners - position, axis=2).max()) * 1.01
    nearest = _nearest_beside(position, corners)
    near = NEAREST * far if nearest > NEAREST * far else _JUST_BEFORE * nearest
    near = max(near, min(light.size / math.sqrt(3), 0.5 * far))
    window, size = (-half, half, -half, half), (resolution, resolution)
    for frame in frames:
        frame[:3, 3] = position
    return [Camera(frame, window, size, near, far) for frame in frames] if far > near else []
