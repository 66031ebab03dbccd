# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the textures of the last pass into the arrays of a frame."""

from __future__ import annotations

from functools import reduce

import numpy as np

from .frame import EMPTY_DEPTH, HELD_BY
from .plan.frame_plan import FramePlan
from .scene import Scene
from .scene.camera import Camera
from .settings import MAX_SAMPLES, Settings, held_arrays


def background_pixel(scene: Scene, settings: Settings) -> tuple[float, float, float, float]:
    """Premultiplied colour of a pixel that nothing covers."""
    return (0.0, 0.0, 0.0, 0.0) if settings.transparent_film else (*scene.seen_world, 1.0)


def background_texels(scene: Scene, settings: Settings) -> dict[str, np.ndarray]:
    """pixel texture -> (4,) float32 texel of a pixel that nothing covers."""
    pixels = {"color": background_pixel(scene, settings), "depth": EMPTY_DEPTH, "shadow": 1.0}
    texels = {texture: np.zeros(4, np.float32) for texture, _ in HELD_BY.values()}
    for name, value in pixels.items():
        texture, where = HELD_BY[name]
        texels[texture][where] = value
    return texels


def background(scene: Scene, size, settings: Settings) -> dict[str, np.ndarray]:
    """The arrays of a picture without splats."""
    texels = background_texels(scene, settings)
    held = {name: texels[HELD_BY[name][0]][HELD_BY[name][1]] for name in read_arrays(settings.outputs)}
    return {name: np.full((*size[::-1], *np.shape(texel)), texel) for name, texel in held.items()}


def read_arrays(outputs: tuple[str, ...]) -> tuple[str, ...]:
    """The names of the arrays that the device stores as they are, without conversion."""
    return tuple(name for name in held_arrays(outputs) if name in HELD_BY)


def read_tile(target, frame_plan: FramePlan, outputs: tuple[str, ...]) -> dict[str, np.ndarray]:
    """Read the requested arrays of one tile, without its margin."""
    kept = slice(frame_plan.margin, -frame_plan.margin or None)
    names, held = read_arrays(outputs), [texture.name for texture in frame_plan.passes[-1].colors]
    textures = {HELD_BY[name][0] for name in names}
    texels = {name: target.read(slot) for slot, name in enumerate(held) if name in textures}
    arrays = {}
    for name in names:
        texture, where = HELD_BY[name]
        arrays[name] = np.ascontiguousarray(texels[texture][kept, kept, where])
    return arrays


#: More could not be added up over all samples of a picture.
_MOST = float(np.finfo(np.float32).max) / MAX_SAMPLES


def mended(arrays: dict[str, np.ndarray]) -> int:
    """Make the pixels black and empty in which a number is not finite, in copies that take the place of the arrays;
    returns how many there are.

    Numbers that a scene may have can be too large for float32 together. Cycles makes such pixels black, too.
    """
    odd = reduce(np.logical_or, map(_are_odd, arrays.values()), False)
    count = int(np.count_nonzero(odd))
    for name in tuple(arrays) if count else ():
        values = arrays[name] = arrays[name].copy()  # what was read of one tile may be the device's own
        values[odd] = EMPTY_DEPTH if name == "depth" else 0
        if name == "color":
            values[odd, 3] = 1
    return count


def _are_odd(values: np.ndarray) -> np.ndarray | bool:
    """(h, w) bool: the pixels with a number that is not finite, or too large; False if there is none."""
    with np.errstate(invalid="ignore"):
        usable = np.abs(values) <= _MOST
    return False if usable.all() else ~(usable if usable.ndim == 2 else usable.all(axis=2))


def positions_of(camera: Camera, depth: np.ndarray, corner: tuple[int, int]) -> np.ndarray:
    """(h, w, 3) float32, 0 where nothing was hit. corner: the picture's pixel at which the depths begin."""
    is_hit = depth < EMPTY_DEPTH
    points = camera.points_at(np.where(is_hit, depth, 0.0), corner)
    return np.where(is_hit[..., None], points, 0.0).astype(np.float32)


def assembled(tiles, size) -> dict[str, np.ndarray]:
    """One picture from its tiles; a single tile is returned as it is."""
    if len(tiles) == 1:
        return tiles[0][1]
    width, height = size
    whole = {name: np.empty((height, width, *part.shape[2:]), np.float32) for name, part in tiles[0][1].items()}
    for (x, y, w, h), arrays in tiles:
        for name, part in arrays.items():
            whole[name][y : y + h, x : x + w] = part
    return whole
