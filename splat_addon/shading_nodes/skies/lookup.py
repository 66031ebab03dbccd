# SPDX-License-Identifier: GPL-3.0-or-later
"""Skies by direction: a small table of what each part of the air scatters, times how it scatters toward the viewer."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from ..vectors import unit
from . import often_scattered, once_scattered
from .daylight import daylight
from .parameters import Air, Daylight, Sky

#: Elevations and half of the azimuths of a table; the other half mirrors it.
_ROWS, _COLUMNS = 96, 17


def _model(air: Air):
    return often_scattered if air.is_multiple else once_scattered


@lru_cache(maxsize=4)
def _table(air: Air) -> np.ndarray:
    """(parts, rows * columns, 3) CIE XYZ over `phases`. Rows are denser at the horizon; columns go away from the
    sun."""
    place = np.linspace(-1 if air.is_multiple else 0, 1, _ROWS)
    elevation, azimuth = np.meshgrid(
        np.copysign(place * place, place) * np.pi / 2, np.linspace(0, np.pi, _COLUMNS), indexing="ij"
    )
    directions = np.stack(
        [np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)], axis=-1
    )
    found = _model(air).scattered(air, directions.reshape(-1, 3))
    return np.ascontiguousarray(np.moveaxis(found, 1, 0), np.float32)


def scattered_sky(vector: np.ndarray, sky: Sky, from_xyz: np.ndarray) -> np.ndarray:
    """(3, n) radiance. vector: (3, n) directions, +Z up. from_xyz: (3, 3) to the working space."""
    direction, toward = unit(vector), np.float32(sky.toward)
    up = np.clip(direction[2], -1, 1)
    # below the horizon, light scattered once is as at the horizon
    level = up if sky.air.is_multiple else np.maximum(up, 0)
    across = np.sqrt((1 - level * level) / np.maximum(1 - up * up, np.float32(1e-12)))
    beside = (toward[0] * direction[0] + toward[1] * direction[1]) * across
    cosine = np.clip(beside + toward[2] * level, -1, 1)
    parts = _interpolated(_table(sky.air), sky.air.is_multiple, np.arcsin(level), _azimuth(direction, sky.turn))
    shares = _model(sky.air).phases(cosine)
    xyz = sum(share[:, None] * part for share, part in zip(shares, parts, strict=True))
    radiance = np.maximum(from_xyz.astype(np.float32) @ xyz.T, 0)
    if not sky.air.is_multiple:
        radiance = radiance * np.clip(1 + np.float32(2.5) * np.minimum(up, 0), 0, 1) ** 3
    return radiance if sky.disc is None else _add_disc(radiance, direction, sky, from_xyz)


def _azimuth(direction: np.ndarray, turn: float) -> np.ndarray:
    """(n,) 0 to pi, from the sun."""
    apart = np.arctan2(direction[0], direction[1]) - np.float32(turn)
    return np.abs(np.remainder(apart + np.float32(np.pi), np.float32(2 * np.pi)) - np.float32(np.pi))


def _interpolated(table: np.ndarray, is_whole: bool, elevation: np.ndarray, azimuth: np.ndarray) -> list[np.ndarray]:
    """(n, 3) of each part. is_whole: whether the table goes below the horizon."""
    place = np.copysign(np.sqrt(np.abs(elevation) * np.float32(2 / np.pi)), elevation)
    row = (place * np.float32(0.5) + np.float32(0.5) if is_whole else place) * np.float32(_ROWS - 1)
    column = azimuth * np.float32((_COLUMNS - 1) / np.pi)
    low, left = np.clip(row.astype(np.int32), 0, _ROWS - 2), np.clip(column.astype(np.int32), 0, _COLUMNS - 2)
    up, across = (row - low)[:, None], (column - left)[:, None]
    first = low * np.int32(_COLUMNS) + left
    weights = (1 - up) * (1 - across), (1 - up) * across, up * (1 - across), up * across
    places = first, first + 1, first + _COLUMNS, first + _COLUMNS + 1
    return [sum(part[at] * weight for at, weight in zip(places, weights, strict=True)) for part in table]


def _add_disc(radiance: np.ndarray, direction: np.ndarray, sky: Sky, from_xyz: np.ndarray) -> np.ndarray:
    """(3, n) with the sun's disc, darker to its rim, and redder to its lower edge."""
    model, (size, intensity, edge) = _model(sky.air), sky.disc
    size = max(size, 2 * edge)
    # by the chord, because the cosine is nearly 1
    chord = np.linalg.norm(direction - np.float32(sky.toward)[:, None], axis=0)
    apart = 2 * np.arcsin(np.clip(chord / 2, 0, 1)).astype(np.float64)
    elevation = np.arcsin(np.clip(direction[2], -1, 1))
    shows = (apart < (size + edge) / 2) & (elevation > model.horizon(sky.air))
    if not shows.any():
        return radiance
    lower, upper = (model.sunlight(sky.air, sky.air.elevation + side * size / 2)[:, None] for side in (-1, 1))
    place = (elevation[shows] - sky.air.elevation) / size + 0.5
    light = np.maximum(from_xyz @ (lower + (upper - lower) * place), 0) / (2 * np.pi * (1 - math.cos(size / 2)))
    radiance[:, shows] += light * _profile(apart[shows] / size, edge / size) * intensity
    return radiance


def _profile(apart: np.ndarray, edge: float) -> np.ndarray:
    """A disc's brightness at distances from its middle; it has as much light with a rim that fades over `edge` as
    without. Both in sizes of the disc."""

    def shown(apart: np.ndarray, edge: float) -> np.ndarray:
        darkened = 1 - 0.6 * (1 - np.sqrt(1 - np.minimum(2 * apart, 1) ** 2))
        return darkened * np.clip((0.5 - apart) / edge + 0.5, 0, 1)

    rings = (np.arange(512) + 0.5) / 512 * (1 + edge) / 2
    # of a disc with a sharp rim the mean is 0.8, and its half radius is 1/2
    light = 2 * (shown(rings, edge) * rings).mean() * (1 + edge) / 2
    return shown(apart, edge) * (0.8 / 4) / light


def daylight_sky(vector: np.ndarray, sky: Daylight, from_xyz: np.ndarray) -> np.ndarray:
    """(3, n) radiance, as `scattered_sky`."""
    return np.maximum(from_xyz @ daylight(unit(vector).astype(np.float64), sky), 0).astype(np.float32)


FUNCTIONS = {"scattered sky": scattered_sky, "daylight sky": daylight_sky}
