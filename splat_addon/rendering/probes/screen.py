# SPDX-License-Identifier: GPL-3.0-or-later
"""What the camera sees, and a bit beside it, as a picture in which rays are followed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..frame import Frame
from ..scene.camera import Camera
from .flat_pictures import picture_texels

#: Beside the frame's picture, a share of it, in which rays may end.
BESIDE = 0.125
#: Pixels along an edge of the picture.
MOST_PIXELS = 4096


def wider_camera(camera: Camera) -> Camera:
    """The camera with a window that is larger by `BESIDE`."""
    left, right, bottom, top = camera.whole_pixels()
    beside = [int(np.ceil(edge * BESIDE)) for edge in camera.size]
    across, up = (right - left) / camera.size[0] * beside[0], (top - bottom) / camera.size[1] * beside[1]
    size = tuple(edge + 2 * more for edge, more in zip(camera.size, beside, strict=True))
    scale = min(MOST_PIXELS / max(size), 1.0)
    size = tuple(max(int(np.ceil(edge * scale)), 1) for edge in size)
    window = left - across, right + across, bottom - up, top + up
    made = Camera(camera.matrix_world, window, size, camera.near, camera.far)
    return replace(made, is_orthographic=camera.is_orthographic)


class ScreenPicture:
    """seen: by the camera."""

    def __init__(self, camera: Camera, seen: Frame):
        self.window, self.size, self._seen = camera.window, camera.size, seen

    def texels(self) -> np.ndarray:
        """(h, w, 4) float32, as of `picture_texels`."""
        return picture_texels(self._seen.color, self._seen.depth)
