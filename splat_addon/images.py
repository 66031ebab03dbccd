# SPDX-License-Identifier: GPL-3.0-or-later
"""Looks colours up in a texture: Blender's extension modes, bilinear or closest, box-filtered where it is minified.

It sits in the bottom layer beside `surfels`, because both sampling (colours of surfels) and rendering (colours of
pixels) use it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

INTERPOLATIONS = ("Linear", "Closest")


@dataclass(frozen=True, eq=False)
class Image:
    """A texture.

    pixels: (h, w, 4) float32, scene-linear, not premultiplied, row 0 at the bottom; the centre of pixel k lies at
        texture coordinate (k + 1/2) / size.
    extension: what lies outside 0..1, as in Blender's Image Texture node, a name in `EXTENSIONS`.
    interpolation: "Linear" or "Closest".

    Raises ValueError with one sentence for a wrong shape or name.
    """

    pixels: np.ndarray
    extension: str = "REPEAT"
    interpolation: str = "Linear"

    def __post_init__(self):
        pixels = np.asarray(self.pixels, np.float32)
        if pixels.ndim != 3 or pixels.shape[2] != 4 or not pixels.size:
            raise ValueError(f"An image's pixels must have shape (h, w, 4) and at least one pixel, not {pixels.shape}.")
        if not np.isfinite(pixels).all():
            raise ValueError("An image's pixels must be finite; make others 0.")
        object.__setattr__(self, "pixels", pixels)
        for name, allowed in (("extension", tuple(EXTENSIONS)), ("interpolation", INTERPOLATIONS)):
            if getattr(self, name) not in allowed:
                raise ValueError(f"An image's {name} must be one of {', '.join(allowed)}, not {getattr(self, name)!r}.")

    @cached_property
    def is_opaque(self) -> bool:
        """Whether every pixel is opaque and the extension adds no transparent area around the image."""
        return self.extension != "CLIP" and bool((self.pixels[..., 3] == 1).all())

    @cached_property
    def pyramid(self) -> Pyramid:
        """The mipmap pyramid; built once and shared by all lookups."""
        return Pyramid(self)


class Pyramid:
    """An image and its box-filtered reductions, each half the size of the one before; each level is computed when first
    needed.

    Colours are premultiplied by alpha before filtering, so that fully transparent pixels do not bleed into others.
    """

    def __init__(self, image: Image):
        self._texels = EXTENSIONS[image.extension]
        self._taps = _linear_taps if image.interpolation == "Linear" else _closest_taps
        self._is_opaque = image.is_opaque
        pixels = image.pixels
        self._levels = [pixels if self._is_opaque else _premultiplied(pixels)]
        self.size = pixels.shape[1], pixels.shape[0]

    @property
    def count(self) -> int:
        """Number of levels, down to a single pixel."""
        return max(self.size).bit_length()

    def level(self, level: int) -> np.ndarray:
        """(h, w, 4) float32 pixels, premultiplied; level 0 is the image itself."""
        while len(self._levels) <= level:
            self._levels.append(_halved(_halved(self._levels[-1], 0), 1))
        return self._levels[level]

    def level_for(self, texels: np.ndarray) -> np.ndarray:
        """(n,) intp, the first level whose pixels are at least as far apart as the samples, or the last level.

        texels: (n,) distance between neighbouring samples, in pixels of the full-size image. Rounding
            errors do not raise an exact power of two to the next level.
        """
        with np.errstate(divide="ignore"):
            wanted = np.ceil(np.log2(np.nan_to_num(texels, nan=1.0)) - 1e-3)
        return np.clip(wanted, 0, self.count - 1).astype(np.intp)

    def lookup(self, uvs: np.ndarray, levels: np.ndarray) -> np.ndarray:
        """(n, 4) float32 colours, not premultiplied, at (2, n) texture coordinates; a non-finite coordinate
        counts as 0.
        """
        uvs = np.where(np.isfinite(uvs), uvs, 0)
        colors = np.empty((uvs.shape[1], 4), np.float32)
        for level in np.unique(levels):
            at = np.flatnonzero(levels == level)
            colors[at] = self._lookup_level(int(level), uvs[:, at])
        return colors if self._is_opaque else _straight(colors)

    def _lookup_level(self, level: int, uvs: np.ndarray) -> np.ndarray:
        pixels = self.level(level)
        height, width = pixels.shape[:2]
        flat = pixels.reshape(-1, 4)
        total = np.zeros((uvs.shape[1], 4), np.float32)
        for y, weight_y in self._taps(uvs[1], height):
            y, inside_y = self._texels(y, height)
            for x, weight_x in self._taps(uvs[0], width):
                x, inside_x = self._texels(x, width)
                total += flat.take(y * width + x, axis=0) * (weight_x * weight_y * inside_x * inside_y)[:, None]
        return total


def _repeat(index: np.ndarray, size: int):
    return index % size, 1.0


def _extend(index: np.ndarray, size: int):
    return np.clip(index, 0, size - 1), 1.0


def _mirror(index: np.ndarray, size: int):
    index = index % (2 * size)
    return np.minimum(index, 2 * size - 1 - index), 1.0


def _clip(index: np.ndarray, size: int):
    return np.clip(index, 0, size - 1), (index >= 0) & (index < size)


#: name -> function of (pixel indices, size) giving indices inside the image and the weight, 0 for transparent black.
EXTENSIONS: dict[str, Callable] = {"REPEAT": _repeat, "EXTEND": _extend, "CLIP": _clip, "MIRROR": _mirror}

#: Coordinates farther out than this many images are clamped: pixel indices must fit an integer.
_FARTHEST = 1e6


def _linear_taps(coordinate: np.ndarray, size: int):
    position = np.clip(coordinate, -_FARTHEST, _FARTHEST).astype(np.float64) * size - 0.5
    low = np.floor(position)
    share = (position - low).astype(np.float32)
    index = low.astype(np.intp)
    return (index, 1 - share), (index + 1, share)


def _closest_taps(coordinate: np.ndarray, size: int):
    position = np.clip(coordinate, -_FARTHEST, _FARTHEST).astype(np.float64) * size
    return ((np.floor(position).astype(np.intp), np.ones(len(position), np.float32)),)


@np.errstate(over="ignore", invalid="ignore")
def _premultiplied(colors: np.ndarray) -> np.ndarray:
    return np.concatenate([colors[..., :3] * colors[..., 3:], colors[..., 3:]], axis=-1)


def _straight(colors: np.ndarray) -> np.ndarray:
    alpha = colors[:, 3:]
    colors[:, :3] /= np.where(alpha == 0, 1, alpha)
    return colors


def _halved(pixels: np.ndarray, axis: int) -> np.ndarray:
    """The image box-filtered along one axis to half its size, rounded down; an odd size needs three weights per
    pixel."""
    size = pixels.shape[axis]
    if size == 1:
        return pixels
    half = size // 2
    rows = np.moveaxis(pixels, axis, 0)
    if size % 2 == 0:
        result = (rows[0::2] + rows[1::2]) / 2
    else:
        place = np.arange(half, dtype=np.float32)[:, None, None]
        weighted = (half - place) * rows[0:-1:2] + half * rows[1::2] + (place + 1) * rows[2::2]
        result = weighted / np.float32(size)
    return np.ascontiguousarray(np.moveaxis(result, 0, axis))
