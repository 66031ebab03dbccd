# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures at single points, in float64: what texture-mapped splats show to each ray of `render_exact`."""

from __future__ import annotations

import numpy as np

from ..images import EXTENSIONS
from ..rendering.scene import Instance, SurfaceTexture


def surfel_textures(instance: Instance) -> np.ndarray:
    """(N,) object array: the texture that each surfel looks its colour up in, or None."""
    surfels = instance.surfels
    textures = np.full(len(surfels), None)
    if instance.is_textured:
        table = np.array((*instance.textures, None), object)[:-1]
        moves = (np.column_stack([surfels.uv_along_x, surfels.uv_along_y]) != 0).any(axis=1)
        textures[moves] = table[np.minimum(surfels.materials[moves], len(table) - 1)]
    return textures


def point_colors(texture: SurfaceTexture, uvs: np.ndarray) -> np.ndarray:
    """(n, 4) linear colours, not premultiplied, and alphas at (n, 2) coordinates: bilinear or closest, unfiltered.

    Colours are mixed premultiplied by alpha, so that what an alpha of 0 hides does not bleed.
    """
    image = texture.image
    pixels = image.pixels.astype(np.float64)
    height, width = pixels.shape[:2]
    total = np.zeros((len(uvs), 4))
    for y, weight_y in _taps(uvs[:, 1] * height, image.interpolation):
        y, inside_y = EXTENSIONS[image.extension](y, height)
        for x, weight_x in _taps(uvs[:, 0] * width, image.interpolation):
            x, inside_x = EXTENSIONS[image.extension](x, width)
            texel = pixels[y, x]
            weight = weight_x * weight_y * inside_x * inside_y
            total[:, :3] += texel[:, :3] * (texel[:, 3] * weight)[:, None]
            total[:, 3] += texel[:, 3] * weight
    alpha = total[:, 3:]
    return np.concatenate([texture.factor * total[:, :3] / np.where(alpha > 0, alpha, 1), alpha], axis=1)


def _taps(position: np.ndarray, interpolation: str):
    if interpolation == "Closest":
        return ((np.floor(position).astype(np.int64), 1.0),)
    low = np.floor(position - 0.5)
    share = position - 0.5 - low
    return ((low.astype(np.int64), 1 - share), (low.astype(np.int64) + 1, share))
