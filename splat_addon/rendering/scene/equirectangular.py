# SPDX-License-Identifier: GPL-3.0-or-later
"""The map between a picture of all directions and these directions, as Blender's Environment Texture has it: row 0
looks down, the middle column along +X, columns go on towards -Y."""

from __future__ import annotations

import math

import numpy as np


def equirectangular_directions(shape: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
    """(h w, 3) unit directions of a picture's pixels, and (h w,) the solid angle of each."""
    rows, columns = shape
    directions, share = directions_at(np.arange(rows), np.arange(columns), shape)
    return directions.reshape(-1, 3), np.repeat(share, columns)


def directions_at(rows: np.ndarray, columns: np.ndarray, shape: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
    """(r, c, 3) unit directions of pixels in some rows (r,) and columns (c,) of a picture of that shape, and (r,) the
    solid angle of a pixel in each row."""
    latitude = ((rows + 0.5) / shape[0] - 0.5) * np.pi
    longitude = (0.5 - (columns + 0.5) / shape[1]) * 2 * np.pi
    directions = np.empty((len(rows), len(columns), 3))
    directions[..., :2] = np.cos(latitude)[:, None, None] * np.stack([np.cos(longitude), np.sin(longitude)], axis=1)
    directions[..., 2] = np.sin(latitude)[:, None]
    edges = np.sin((np.stack([rows, rows + 1]) / shape[0] - 0.5) * np.pi)
    return directions, (edges[1] - edges[0]) * 2 * np.pi / shape[1]


def pixels_around(middle: np.ndarray, reach: float, shape: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
    """Rows and columns of the pixels of a picture that hold all directions within `reach`, radians, of `middle`."""
    latitude, longitude = math.asin(min(max(middle[2], -1), 1)), math.atan2(middle[1], middle[0])
    low, high = ((latitude + side * reach) / math.pi + 0.5 for side in (-1, 1))
    rows = np.arange(max(math.floor(low * shape[0]), 0), min(math.ceil(high * shape[0]), shape[0]))
    if abs(latitude) + reach >= math.pi / 2:
        return rows, np.arange(shape[1])
    beside = math.asin(math.sin(reach) / math.cos(latitude)) / (2 * math.pi)
    at = 0.5 - longitude / (2 * math.pi)
    first, last = math.floor((at - beside) * shape[1]), math.ceil((at + beside) * shape[1])
    return rows, np.arange(first, min(last, first + shape[1])) % shape[1]
