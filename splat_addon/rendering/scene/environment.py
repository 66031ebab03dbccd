# SPDX-License-Identifier: GPL-3.0-or-later
"""A world image: the image itself, and its blurred levels for surfaces of each roughness.

Sources: Karis 2013, "Real Shading in Unreal Engine 4" (the image blurred by the lobe for a viewer along the normal);
Meyer et al. 2010, "On Floating-Point Normal Vectors" (the octahedral map that stores it).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property, partial

import numpy as np

from .equirectangular import equirectangular_directions
from .numbers import MAX_RADIANCE, check_range
from .octahedral import octahedral_directions
from .picture_sun import PictureSun, brightest_place, excess_of, sun_in
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
        check_range("The numbers of an environment's rotation", rotation, -2.0, 2.0)
        if bad := np.count_nonzero(~(np.abs(pixels) <= MAX_RADIANCE)):
            raise ValueError(f"{bad} numbers of the environment are not finite, or too large; make them 0.")
        object.__setattr__(self, "pixels", pixels)
        object.__setattr__(self, "rotation", rotation)

    def image_texels(self) -> np.ndarray:
        """(h, w, 4) float32: the image in the layout of a texture."""
        return opaque_texels(self.pixels)

    def level_texels(self, sun: PictureSun | None = None) -> np.ndarray:
        """(6 * 34, 34, 4) float32: the levels, stacked vertically; the last is the irradiance of a matt surface over
        pi. sun: what is left out of the picture."""
        maps = self._levels[0] if sun is None else self._levels[0] - self._levels_of(sun)
        side = LEVEL_SIDE + 2
        return opaque_texels(maps.astype(np.float32).reshape(-1, side, 3))

    def sun_above(self, limit: float) -> PictureSun | None:
        """The sun of what the picture has above this radiance, if it has one: see `picture_sun`. The same object as
        long as the limit is the same."""
        if self._sun and self._sun[0] == limit:
            return self._sun[1]
        place, (_, share) = self._brightest_place, equirectangular_directions(self._blurrable.shape[:2])
        mean = share @ self._blurrable.reshape(-1, 3).sum(axis=1) / (4 * np.pi)
        self._sun[:] = limit, sun_in(self.pixels, place, limit, mean) if place is not None else None
        return self._sun[1]

    @cached_property
    def _sun(self) -> list:
        """The last limit, and its sun."""
        return []

    @cached_property
    def _brightest_place(self) -> np.ndarray | None:
        mean = float(self._blurrable.max(axis=2).mean())
        return brightest_place(self.pixels, _step(self.pixels, BLURRED_ROWS), mean)

    @cached_property
    def _blurrable(self) -> np.ndarray:
        """(h, w, 3) the image with as few pixels as suffice for levels."""
        return reduced(self.pixels, BLURRED_ROWS)

    @cached_property
    def _levels(self) -> tuple[np.ndarray, np.ndarray]:
        """(6, 34 * 34, 3) the levels, and (6, 34 * 34, 1) the sums of their weights."""
        pixels = _with_pixels_all_around(self._blurrable)
        sums, weights = _sums(pixels.reshape(-1, 3), *equirectangular_directions(pixels.shape[:2]))
        return sums / weights, weights

    def lighting_pixels(self, sun: PictureSun | None) -> np.ndarray:
        """(h, w, 3) the image with as few pixels as suffice for matt surfaces. sun: what is left out of it."""
        return self._blurrable if sun is None else np.maximum(self._blurrable - self._pixels_of(sun), 0)

    def _pixels_of(self, sun: PictureSun) -> np.ndarray:
        """(h, w, 3) what a sun adds to the reduced image."""
        excess, pixels = excess_of(self.pixels, sun.middle, sun.limit), np.zeros(self._blurrable.shape)
        step = _step(self.pixels, BLURRED_ROWS)
        rows, columns = excess.rows // step, excess.columns // step
        is_whole = np.ix_(rows < len(pixels), columns < pixels.shape[1])
        at = rows[rows < len(pixels), None], columns[columns < pixels.shape[1]]
        np.add.at(pixels, at, excess.radiance[is_whole] / step**2)
        return pixels

    def _levels_of(self, sun: PictureSun) -> np.ndarray:
        """(6, 34 * 34, 3) what a sun adds to the levels."""
        pixels = _with_pixels_all_around(self._pixels_of(sun))
        directions, share = equirectangular_directions(pixels.shape[:2])
        flat = pixels.reshape(-1, 3)
        own = flat.any(axis=1)
        return _sums(flat[own], directions[own], share[own])[0] / self._levels[1]


def level_directions() -> np.ndarray:
    """(34, 34, 3) unit directions of a level's texels; those of the border lie beyond the map's edge, folded back."""
    ticks = (np.arange(-1, LEVEL_SIDE + 1) + 0.5) / LEVEL_SIDE * 2 - 1
    return octahedral_directions(*np.meshgrid(ticks, ticks))


def reduced(pixels: np.ndarray, rows: int) -> np.ndarray:
    """The image reduced to about `rows` rows, each pixel the mean of a block; unchanged if it has no more rows."""
    step = _step(pixels, rows)
    h, w = (n // step for n in pixels.shape[:2])
    if step == 1:
        return pixels
    return pixels[: h * step, : w * step].reshape(h, step, w, step, 3).mean(axis=(1, 3), dtype=np.float64)


def _step(pixels: np.ndarray, rows: int) -> int:
    """Rows and columns of a block of `reduced`."""
    step = max(pixels.shape[0] // rows, 1)
    return step if pixels.shape[1] >= step else 1


#: Minimum rows and columns that an image is blurred from: with few pixels, a surface might face none.
_FEWEST_PIXELS = (8, 16)


def _with_pixels_all_around(pixels: np.ndarray) -> np.ndarray:
    """The image with each pixel repeated until there are enough."""
    for axis, fewest in enumerate(_FEWEST_PIXELS):
        pixels = np.repeat(pixels, -(-fewest // pixels.shape[axis]), axis=axis)
    return pixels


def reflected_lobe(cosines: np.ndarray, roughness: float) -> np.ndarray:
    """GGX distribution for light at these cosines to the mirrored direction, with normal and viewer along it."""
    a2 = roughness**4
    half2 = (1 + np.clip(cosines, -1, 1)) / 2  # squared cosine of half the angle
    return a2 / (half2 * (a2 - 1) + 1) ** 2


def _sums(pixels: np.ndarray, directions: np.ndarray, share: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(6, 34 * 34, 3) for each level and direction the sum of pixels (n, 3) times weights, and (6, 34 * 34, 1) the sum
    of the weights. directions: (n, 3) of the pixels. share: (n,) solid angles."""
    cosines = level_directions().reshape(-1, 3) @ directions.T
    lit = np.maximum(cosines, 0) * share
    lobes = (*(partial(reflected_lobe, cosines, roughness) for roughness in LEVELS), lambda: 1.0)
    found = [(weights @ pixels, weights.sum(axis=1, keepdims=True)) for weights in (lit * lobe() for lobe in lobes)]
    return tuple(np.stack(each) for each in zip(*found, strict=True))
