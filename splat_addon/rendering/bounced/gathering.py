# SPDX-License-Identifier: GPL-3.0-or-later
"""What merged surfels receive from one another, from the world and from lamps.

References: Bunnell, "Dynamic Ambient Occlusion and Indirect Lighting", 2005, and Christensen, "Point-Based Approximate
Color Bleeding", 2008 (merged surfels that send and receive); Ward, Rubinstein, Clear, "A Ray Tracing Solution for
Diffuse Interreflection", 1988 (light is even within a share of the mean distance of what sends it).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from ...workers import in_order
from ..scene.light import Light
from .lamps import sent
from .surfaces import Surfaces

#: Rays in all, and the fewest and the most that a merged surfel sends out.
RAYS, _FEWEST, _MOST = 1_500_000, 32, 256
#: Rays of a merged surfel to each lamp; in all.
_TO_LAMPS, _ALL_TO_LAMPS = 16, 1_000_000
#: How far from a lamp, in cubes, nothing hides it: what it is mounted on.
_LAMP_ROOM = 2.5
#: A merged surfel is within something if fewer of its rays count.
_WITHIN = 0.5
#: Merged surfels whose rays are followed together.
_AT_ONCE = 256
#: Steps of two numbers that fill a square evenly (Roberts 2018), and of three that keep neighbours apart.
_PLASTIC = 1 / np.array([1.32471795724474602596, 1.32471795724474602596**2])
_BETWEEN_SIDES, _APART = 0.37, 1 / 1.22074408460575947536 ** np.arange(1, 4)


@dataclass(frozen=True, eq=False)
class Seen:
    """What m merged surfels see through d rays each, weighted by the cosine. numbers: (m, d) int32 merged surfels; -1
    for the world, -2 for a ray that does not count, because it is inside of something. world: (m, 3) mean of the
    world's light. open: (m,) its share. counts: (m,) rays that count. distances: (m,) harmonic mean, in cells."""

    numbers: np.ndarray
    world: np.ndarray
    open: np.ndarray
    counts: np.ndarray
    distances: np.ndarray

    def gathered(self, radiance: np.ndarray) -> np.ndarray:
        """(m, 3) mean radiance that arrives if merged surfels send this, (m, 3)."""
        every = np.concatenate([radiance, np.zeros((2, 3))])  # -1 and -2 are the last ones
        total = np.stack([every[:, k][self.numbers].sum(axis=1) for k in range(3)], axis=1)
        return self.world + total / np.maximum(self.counts, 1)[:, None]


