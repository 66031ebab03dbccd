# SPDX-License-Identifier: GPL-3.0-or-later
"""A world image: the image itself, and its blurred levels for surfaces of each roughness.

Sources: Karis 2013, "Real Shading in Unreal Engine 4" (the image blurred by the lobe for a viewer along the normal);
Meyer et al. 2010, "On Floating-Point Normal Vectors" (the octahedral map that stores it).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from .texels import opaque_texels

#: Roughness of each blurred level; below the first, the image itself is mixed in. The last level is for matt surfaces.
LEVELS = (0.25, 0.4, 0.6, 0.8, 1.0)
#: Texels along the side of a level's octahedral map, without the border of one texel for interpolation.
LEVEL_SIDE = 32
#: Rows of the reduced image that levels are blurred from: finer than the narrowest lobe.
BLURRED_ROWS = 64


@dataclass(frozen=True, eq=False)
class Environment:
    """pixels: (h, w, 3) float32 radiance, equirectangular as Blender's Environment Texture has it: row 0 looks down,
    the middle column along +X, columns go on towards -Y. rotation: (3, 3), from world directions to the picture's.

    Raises ValueError for a wrong shape or numbers that are not finite.
    """

    pixels: np.ndarray
    rotation: np.ndarray = field(default_factory=lambda: np.eye(3))

    def __post_init__(self):
        pixels, rotation = np.ascontiguousarray(self.pixels, np.float32), np.array(self.rotation, np.float64)
        if pixels.ndim != 3 or pixels.shape[2] != 3 or not pixels.size:
            raise ValueError(f"An environment's pixels must have shape (h, w, 3), not {pixels.shape}.")
        if rotation.shape != (3, 3) or not np.isfinite(rotation).all():
            raise ValueError("An environment's rotation must be 3 x 3 finite numbers.")
        if not np.isfinite(pixels).all():
            raise ValueError(f"{np.count_nonzero(~np.isfinite(pixels))} numbers of the environment are not finite.")
        object.__setattr__(self, "pixels", pixels)
        object.__setattr__(self, "rotation", rotation)

    def image_texels(self) -> np.ndarray:
        """(h, w, 4) float32: the image in the layout of a texture."""
        return opaque_texels(self.pixels)

    def level_texels(self) -> np.ndarray:
        """(6 * 34, 34, 4) float32: the levels, stacked vertically; the last is the irradiance of a matt surface over
        pi."""
        return self._levels

    @cached_property
    def _levels(self) -> np.ndarray:
        pixels = reduced(_with_pixels_all_around(self.pixels), BLURRED_ROWS)
        directions, share = equirectangular_directions(pixels.shape[:2])
        toward = level_directions()
        cosines = toward.reshape(-1, 3) @ directions.T
        lit = np.maximum(cosines, 0) * share
        maps = [_blurred(lit * _lobe(cosines, roughness), pixels) for roughness in LEVELS]
        maps.append(_blurred(lit, pixels))
        texels = np.ones((len(maps), *toward.shape[:2], 4), np.float32)
        texels[..., :3] = np.reshape(maps, (*texels.shape[:3], 3))
        return texels.reshape(-1, toward.shape[1], 4)


def equirectangular_directions(shape: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
    """(h w, 3) unit directions of a picture's pixels, and (h w,) the solid angle of each."""
    rows, columns = shape
    latitude = ((np.arange(rows) + 0.5) / rows - 0.5) * np.pi
    longitude = (0.5 - (np.arange(columns) + 0.5) / columns) * 2 * np.pi
    around = np.stack([np.cos(longitude), np.sin(longitude)], axis=1)
    directions = np.empty((rows, columns, 3))
    directions[..., :2] = np.cos(latitude)[:, None, None] * around
    directions[..., 2] = np.sin(latitude)[:, None]
    edges = np.sin(np.linspace(-0.5, 0.5, rows + 1) * np.pi)
    return directions.reshape(-1, 3), np.repeat(np.diff(edges) * 2 * np.pi / columns, columns)


def level_directions() -> np.ndarray:
    """(34, 34, 3) unit directions of a level's texels; those of the border lie beyond the map's edge, folded back."""
    ticks = (np.arange(-1, LEVEL_SIDE + 1) + 0.5) / LEVEL_SIDE * 2 - 1
    x, y = np.meshgrid(ticks, ticks)
    for a, b in ((x, y), (y, x)):
        beyond = np.abs(a) > 1
        a[beyond] = np.sign(a[beyond]) * 2 - a[beyond]
        b[beyond] = -b[beyond]
    z = 1 - np.abs(x) - np.abs(y)
    fold = np.maximum(-z, 0)
    x, y = x - np.where(x >= 0, fold, -fold), y - np.where(y >= 0, fold, -fold)
    directions = np.stack([x, y, z], axis=2)
    return directions / np.linalg.norm(directions, axis=2, keepdims=True)


def reduced(pixels: np.ndarray, rows: int) -> np.ndarray:
    """The image reduced to about `rows` rows, each pixel the mean of a block; unchanged if it has no more rows."""
    step = max(pixels.shape[0] // rows, 1)
    h, w = (n // step for n in pixels.shape[:2])
    if min(h, w) == 0 or step == 1:
        return pixels
    return pixels[: h * step, : w * step].reshape(h, step, w, step, 3).mean(axis=(1, 3), dtype=np.float64)


#: Minimum rows and columns that an image is blurred from: with few pixels, a surface might face none.
_FEWEST_PIXELS = (8, 16)


def _with_pixels_all_around(pixels: np.ndarray) -> np.ndarray:
    """The image with each pixel repeated until there are enough."""
    for axis, fewest in enumerate(_FEWEST_PIXELS):
        pixels = np.repeat(pixels, -(-fewest // pixels.shape[axis]), axis=axis)
    return pixels


def _lobe(cosines: np.ndarray, roughness: float) -> np.ndarray:
    """GGX distribution for light at these cosines to the mirrored direction, with normal and viewer along it."""
    a2 = roughness**4
    half2 = (1 + np.clip(cosines, -1, 1)) / 2  # squared cosine of half the angle
    return a2 / (half2 * (a2 - 1) + 1) ** 2


def _blurred(weights: np.ndarray, pixels: np.ndarray) -> np.ndarray:
    return weights @ pixels.reshape(-1, 3) / weights.sum(axis=1, keepdims=True)
