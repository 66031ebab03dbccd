# SPDX-License-Identifier: GPL-3.0-or-later
"""Panoramic cameras: the direction of each point of the picture, as in Cycles' cameras of the same names.

In the camera's space: right-handed, looking down -Z.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from .numbers import MAX_LENGTH, MIN_LENGTH
from .window import Windowed

#: A panorama of a smaller angle would need faces of too many pixels.
_LEAST_ANGLE = 1e-3


class Projection(Protocol):
    """How a picture is mapped to the directions around a camera."""

    def directions(self, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """u: (1, w) of 0 to 1 from the left, v: (h, 1) from the bottom -> (h, w, 3) unit directions; zero outside the
        projection."""

    def angles(self) -> tuple[float, float]:
        """Radians along the picture's width and height, measured where its pixels are finest."""


@dataclass(frozen=True)
class Equirectangular:
    """Columns of longitude, to the right, and rows of latitude; longitude 0 and latitude 0 are straight ahead."""

    longitude: tuple[float, float] = (-math.pi, math.pi)
    latitude: tuple[float, float] = (-math.pi / 2, math.pi / 2)

    def __post_init__(self):
        for name, limit in (("longitude", math.pi), ("latitude", math.pi / 2)):
            low, high = getattr(self, name)
            if not (-limit - 1e-6 <= low and low + _LEAST_ANGLE <= high <= limit + 1e-6):
                raise ValueError(
                    f"A panorama's {name} must rise between -{math.degrees(limit):g} and {math.degrees(limit):g} "
                    f"degrees, not go from {math.degrees(low):g} to {math.degrees(high):g}."
                )

    def directions(self, u, v):
        (west, east), (south, north) = self.longitude, self.latitude
        longitude, latitude = west + u * (east - west), south + v * (north - south)
        level = np.cos(latitude)
        return np.stack(
            [
                level * np.sin(longitude),
                np.broadcast_to(np.sin(latitude), np.broadcast_shapes(u.shape, v.shape)),
                -level * np.cos(longitude),
            ],
            axis=-1,
        )

    def angles(self):
        return self.longitude[1] - self.longitude[0], self.latitude[1] - self.latitude[0]


@dataclass(frozen=True)
class EquidistantFisheye:
    """Angles from the axis grow linearly from the middle of the picture to an ellipse in it. field_of_view: radians."""

    field_of_view: float

    def __post_init__(self):
        if not _LEAST_ANGLE <= self.field_of_view <= 2 * math.pi + 1e-6:
            raise ValueError(f"A fisheye's field of view must be 0 to 360 degrees, not {self.field_of_view} radians.")

    def directions(self, u, v):
        x, y = 2 * u - 1, 2 * v - 1
        radius = np.hypot(x, y)
        return _around_axis(x, y, radius, np.where(radius <= 1, radius * self.field_of_view / 2, np.nan))

    def angles(self):
        return self.field_of_view, self.field_of_view


@dataclass(frozen=True)
class EquisolidFisheye:
    """Equal areas show equal solid angles. focal_length and sensor (width and height) are in the same unit."""

    field_of_view: float
    focal_length: float
    sensor: tuple[float, float]

    def __post_init__(self):
        EquidistantFisheye(self.field_of_view)
        sizes = self.focal_length, *self.sensor
        if not all(MIN_LENGTH < size < MAX_LENGTH for size in sizes):
            raise ValueError(f"A fisheye's lens and sensor must be above 0, not {self.focal_length}, {self.sensor}.")
        if self.angles()[0] < _LEAST_ANGLE or self.angles()[1] < _LEAST_ANGLE:
            raise ValueError(f"A fisheye's lens of {self.focal_length} is too long for its sensor, {self.sensor}.")

    def directions(self, u, v):
        x, y = (u - 0.5) * self.sensor[0], (v - 0.5) * self.sensor[1]
        radius = np.hypot(x, y)
        ratio = radius / (2 * self.focal_length)
        is_seen = ratio <= math.sin(self.field_of_view / 4)
        return _around_axis(x, y, radius, np.where(is_seen, 2 * np.arcsin(np.minimum(ratio, 1)), np.nan))

    def angles(self):
        return self.sensor[0] / self.focal_length, self.sensor[1] / self.focal_length


def _around_axis(x, y, radius, angle) -> np.ndarray:
    """Directions at an angle from straight ahead, towards (x, y) of that radius; zero where the angle is NaN."""
    across = np.sin(angle) / np.where(radius > 0, radius, 1)
    return np.nan_to_num(np.stack([x * across, y * across, -np.cos(angle)], axis=-1))


@dataclass(frozen=True, eq=False)
class Panorama(Windowed):
    """A camera that looks all around. matrix_world: (4, 4) float64, rigid. size: width, height in pixels.
    near, far: clip distances along the axes of the six views that it is made from, world units.
    window: left, right, bottom, top of the visible part, from 0 to 1 of the whole picture.
    """

    matrix_world: np.ndarray
    projection: Projection
    size: tuple[int, int]
    near: float = 0.1
    far: float = 1000.0
    window: tuple[float, float, float, float] = (0.0, 1.0, 0.0, 1.0)

    def __post_init__(self):
        self._check()

    def directions(self, rows: slice, place=(0.5, 0.5)) -> np.ndarray:
        """(n, w, 3) float64 in the camera's space, for these rows of pixels, through a point in each pixel (0 to 1)."""
        left, right, bottom, top = self.window
        width, height = self.size
        column, row = np.arange(width)[None, :], np.arange(height)[rows, None]
        u = left + (column + place[0]) / width * (right - left)
        v = bottom + (row + place[1]) / height * (top - bottom)
        return self.projection.directions(u, v)

    def pixel_angle(self) -> float:
        """Radians along the finest edge of the finest pixel."""
        left, right, bottom, top = self.window
        across, up = self.projection.angles()
        return min(across * (right - left) / self.size[0], up * (top - bottom) / self.size[1])
