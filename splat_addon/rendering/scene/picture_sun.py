# SPDX-License-Identifier: GPL-3.0-or-later
"""The sun in a picture of the world: radiance above a limit around the brightest place, as a light that casts shadows.

Sources: Blender's EEVEE, which takes a sun out of the world (`World.sun_threshold`); Debevec 2005, "A Median Cut
Algorithm for Light Probe Sampling" (a region of a picture as a light at its centroid, of the same energy).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from .equirectangular import directions_at, pixels_around

#: What lies farther than this from the brightest place, radians, is not of its sun.
REACH = math.radians(10)
#: The largest angle across a sun, radians: the shadow of a wider light is too soft to stand for one direction.
WIDEST = math.radians(10)
#: The least share of a sun in the light on a surface that faces it: a lighter shadow is hard to see.
LEAST_SHARE = 0.05
#: The brightest place is found among pixels that are so many times as bright as the picture's mean.
_BRIGHT = 8.0


@dataclass(frozen=True, eq=False)
class PictureSun:
    """Within REACH of `middle`, (3,) unit, what a pixel's brightest channel has above `limit` is the sun's; the pixel's
    other channels are reduced by the same factor.

    toward: (3,) unit, to the centroid of the sun. It and `middle` are directions of the picture.
    irradiance: (3,) of a surface that faces it. angle: radians across a disc that is as concentrated.
    """

    middle: np.ndarray
    limit: float
    toward: np.ndarray
    irradiance: np.ndarray
    angle: float


class Excess(NamedTuple):
    """What is above a limit in a part of a picture. rows, columns: (r,), (c,) of that part. radiance: (r, c, 3).
    directions: (r, c, 3) unit. share: (r,) solid angle of a pixel."""

    rows: np.ndarray
    columns: np.ndarray
    radiance: np.ndarray
    directions: np.ndarray
    share: np.ndarray


def excess_of(pixels: np.ndarray, middle: np.ndarray, limit: float) -> Excess:
    """What pixels (h, w, 3) within REACH of a direction have above the limit."""
    rows, columns = pixels_around(middle, REACH, pixels.shape[:2])
    directions, share = directions_at(rows, columns, pixels.shape[:2])
    part = pixels[rows[:, None], columns].astype(np.float64)
    brightest = part.max(axis=2)
    brightest[directions @ middle < math.cos(REACH)] = 0
    part *= 1 - np.minimum(limit / np.maximum(brightest, limit), 1)[..., None]
    return Excess(rows, columns, part, directions, share)


def brightest_place(pixels: np.ndarray, block: int, mean: float) -> np.ndarray | None:
    """(3,) the direction to the block of pixels with the most light far above the mean; None if there is none.

    block: rows and columns of a block, which is small beside REACH. mean: of the pixels' brightest channels.
    """
    shape = pixels.shape[:2]
    starts = [np.arange(0, edge, block) for edge in shape]
    light = np.empty([len(start) for start in starts])
    for row, start in zip(light, starts[0], strict=True):  # a large picture in parts that processors cache
        part = pixels[start : start + block]
        bright = np.maximum(np.maximum(part[..., 0], part[..., 1]), part[..., 2]) - np.float32(_BRIGHT * mean)
        row[:] = np.add.reduceat(np.maximum(bright, 0, out=bright).sum(axis=0), starts[1])
    directions, share = directions_at(*(start + (block - 1) / 2 for start in starts), shape)
    light *= share[:, None]
    at = np.unravel_index(light.argmax(), light.shape)
    return directions[at] if light[at] > 0 else None


def sun_in(pixels: np.ndarray, middle: np.ndarray, limit: float, mean: float) -> PictureSun | None:
    """The sun at the picture's brightest place; None if nothing there is as bright, concentrated and strong as a sun.

    mean: of the radiance from all directions, summed over channels.
    """
    excess = excess_of(pixels, middle, limit)
    flux = excess.radiance * excess.share[:, None, None]
    vectors = np.einsum("rcx,rcd->xd", flux, excess.directions)
    length = np.linalg.norm(vectors.sum(axis=0))
    energy = flux.sum()
    if not length > 0 or energy < LEAST_SHARE * (energy + math.pi * (mean - energy / (4 * math.pi))):
        return None
    toward = vectors.sum(axis=0) / length
    angle = _angle_across(excess.radiance.sum(axis=2), excess.share)
    return PictureSun(middle, limit, toward, vectors @ toward, angle) if angle <= WIDEST else None


def _angle_across(radiance: np.ndarray, share: np.ndarray) -> float:
    """The angle across an even disc that is as concentrated as radiance (r, c) of pixels with solid angles (r,).

    A disc of solid angle w and radiance L has (sum of L)^2 / (sum of L^2) = w. Between pixels a picture is
    interpolated; L^2 of interpolated values integrates to L times a mean with weights 1, 4, 1 along each axis.
    """
    beside = radiance
    for axis in (0, 1):
        beside = (np.roll(beside, 1, axis) + 4 * beside + np.roll(beside, -1, axis)) / 6
    solid = (radiance * share[:, None]).sum() ** 2 / (radiance * beside * share[:, None]).sum()
    return 2 * math.acos(max(1 - solid / (2 * math.pi), -1))
