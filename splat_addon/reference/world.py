# SPDX-License-Identifier: GPL-3.0-or-later
"""The radiance that reaches a surface from all around, in plain numpy; the twin of shaders/lib/world_light."""

from __future__ import annotations

import numpy as np

from ..rendering.scene import Scene
from ..rendering.scene.camera import Camera
from ..rendering.scene.environment import LEVEL_SIDE, LEVELS, Environment
from ..rendering.scene.picture_sun import REACH


class WorldLight:
    """The world of a scene, sampled in directions (n, 3) of a camera's eye space."""

    def __init__(self, scene: Scene, camera: Camera):
        self._tint, self._environment = np.array(scene.world), scene.environment
        self._sun = scene.picture_sun
        self._seen, self._seen_environment = np.array(scene.seen_world), scene.seen_environment
        if self._environment is not None:
            self._to_picture = self._environment.rotation @ camera.matrix_world[:3, :3]
            texels = self._environment.level_texels(self._sun)
            self._levels = texels.reshape(-1, *2 * texels.shape[1:2], 4)[..., :3].astype(np.float64)

    def background(self, direction: np.ndarray) -> np.ndarray:
        """(n, 3) radiance of the background in that direction."""
        if self._seen_environment is None:
            return np.broadcast_to(self._seen, direction.shape)
        return self._seen * _image_at(self._seen_environment, self._turned(direction))

    def irradiance(self, normal: np.ndarray) -> np.ndarray:
        """(n, 3) irradiance of a matt surface with that normal, over pi."""
        if self._environment is None:
            return np.broadcast_to(self._tint, normal.shape)
        return self._tint * _level_at(self._levels, np.full(len(normal), len(LEVELS)), self._turned(normal))

    def reflection(self, direction: np.ndarray, roughness: np.ndarray) -> np.ndarray:
        """(n, 3) mean radiance of a lobe with that roughness (n,) and mean direction."""
        if self._environment is None:
            return np.broadcast_to(self._tint, direction.shape)
        toward, levels = self._turned(direction), np.array(LEVELS)
        k = np.clip(np.searchsorted(levels, roughness) - 1, 0, len(levels) - 2)
        share = np.clip((roughness - levels[k]) / (levels[k + 1] - levels[k]), 0, 1)[:, None]
        blurred = _level_at(self._levels, k, toward) * (1 - share) + _level_at(self._levels, k + 1, toward) * share
        sharpness = np.clip(1 - roughness / levels[0], 0, 1)[:, None]
        return self._tint * (self._lighting_at(toward) * sharpness + blurred * (1 - sharpness))

    def _lighting_at(self, toward: np.ndarray) -> np.ndarray:
        """(n, 3) what lights of the picture, which is all but its sun."""
        radiance = _image_at(self._environment, toward)
        if self._sun is None:
            return radiance
        is_near = toward @ self._sun.middle > np.cos(REACH)
        brightest = np.where(is_near, radiance.max(axis=1), 0)
        return radiance * (self._sun.limit / np.maximum(brightest, self._sun.limit))[:, None]

    def _turned(self, direction: np.ndarray) -> np.ndarray:
        turned = direction @ self._to_picture.T
        return turned / np.linalg.norm(turned, axis=1, keepdims=True)


def _image_at(environment: Environment, direction: np.ndarray) -> np.ndarray:
    pixels = environment.pixels.astype(np.float64)
    rows, columns = pixels.shape[:2]
    x, y, z = direction.T
    across = (0.5 - np.arctan2(y, x) / (2 * np.pi)) * columns - 0.5
    up = (0.5 + np.arctan2(z, np.hypot(x, y)) / np.pi) * rows - 0.5
    j, i = np.floor(across).astype(int), np.floor(up).astype(int)
    s, t = (across - j)[:, None], (up - i)[:, None]
    left, right, low, high = j % columns, (j + 1) % columns, np.clip(i, 0, rows - 1), np.clip(i + 1, 0, rows - 1)
    below = pixels[low, left] * (1 - s) + pixels[low, right] * s
    return below * (1 - t) + (pixels[high, left] * (1 - s) + pixels[high, right] * s) * t


def _level_at(maps: np.ndarray, level: np.ndarray, direction: np.ndarray) -> np.ndarray:
    x, y, z = direction.T / np.abs(direction).sum(axis=1)
    folded_x, folded_y = np.where(x >= 0, 1 - np.abs(y), np.abs(y) - 1), np.where(y >= 0, 1 - np.abs(x), np.abs(x) - 1)
    x, y = np.where(z < 0, folded_x, x), np.where(z < 0, folded_y, y)
    across, up = (x + 1) * (LEVEL_SIDE / 2) + 0.5, (y + 1) * (LEVEL_SIDE / 2) + 0.5
    j, i = (np.clip(np.floor(a).astype(int), 0, LEVEL_SIDE) for a in (across, up))
    s, t = (across - j)[:, None], (up - i)[:, None]
    below = maps[level, i, j] * (1 - s) + maps[level, i, j + 1] * s
    return below * (1 - t) + (maps[level, i + 1, j] * (1 - s) + maps[level, i + 1, j + 1] * s) * t
