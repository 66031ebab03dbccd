# SPDX-License-Identifier: GPL-3.0-or-later
"""Which shadow maps a picture needs, with how many texels, and what casts into them.

Sources: Williams 1978, "Casting Curved Shadows on Curved Surfaces"; Botsch et al. 2005, section 6 (splats
seen by a light are a visibility pass from there).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from ..scene import Scene
from ..scene.camera import Camera
from ..scene.light import Light
from ..scene.table import InstanceTable
from .atlas import ShadowMap, atlas_columns, placed_in_atlas
from .casters import in_the_way, sees
from .high_casters import brought_down
from .light_cameras import cameras_of
from .receivers import (
    FILTER_REACH,
    Receivers,
    Viewers,
    are_larger_than_pixels,
    looked_up,
    receivers,
    spread_of,
    together,
    used_texels,
)

#: Maximum number of maps in the atlas; suns have the first, then the brightest lamps, and the others cast no shadow.
MAX_MAPS = 256
#: Of more maps than this, those of lamps have at most half the texels along a side: so many full ones fill the atlas.
FULL_MAPS = 64
#: Smaller maps than this are not cheaper.
LEAST_SIDE = 32
#: The map of a sun covers all that is visible, so where its texels would be larger than pixels, it has up to this many
#: times as many along its side; of several suns, fewer. No map grows beyond the larger of this side and the settings'.
FINER_SUN, LARGEST_SIDE = 4, 4096


def shadow_maps(
    scene: Scene, viewers: Viewers, resolution: int, lights_splats: bool = False
) -> tuple[tuple[ShadowMap, ...], int]:
    """The maps that a picture needs, and the number of lights left without. lights_splats: as in `receivers`.

    resolution: texels along a map's side; fewer where the picture's pixels are so large that these suffice, and more
    for suns (`FINER_SUN`).

    How many lights there is room for does not depend on the camera, so that none loses its shadow while it moves.
    """
    if not any(map(_asks, scene.lights)):
        return (), 0
    casters = scene.table.casting
    if not len(casters):
        return (), 0
    corners = casters.world_corners
    suns = sum(_asks(light) and light.kind == "sun" for light in scene.lights)
    lamps = sum(_asks(light) and light.kind != "sun" for light in scene.lights)
    for_sun = receivers(scene.table.seen, replace(viewers.sun, lens=None), lights_splats) if suns else None
    for_lamps = [receivers(scene.table.seen, camera, lights_splats) for camera in viewers.lamps] if lamps else []
    finest = max(min(resolution * (FINER_SUN // atlas_columns(suns)), LARGEST_SIDE), resolution)
    chosen, without = _with_room(scene.lights, lambda light: cameras_of(light, casters, for_sun, resolution), corners)
    count = suns + sum(len(own) for k, (own, _) in chosen.items() if scene.lights[k].kind != "sun")
    of_lamp = resolution if count <= FULL_MAPS else resolution // 2
    made = []
    for number in sorted(chosen):
        light, (own, are_faces) = scene.lights[number], chosen[number]
        seen = [one and one.of(light) for one in ([for_sun] if light.kind == "sun" else for_lamps)]
        most = finest if light.kind == "sun" else of_lamp
        if light.kind != "sun":
            own = [replace(camera, size=(most, most)) for camera in own]
        made += _needed(number, light, own, most, [one for one in seen if one], casters, are_faces)
    return placed_in_atlas(made), without


def _with_room(
    lights: Sequence[Light], cameras: Callable[[Light], list[Camera]], corners: np.ndarray
) -> tuple[dict[int, tuple[list[Camera], bool]], int]:
    """(number of a light -> its cameras that see casters, and whether they are faces of a cube) of the lights for which
    there is room, and the number of the others. corners: (n, 8, 3) of the casters, world."""
    order = sorted((k for k, light in enumerate(lights) if _asks(light)), key=lambda k: _rank(lights[k]))
    found, count = {}, 0
    for before, number in enumerate(order):
        whole = cameras(lights[number])
        own = [c for c in whole if c.is_orthographic or sees(c, corners).any()]
        # a sun whose shadows are not seen could be seen by a camera that moves
        count += 1 if lights[number].kind == "sun" else len(own)
        if count > MAX_MAPS:
            return found, len(order) - before
        found[number] = own, len(whole) > 1
    return found, 0


def _asks(light: Light) -> bool:
    """Whether a light can cast shadows: a black one has none."""
    return light.casts_shadow and _brightness(light) > 0


def _brightness(light: Light) -> float:
    return abs(light.energy) * float(np.abs(light.color).max())


def _rank(light: Light) -> tuple[bool, float]:
    """Suns come first, which shine everywhere, and the brightest before others."""
    return light.kind != "sun", -_brightness(light)


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
    is_smaller = side < resolution
    cameras = [resized(camera, side) for camera in cameras]
    if light.kind == "sun":
        casters = brought_down(casters, cameras[0])
    corners = casters.world_corners
    for camera, look in zip(cameras, looks, strict=True):
        spread = spread_of(light, camera)
        # a wider window shows more
        if one := together([looked_up(camera, one, spread) for one in seen]) if is_smaller else look:
            block = sees(camera, corners) & in_the_way(light, _texel_of(camera), seen, spread, corners)
            if block.any():
                found.append(
                    ShadowMap(
                        number,
                        camera,
                        place=(0, 0),
                        is_face=are_faces,
                        is_smaller=is_smaller,
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


def _texel_of(camera: Camera) -> float:
    """The length of a map's texel, world units; of a lamp's at distance 1."""
    left, right, _, _ = camera.window
    return (right - left) / camera.size[0]
