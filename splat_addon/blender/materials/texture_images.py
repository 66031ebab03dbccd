# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender images as scene-linear pixels, for `material_surfaces`.

Blender returns the pixels of an 8-bit image encoded and with straight alpha, those of a float image linear and
premultiplied. Sampling needs linear pixels with straight alpha, or opaque pixels if the alpha is unused.
"""

from __future__ import annotations

import bpy
import numpy as np


class UnreadableError(Exception):
    """An input of a shader comes from something that cannot be read; the text ends the sentence "it comes from ..."."""


def linear_pixels(image: bpy.types.Image, keep_alpha: bool) -> np.ndarray:
    """(h, w, 4) float32, scene-linear in Rec. 709, not premultiplied, row 0 at the bottom.

    keep_alpha: whether the material uses the image's alpha; otherwise the result is opaque and, as in Cycles and
    EEVEE, its colour premultiplied, unless the image's own alpha mode says that they are not related. In mode None an
    image has no alpha to keep.
    Raises UnreadableError for an image without pixels, a tiled or moving one, or an encoding other than sRGB.
    """
    if image.source not in ("FILE", "GENERATED"):
        raise UnreadableError(f"the {image.source.lower()} image {image.name!r}")
    pixels = _rgba(_stored_pixels(image), image)
    colors, alpha = pixels[..., :3], pixels[..., 3:]
    if not image.is_float:
        _decode(pixels, image)
    is_related = image.alpha_mode not in _ALPHA_IS_UNRELATED
    if image.alpha_mode == "NONE" or not keep_alpha:
        if is_related and not image.is_float:
            colors *= alpha
        alpha[...] = 1.0
    elif is_related and image.is_float:
        colors /= np.where(alpha == 0, 1, alpha)
    return pixels


_ALPHA_IS_UNRELATED = ("CHANNEL_PACKED", "NONE")

#: Colour spaces of 8-bit images whose values are linear in Rec. 709 as they are.
_LINEAR = ("Non-Color", "Linear Rec.709", "Raw", "scene_linear")


def srgb_to_linear(encoded: np.ndarray) -> np.ndarray:
    """IEC 61966-2-1: display-encoded values in 0..1 -> linear ones."""
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def _stored_pixels(image: bpy.types.Image) -> np.ndarray:
    """(h, w, channels) float32 as stored by Blender; the file is loaded from disk if necessary."""
    width, height = image.size
    count = len(image.pixels)
    if not count or count != width * height * image.channels:
        raise UnreadableError(f"the image {image.name!r}, which has no pixels (is its file missing?)")
    pixels = np.empty(count, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(height, width, image.channels)


def _rgba(pixels: np.ndarray, image: bpy.types.Image) -> np.ndarray:
    """Convert to RGBA, including grey and colours without alpha."""
    channels = pixels.shape[2]
    if channels not in (1, 3, 4):
        raise UnreadableError(f"the image {image.name!r} with {channels} channels")
    if channels == 4:
        return pixels
    rgba = np.ones((*pixels.shape[:2], 4), np.float32)
    rgba[..., :3] = pixels
    return rgba


#: Pixels decoded per batch, few enough for temporaries to stay in the processor's cache.
_CHUNK = 1 << 14


def _decode(pixels: np.ndarray, image: bpy.types.Image) -> None:
    """Make the colours linear in place: 8-bit values through a table of their 256 possible results."""
    space = image.colorspace_settings.name
    if space in _LINEAR:
        return
    if space != "sRGB":
        raise UnreadableError(f"the image {image.name!r} in the colour space {space!r}")
    table = srgb_to_linear(np.arange(256) / 255).astype(np.float32)
    rows = pixels.reshape(-1, 4)
    for chunk in (rows[start : start + _CHUNK] for start in range(0, len(rows), _CHUNK)):
        # Alpha goes along, since three columns of four are slower than all, and comes back.
        alpha = chunk[:, 3].copy()
        np.take(table, (chunk * 255 + 0.5).astype(np.uint8), out=chunk, mode="clip")
        chunk[:, 3] = alpha
