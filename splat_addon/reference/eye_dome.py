# SPDX-License-Identifier: GPL-3.0-or-later
"""Eye-dome lighting of a picture in float64 (Boucheny 2009): the twin of shaders/features/eye_dome.glsl."""

from __future__ import annotations

import numpy as np

from ..rendering.frame import EMPTY_DEPTH
from ..rendering.scene.camera import Camera
from ..rendering.scene.eye_dome import EyeDome, steps_of


def darkening(depth: np.ndarray, camera: Camera, eye_dome: EyeDome) -> np.ndarray:
    """(h, w) factor of the colour, 1 where nothing is visible. Pixels beside the picture count as empty.

    depth: (h, w) along the view, as a frame has it, one sample per pixel.
    """
    left, right, bottom, top = camera.window
    pixel = np.array(((right - left) / camera.size[0], (top - bottom) / camera.size[1]))
    straight, slanted = map(int, steps_of(eye_dome.radius))
    total = np.zeros(depth.shape)
    for along in ((straight, 0), (0, straight), (slanted, slanted), (slanted, -slanted)):
        ahead, back = (_nearer(depth, camera, sign * np.array(along)) for sign in (1, -1))
        is_known = np.isfinite(ahead) & np.isfinite(back)
        for one, opposite in ((ahead, back), (back, ahead)):
            rise = np.maximum(one - np.maximum(-opposite, 0), 0) / np.linalg.norm(along * pixel)
            total += np.where(is_known, rise, 0)
    return np.where(depth < EMPTY_DEPTH, np.exp(-eye_dome.gain * total / 8), 1.0)


def _nearer(depth: np.ndarray, camera: Camera, along: np.ndarray) -> np.ndarray:
    """How much nearer the pixels `along` from each are, in what changes evenly along a plane; nan if there is none."""
    (x, y), edge, (height, width) = along, np.abs(along).max(), depth.shape
    padded = np.pad(np.where(depth < EMPTY_DEPTH, depth, np.nan), edge, constant_values=np.nan)
    there = padded[edge + y : edge + y + height, edge + x : edge + x + width]
    with np.errstate(invalid="ignore"):
        return depth - there if camera.is_orthographic else depth / there - 1
