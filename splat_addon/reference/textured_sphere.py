# SPDX-License-Identifier: GPL-3.0-or-later
"""The exact picture of a texture on an analytic sphere, without surfels: float64 rays, 12 x 12 a pixel."""

from __future__ import annotations

import math

import numpy as np

from ..rendering.scene import SurfaceTexture
from ..rendering.scene.camera import Camera
from .filters import filter_weights, resample
from .textures import point_colors

RAYS = 12
#: Rows of pixels whose rays are worked out at once.
STRIP = 16
#: Of what is well seen: less than 75 degrees from its normal.
LEAST_COSINE = math.cos(math.radians(75))


def textured_sphere(texture: SurfaceTexture, camera: Camera, pixel_filter: str) -> tuple[np.ndarray, np.ndarray]:
    """(h, w, 3) the texture by longitude and latitude on the unit sphere, and (h, w) bool where only what is well seen
    of it is in the pixel. camera: square, in perspective."""
    weights = filter_weights(pixel_filter, RAYS)
    margin = (len(weights) // RAYS - 1) // 2
    size, (left, right, bottom, top) = camera.size[0], camera.window
    rows, eye = [], camera.matrix_world[:3, 3]
    for first in range(0, size, STRIP):
        # the rays of some rows of pixels with the filter's margin
        last = min(first + STRIP, size)
        y = (np.arange((first - margin) * RAYS, (last + margin) * RAYS) + 0.5) / (size * RAYS)
        x = (np.arange(-margin * RAYS, (size + margin) * RAYS) + 0.5) / (size * RAYS)
        x, y = np.meshgrid(left + x * (right - left), bottom + y * (top - bottom))
        rays = np.stack([x, y, -np.ones_like(x)], axis=-1).reshape(-1, 3) @ camera.matrix_world[:3, :3].T
        rays /= np.linalg.norm(rays, axis=1, keepdims=True)
        along = -rays @ eye
        inside = along**2 - eye @ eye + 1
        points = eye + rays * (along - np.sqrt(np.maximum(inside, 0)))[:, None]
        seen = (inside > 0) & (-np.einsum("ij,ij->i", points, rays) > LEAST_COSINE)
        longitude = np.arctan2(points[:, 1], points[:, 0]) / (2 * np.pi) % 1
        uvs = np.stack([longitude, np.arcsin(np.clip(points[:, 2], -1, 1)) / np.pi + 0.5], axis=1)
        values = np.zeros((len(points), 4))
        values[seen, :3], values[seen, 3] = point_colors(texture, uvs[seen]), 1
        rows.append(resample(values.reshape(*x.shape, 4), weights, RAYS))
    pixels = np.concatenate(rows)
    return pixels[..., :3], pixels[..., 3] > 1 - 1e-9
