# SPDX-License-Identifier: GPL-3.0-or-later
"""The camera: its position, and the window that it looks through, in float64.

Right-handed, looking down its local -Z. Pixel centres are at +0.5, and row 0 is at the bottom.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np

from .lens import Lens
from .numbers import MAX_FACTOR, MAX_INDEX, check_range
from .window import Windowed


@dataclass(frozen=True, eq=False)
class Camera(Windowed):
    """matrix_world: (4, 4) float64, camera to world, rigid (a scale in it is taken out).
    window: left, right, bottom, top of the picture; for a perspective camera on the plane at distance 1, for an
        orthographic one in world units.
    size: width, height in pixels. near, far: clip distances along -Z, world units.
    lens: used by renders with several samples, for perspective cameras; None is a pinhole.
    sample: the number of the picture's sample that this camera takes; noise differs from sample to sample.
    sample_variance: of the places of a picture's samples in the pixel, in square pixels; filters are narrower by it.
    """

    matrix_world: np.ndarray
    window: tuple[float, float, float, float]
    size: tuple[int, int]
    near: float = 0.1
    far: float = 1000.0
    is_orthographic: bool = False
    lens: Lens | None = None
    sample: int = 0
    sample_variance: float = 0.0

    def __post_init__(self):
        self._check(may_begin_behind=self.is_orthographic)
        check_range("The variance of a camera's samples", self.sample_variance, 0.0, MAX_FACTOR)
        check_range("A camera's sample", self.sample, 0, MAX_INDEX, is_whole=True)
        if self.lens and self.is_orthographic:
            raise ValueError("A lens needs a perspective camera: through one, parallel views are no longer parallel.")

    @classmethod
    def perspective(cls, matrix_world, vertical_fov: float, size, near=0.1, far=1000.0, shift=(0.0, 0.0)) -> Camera:
        """A pinhole camera. vertical_fov: radians, 0 to pi. shift: in picture widths, as Blender's lens shift."""
        if not 0 < vertical_fov < math.pi:
            raise ValueError(f"The field of view must lie between 0 and pi radians, not {vertical_fov}.")
        half_height = math.tan(vertical_fov / 2)
        return cls(matrix_world, _window(half_height, size, shift), size, near, far)

    @classmethod
    def orthographic(cls, matrix_world, height: float, size, near=0.1, far=1000.0, shift=(0.0, 0.0)) -> Camera:
        """A parallel camera. height: of the window, world units."""
        if not height > 0:
            raise ValueError(f"An orthographic window's height must be above 0, not {height}.")
        return cls(matrix_world, _window(height / 2, size, shift), size, near, far, is_orthographic=True)

    @classmethod
    def from_intrinsics(cls, fx, fy, cx, cy, size, matrix_world, near=0.1, far=1000.0) -> Camera:
        """A calibrated pinhole camera. fx, fy: focal lengths; cx, cy: principal point; all in pixels.

        cx, cy follow computer vision: from the top left corner, so cy counts downwards.
        """
        width, height = size
        window = (-cx / fx, (width - cx) / fx, (cy - height) / fy, cy / fy)
        return cls(matrix_world, window, size, near, far)

    def whole_pixels(self) -> tuple[float, float, float, float]:
        """The window moved by less than a pixel, so that all samples of a picture, and all its parts, have one."""
        (left, right, bottom, top), edges = self.window, []
        for first, last, count in ((left, right, self.size[0]), (bottom, top, self.size[1])):
            step = float(f"{(last - first) / count:.11g}")  # without the last digits, which moving changes
            middle = round((first + last) / 2 / step) * step
            edges += [middle - count / 2 * step, middle + count / 2 * step]
        return tuple(edges)

    def pixels_per_unit(self) -> float:
        """The most pixels that a world unit covers at distance 1, or anywhere in a parallel view."""
        left, right, bottom, top = self.whole_pixels()
        return max(self.size[0] / (right - left), self.size[1] / (top - bottom))

    def is_same(self, other: Camera) -> bool:
        """Whether both cameras show the same picture of any scene."""
        names = [f.name for f in fields(self) if f.name != "matrix_world"]
        same_values = all(getattr(self, name) == getattr(other, name) for name in names)
        return same_values and np.array_equal(self.matrix_world, other.matrix_world)

    def world_to_view(self) -> np.ndarray:
        """(4, 4) float64: the inverse of `matrix_world`, which may be sheared."""
        inverse = np.eye(4)
        inverse[:3, :3] = np.linalg.inv(self.matrix_world[:3, :3])
        inverse[:3, 3] = -inverse[:3, :3] @ self.matrix_world[:3, 3]
        return inverse

    def points_at(self, depths: np.ndarray, corner: tuple[int, int] = (0, 0)) -> np.ndarray:
        """(h, w, 3) float64 world points seen at the centres of the pixels starting at `corner`, at (h, w) distances
        along -Z."""
        left, right, bottom, top = self.window
        width, height = self.size
        depths = np.asarray(depths, np.float64)
        x, y = (first + np.arange(count) + 0.5 for first, count in zip(corner, depths.shape[::-1], strict=True))
        x = left + x * (right - left) / width
        y = bottom + y * (top - bottom) / height
        spread = 1.0 if self.is_orthographic else depths
        eye = np.stack([x * spread + 0 * depths, y[:, None] * spread + 0 * depths, -depths], axis=-1)
        return eye @ self.matrix_world[:3, :3].T + self.matrix_world[:3, 3]

    def pixels_of(self, points: np.ndarray) -> np.ndarray:
        """(n, 2) places in the picture, in pixels from its bottom left, of (n, 3) points in view space before the
        camera."""
        left, right, bottom, top = self.window
        depth = 1.0 if self.is_orthographic else -points[:, 2]
        # column by column, which takes a tenth of the time of pairs
        x = (points[:, 0] / depth - left) / (right - left) * self.size[0]
        y = (points[:, 1] / depth - bottom) / (top - bottom) * self.size[1]
        return np.array([x, y]).T

    def projection(self, near: float, far: float) -> np.ndarray:
        """(4, 4) float64 OpenGL projection (clip z from -w to w) of this window between two depths."""
        left, right, bottom, top = self.window
        matrix = np.zeros((4, 4))
        matrix[0, 0], matrix[1, 1] = 2 / (right - left), 2 / (top - bottom)
        if self.is_orthographic:
            matrix[0, 3], matrix[1, 3] = -(right + left) / (right - left), -(top + bottom) / (top - bottom)
            matrix[2, 2], matrix[2, 3] = -2 / (far - near), -(far + near) / (far - near)
            matrix[3, 3] = 1
        else:
            matrix[0, 2], matrix[1, 2] = (right + left) / (right - left), (top + bottom) / (top - bottom)
            matrix[2, 2], matrix[2, 3] = -(far + near) / (far - near), -2 * far * near / (far - near)
            matrix[3, 2] = -1
        return matrix


def look_at(eye, target, up=(0.0, 0.0, 1.0)) -> np.ndarray:
    """(4, 4) float64 matrix_world of a camera at `eye` that looks at `target`."""
    eye, target = np.asarray(eye, np.float64), np.asarray(target, np.float64)
    z = eye - target
    if not np.linalg.norm(z) > 0:
        raise ValueError("A camera cannot look at the point where it stands.")
    z = z / np.linalg.norm(z)
    x = np.cross(up, z)
    if np.linalg.norm(x) < 1e-9:
        x = np.cross((0.0, 1.0, 0.0), z)
    x /= np.linalg.norm(x)
    matrix = np.eye(4)
    matrix[:3] = np.stack([x, np.cross(z, x), z, eye], axis=1)
    return matrix


def _window(half_height: float, size, shift) -> tuple[float, float, float, float]:
    half_width = half_height * size[0] / size[1]
    dx, dy = shift[0] * 2 * half_width, shift[1] * 2 * half_width
    return -half_width + dx, half_width + dx, -half_height + dy, half_height + dy