def seen_from(surfaces: Surfaces, sky: Callable[[np.ndarray], np.ndarray], rays: int = RAYS) -> Seen:
    """sky: the world's radiance (n, 3) in directions (n, 3)."""
    count = int(np.clip(rays // max(len(surfaces), 1), _FEWEST, _MOST))
    starts = range(0, len(surfaces), _AT_ONCE)
    parts = list(in_order(partial(_seen_from, surfaces, sky, count, slice(k, k + _AT_ONCE)) for k in starts))
    return Seen(*(np.concatenate(each) for each in zip(*parts, strict=True)))


def _seen_from(surfaces: Surfaces, sky, count: int, some: slice) -> tuple[np.ndarray, ...]:
    own, chances = _rays(surfaces, some, count)
    directions = cosine_directions(surfaces.points.normals[own], chances)
    counts_too = surfaces.are_free[own]
    rows = np.flatnonzero(counts_too)
    numbers = np.full(len(own), -2, np.int32)
    edge = surfaces.voxels.edge
    begins = surfaces.starts[own[rows]]
    cubes = surfaces.voxels.first_full(begins, directions[rows])
    is_met = cubes >= 0
    found = np.full(len(rows), -1, np.int32)
    hit = surfaces.hit(cubes[is_met], directions[rows[is_met]])
    found[is_met] = np.where(hit >= 0, hit, -2)
    numbers[rows] = found
    inverse = np.zeros(len(own))
    middles = (np.stack(np.unravel_index(cubes[is_met], surfaces.voxels.blocks.shape), axis=1) + 0.5) * edge
    away = np.linalg.norm(middles - begins[is_met], axis=1)
    inverse[rows[is_met]] = surfaces.cell * edge / np.maximum(away, edge)
    world = np.zeros((len(own), 3))
    escaped = rows[~is_met]
    world[escaped] = sky(directions[escaped])
    shape = len(own) // count, count
    counts, tried = ((rays > 0).reshape(shape).sum(axis=1) for rays in (numbers + 2, counts_too))
    within = counts < _WITHIN * tried
    numbers.reshape(shape)[within], counts[within] = -2, 0
    per = 1 / np.maximum(counts, 1)
    is_open = (numbers == -1).reshape(shape).sum(axis=1) * per
    mean_inverse = inverse.reshape(shape).sum(axis=1) * per
    world = np.where(within[:, None], 0, world.reshape(*shape, 3).sum(axis=1)) * per[:, None]
    return numbers.reshape(shape), world, is_open, counts, 1 / np.maximum(mean_inverse, 1e-6)


def _rays(surfaces: Surfaces, some: slice, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Of so many rays of each of some merged surfels: the point that each begins at, and two even chances, (n, 2)."""
    first, last = surfaces.first[:-1][some], surfaces.first[1:][some]
    each = np.arange(count)
    own = first[:, None] + (each * (last - first)[:, None]) // count
    turns = surfaces.cells[some] @ _APART + _BETWEEN_SIDES * surfaces.sides[some]
    chances = (turns[:, None, None] * _PLASTIC[::-1] + (each[:, None] + 0.5) * _PLASTIC) % 1
    return own.ravel(), chances.reshape(-1, 2)


def cosine_directions(normals: np.ndarray, chances: np.ndarray) -> np.ndarray:
    """(n, 3) unit directions around normals, as often as their cosine (Malley), of even chances (n, 2)."""
    sign = np.where(normals[:, 2] < 0, -1.0, 1.0)  # Duff et al. 2017
    x, y, z = normals.T
    a = -1 / (sign + z)
    b = x * y * a
    first = np.stack([1 + sign * x * x * a, sign * b, -sign * x], axis=1)
    second = np.stack([b, sign + y * y * a, -y], axis=1)
    radius, angle = np.sqrt(chances[:, 0]), 2 * np.pi * chances[:, 1]
    along = radius * np.cos(angle), radius * np.sin(angle)
    height = np.sqrt(np.maximum(1 - chances[:, 0], 0))
    return first * along[0][:, None] + second * along[1][:, None] + normals * height[:, None]


def lit_by_lamps(surfaces: Surfaces, lights: tuple[Light, ...]) -> np.ndarray:
    """(m, 3) mean irradiance over pi of merged surfels by lamps, with shadows."""
    total = np.zeros((len(surfaces), 3))
    if not lights:
        return total
    count = int(np.clip(_ALL_TO_LAMPS // (len(lights) * max(len(surfaces), 1)), 1, _TO_LAMPS))
    starts = range(0, len(surfaces), 16 * _AT_ONCE)
    for light in lights:
        jobs = (partial(_lit_by, surfaces, light, count, slice(k, k + 16 * _AT_ONCE)) for k in starts)
        total += np.concatenate(list(in_order(jobs)))
    return total


def _lit_by(surfaces: Surfaces, light: Light, count: int, some: slice) -> np.ndarray:
    own, chances = _rays(surfaces, some, count)
    begins = surfaces.starts[own]
    toward, distances, irradiance = sent(light, begins + surfaces.voxels.low, chances)
    cosines = np.maximum((toward * surfaces.points.normals[own]).sum(axis=1), 0)
    counts_too = surfaces.are_free[own]
    value = irradiance * (cosines * counts_too / np.pi)[:, None]
    if light.receivers is not None:
        value *= np.isin(surfaces.points.light_sets[own], light.receivers)[:, None]
    if light.casts_shadow:
        rows = np.flatnonzero(value.any(axis=1))
        is_hidden = (
            surfaces.voxels.first_full(begins[rows], toward[rows], distances[rows] - _LAMP_ROOM * surfaces.voxels.edge)
            >= 0
        )
        value[rows[is_hidden]] = 0
    counts = counts_too.reshape(-1, count).sum(axis=1)
    return value.reshape(-1, count, 3).sum(axis=1) / np.maximum(counts, 1)[:, None]


def bounced(surfaces: Surfaces, seen: Seen, direct: np.ndarray, bounces: int) -> np.ndarray:
    """(m, 3) irradiance over pi of merged surfels, without lamps: the world, emission, and what other surfaces reflect
    after up to so many bounces.

    direct: (m, 3) irradiance over pi by lamps.
    """
    albedo, emission = (surfaces.mean(getattr(surfaces.points, name)) for name in ("albedo", "emission"))
    smooth = smoother(surfaces, seen)
    translucency, opposite = surfaces.mean(surfaces.points.translucency), surfaces.opposite

    def sent(light: np.ndarray) -> np.ndarray:
        behind = np.concatenate([light, np.zeros((1, 3))])[opposite]
        return emission + albedo * (light + translucency * (behind - light))

    light = smooth(seen.gathered(emission))
    for _ in range(bounces):
        light = smooth(seen.gathered(sent(direct + light)))
    return light


#: Light is even within this share of the mean distance of what sends it; and how often neighbours are mixed.
_EVEN, _TURNS = 0.35, 3


def smoother(surfaces: Surfaces, seen: Seen) -> Callable[[np.ndarray], np.ndarray]:
    """A function that makes values (m, c) even where the light cannot differ much; those of merged surfels that see
    nothing are those of their neighbours."""
    first, second = surfaces.neighbours
    normals = surfaces.mean(surfaces.points.normals)
    is_usable = seen.counts > 0
    reach = np.where(is_usable, _EVEN * seen.distances, 1.0)
    alike = np.maximum((normals[first] * normals[second]).sum(axis=1), 0) ** 8
    weights = alike * np.minimum(np.minimum(reach[first], reach[second]) ** 2, 1.0)
    rows, columns, weights = np.concatenate([first, second]), np.concatenate([second, first]), np.tile(weights, 2)
    weights *= is_usable[columns]
    total = np.bincount(rows, weights, len(surfaces)) + is_usable

    def once(values: np.ndarray) -> np.ndarray:
        sums = [np.bincount(rows, weights * column[columns], len(surfaces)) for column in values.T]
        own = values * is_usable[:, None]
        return (own + np.stack(sums, axis=1)) / np.maximum(total, 1e-9)[:, None]

    def smooth(values: np.ndarray) -> np.ndarray:
        for _ in range(_TURNS):
            values = once(values)
        return values

    return smooth
