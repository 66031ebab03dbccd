# SPDX-License-Identifier: GPL-3.0-or-later
"""The exact picture of a texture on an analytic surface, without surfels: float64 rays, 12 x 12 a pixel."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..rendering.scene import SurfaceTexture
from ..rendering.scene.camera import Camera
from .filters import filter_weights, resample
from .textures import point_colors

RAYS = 12
#: Rows of pixels whose rays are worked out at once.
STRIP = 16

#: The eye (3,) and unit directions (n, 3) -> texture coordinates (n, 2), and (n,) bool where the surface is met.
Hits = Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


def seen_texture(
    texture: SurfaceTexture, camera: Camera, pixel_filter: str, hits: Hits
) -> tuple[np.ndarray, np.ndarray]:
    """(h, w, 3) picture of the texture, and (h, w) bool: pixels in which nothing else is visible. camera:
    square, in perspective.
    """
    weights = filter_weights(pixel_filter, RAYS)
    margin = (len(weights) // RAYS - 1) // 2
    size, (left, right, bottom, top) = camera.size[0], camera.window
    rows = []
    for first in range(0, size, STRIP):
        # the rays of some rows of pixels with the filter's margin
        last = min(first + STRIP, size)
        y = (np.arange((first - margin) * RAYS, (last + margin) * RAYS) + 0.5) / (size * RAYS)
        x = (np.arange(-margin * RAYS, (size + margin) * RAYS) + 0.5) / (size * RAYS)
        x, y = np.meshgrid(left + x * (right - left), bottom + y * (top - bottom))
        rays = np.stack([x, y, -np.ones_like(x)], axis=-1).reshape(-1, 3) @ camera.matrix_world[:3, :3].T
        rays /= np.linalg.norm(rays, axis=1, keepdims=True)
        uvs, seen = hits(camera.matrix_world[:3, 3], rays)
        values = np.zeros((len(rays), 4))
        values[seen, :3], values[seen, 3] = point_colors(texture, uvs[seen])[:, :3], 1
        rows.append(resample(values.reshape(*x.shape, 4), weights, RAYS))
    pixels = np.concatenate(rows)
    return pixels[..., :3], pixels[..., 3] > 1 - 1e-9
