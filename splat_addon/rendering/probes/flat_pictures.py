# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of a window that shaders look up, with smaller ones for what is blurred."""

from __future__ import annotations

import numpy as np

from ..frame import EMPTY_DEPTH

#: Each of these has half the pixels of the one before.
PICTURE_MAPS = 6


def picture_texels(color: np.ndarray, depth: np.ndarray) -> np.ndarray:
    """(h', w, 4) float32: below one another the picture, depths with 0 for none, and the picture at a half, a quarter
    ... of its size. color: (h, w, 4). depth: (h, w)."""
    depths = np.zeros_like(color)
    depths[..., 0] = np.where(depth < EMPTY_DEPTH, depth, 0.0)
    parts = [color, depths]
    for _ in range(1, PICTURE_MAPS):
        color = _halved(color)
        part = np.zeros((len(color), depth.shape[1], 4), np.float32)
        part[:, : color.shape[1]] = color
        parts.append(part)
    return np.concatenate(parts)


def _halved(pixels: np.ndarray) -> np.ndarray:
    """Half as many pixels along both edges, rounded up; the last ones count twice where there is no other."""
    height, width = (edge + edge % 2 for edge in pixels.shape[:2])
    padded = np.pad(pixels, ((0, height - len(pixels)), (0, width - pixels.shape[1]), (0, 0)), "edge")
    return padded.reshape(height // 2, 2, width // 2, 2, -1).mean(axis=(1, 3), dtype=np.float32)


def window_of(tile, seen) -> tuple[float, float, float, float]:
    """The left and bottom of a picture that a tile's frame looks up, and its pixels per unit, at depth 1 or in the
    view's units. seen: its `window` and `size`."""
    left, right, bottom, top = (edge * (tile.view.scale if tile.camera.is_orthographic else 1) for edge in seen.window)
    return left, bottom, seen.size[0] / (right - left), seen.size[1] / (top - bottom)
