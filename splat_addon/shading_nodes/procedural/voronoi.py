# SPDX-License-Identifier: GPL-3.0-or-later
"""The Voronoi Texture in one to four dimensions: one random point in each cell of a grid.

Worley, "A Cellular Texture Basis Function", 1996; Quilez, "Smooth Voronoi" and "Voronoi edges", 2013 and 2014.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import product

import numpy as np

from ..numbers import octaves
from .hashes import of_cell, random
from .noise import in_dimensions
from .patterns import random_color

_FAR = np.float32(3e38)


def _point(cell: list[np.ndarray], by_pcg: bool) -> list[np.ndarray]:
    """The place of a cell's point in it, 0 to 1 in each dimension."""
    if len(cell) == 1:
        return [random(*cell)]
    if by_pcg:
        return of_cell(cell)
    if len(cell) < 4:
        return [random(*cell), *(random(*cell, np.float32([k])) for k in range(1, len(cell)))]
    return [random(*(cell[(k - turn) % 4] for k in range(4))) for turn in range(4)]


class _Cells:
    """The cells around places. randomness: how far points are from the corners of their cells. by_pcg: as in
    `voronoi`."""

    def __init__(self, places: list[np.ndarray], randomness: np.ndarray, by_pcg: bool):
        self._by_pcg = by_pcg
        self.dimensions = len(places)
        self._cell = [np.floor(place) for place in places]
        self.inside = [place - cell for place, cell in zip(places, self._cell, strict=True)]
        self._randomness = randomness

    def around(self, reach: int) -> Iterator[tuple[list, list]]:
        """The cells up to `reach` away, and their points, relative to the own cell; the first coordinate changes
        fastest."""
        for steps in product(range(-reach, reach + 1), repeat=self.dimensions):
            yield self.at([np.float32(step) for step in reversed(steps)])

    def at(self, offset: list) -> tuple[list, list]:
        """A cell by its offset, and its point."""
        cell = self.cell(offset)
        return offset, [o + p * self._randomness for o, p in zip(offset, _point(cell, self._by_pcg), strict=True)]

    def cell(self, offset: list) -> list[np.ndarray]:
        return [own + step for own, step in zip(self._cell, offset, strict=True)]

    def tint(self, offset: list) -> np.ndarray:
        """(3, n) the colour of a cell."""
        cell = self.cell(offset)
        if len(cell) == 1 or not self._by_pcg:
            return np.stack(random_color(cell))
        return np.stack(of_cell(cell if len(cell) > 2 else [*cell, np.zeros(1)])[:3])

    def absolute(self, point: list) -> np.ndarray:
        return np.stack(np.broadcast_arrays(*(own + p for own, p in zip(self._cell, point, strict=True))))


def _distance(a, b, metric: str, exponent) -> np.ndarray:
    off = [np.abs(p - q) for p, q in zip(a, b, strict=True)]
    if len(off) == 1:
        return off[0]
    if metric == "MANHATTAN":
        return sum(off)
    if metric == "CHEBYCHEV":
        return np.maximum.reduce(np.broadcast_arrays(*off))
    if metric == "MINKOWSKI":
        return sum(each**exponent for each in off) ** (1 / exponent)
    return np.sqrt(sum(each * each for each in off))


def _nearest(cells: _Cells, metric: str, exponent, rank: int) -> tuple[np.ndarray, list, list]:
    """Distance, offset and point of the nearest point, or of the second nearest if rank is 1."""
    found = []
    for offset, point in cells.around(1):
        new = [_distance(point, cells.inside, metric, exponent), *offset, *point]
        if not found:
            found = [[_FAR] + [np.float32(0)] * (len(new) - 1) for _ in range(rank + 1)]
        for k in range(rank + 1):
            is_nearer = new[0] < found[k][0]
            kept = found[k]
            found[k] = [np.where(is_nearer, n, f) for n, f in zip(new, kept, strict=True)]
            new = [np.where(is_nearer, f, n) for n, f in zip(new, kept, strict=True)]
    distance, *rest = found[rank]
    return distance, rest[: cells.dimensions], rest[cells.dimensions :]


def _by_rank(rank: int):
    def octave(cells, metric, exponent, smoothness):
        distance, offset, point = _nearest(cells, metric, exponent, rank)
        return distance, cells.tint(offset), cells.absolute(point)

    return octave


_first, _second = _by_rank(0), _by_rank(1)


def _smooth(cells, metric, exponent, smoothness):
    if not (smoothness != 0).any():
        return _first(cells, metric, exponent, smoothness)
    distance = color = place = None
    for offset, point in cells.around(2):
        away = _distance(point, cells.inside, metric, exponent)
        tint, point = cells.tint(offset), np.stack(np.broadcast_arrays(*point))
        if distance is None:
            distance, color, place = away, tint, point
            continue
        h = np.clip(np.float32(0.5) + np.float32(0.5) * (distance - away) / smoothness, 0, 1)
        h = h * h * (3 - 2 * h)
        less = smoothness * h * (1 - h)
        distance = distance + h * (away - distance) - less
        less = less / (1 + 3 * smoothness)
        color, place = color + h * (tint - color) - less, place + h * (point - place) - less
    return distance, color, cells.absolute([*place])


def _to_edge(cells: _Cells) -> np.ndarray:
    if cells.dimensions == 1:
        left, middle, right = (cells.at([np.float32(k)])[1][0] for k in (-1, 0, 1))
        (inside,) = cells.inside
        return np.minimum(np.abs((middle + left) / 2 - inside), np.abs((middle + right) / 2 - inside))
    points = [[p - q for p, q in zip(point, cells.inside, strict=True)] for _, point in cells.around(1)]
    nearest, least = points[0], _FAR
    for point in points:
        square = sum(each * each for each in point)
        is_nearer = square < least
        least = np.where(is_nearer, square, least)
        nearest = [np.where(is_nearer, p, n) for p, n in zip(point, nearest, strict=True)]
    least = _FAR
    for point in points:
        across = [p - n for p, n in zip(point, nearest, strict=True)]
        square = sum(each * each for each in across)
        middle = sum((p + n) / 2 * a for p, n, a in zip(point, nearest, across, strict=True))
        away = middle / np.sqrt(np.maximum(square, np.float32(1e-12)))
        least = np.where(square > np.float32(0.0001), np.minimum(least, away), least)
    return least


def _radius(cells: _Cells) -> np.ndarray:
    _, offset, own = _nearest(cells, "EUCLIDEAN", None, 0)
    least = _FAR
    for steps in product((-1, 0, 1), repeat=cells.dimensions):
        if any(steps):
            _, point = cells.at([o + np.float32(step) for o, step in zip(offset, steps, strict=True)])
            least = np.minimum(least, _distance(own, point, "EUCLIDEAN", None))
    return least / 2


_FEATURES = {"F1": _first, "F2": _second, "SMOOTH_F1": _smooth}


def voronoi(
    vector,
    w,
    scale,
    detail,
    roughness,
    lacunarity,
    smoothness,
    exponent,
    randomness,
    dimensions: str,
    feature: str,
    metric: str,
    norm: bool,
    by_pcg: bool,
) -> np.ndarray:
    """(8, n): distance (or radius), colour, position and w. norm: whether the distance is divided by the largest.

    by_pcg: whether the random numbers of cells are those of newer Blenders.
    """
    places = in_dimensions(vector * scale, w * scale, dimensions)
    detail, roughness = octaves(detail), np.clip(roughness, 0, 1)
    randomness, smoothness = np.clip(randomness, 0, 1), np.clip(smoothness / 2, 0, np.float32(0.5))
    reach = np.float32(0.5) + np.float32(0.5) * randomness
    if feature == "N_SPHERE_RADIUS":
        return _rows(_radius(_Cells(places, randomness, by_pcg)))
    if feature == "DISTANCE_TO_EDGE":
        return _rows(_edges(places, detail, roughness, lacunarity, randomness, reach, norm, by_pcg))
    farthest = _distance([reach] * len(places), [np.zeros(1, np.float32)] * len(places), metric, exponent)
    farthest = farthest * (2 if feature == "F2" else 1)
    distance = largest = np.zeros(1, np.float32)
    amplitude = octave_scale = np.ones(1, np.float32)
    color, place = np.zeros((3, 1), np.float32), np.zeros((len(places), 1), np.float32)
    is_one = (detail == 0) | (roughness == 0)
    for number in range(int(np.ceil(np.where(is_one, 0, detail)).max()) + 1):
        cells = _Cells([each * octave_scale for each in places], randomness, by_pcg)
        far, tint, at = _FEATURES[feature](cells, metric, exponent, smoothness)
        rest = np.where(number <= detail, 1, detail - np.floor(detail)).astype(np.float32)
        rest = np.where((number > 0) & (is_one | (number > np.ceil(detail))), 0, rest)
        distance, color = distance + rest * amplitude * far, color + rest * amplitude * tint
        place = place + rest * amplitude * (at / octave_scale - place)
        largest = largest + rest * amplitude
        octave_scale, amplitude = octave_scale * lacunarity, amplitude * roughness
    if norm:
        distance, color = distance / (largest * farthest), color / largest
    place = place / np.where(scale != 0, scale, 1) * (scale != 0)
    return _rows(distance, color, place)


def _edges(places, detail, roughness, lacunarity, randomness, reach, norm, by_pcg) -> np.ndarray:
    """(n,) distance to the nearest edge of all octaves."""
    amplitude = octave_scale = np.ones(1, np.float32)
    largest, distance = reach, np.float32([8])
    is_one = (detail == 0) | (roughness == 0)
    for number in range(int(np.ceil(np.where(is_one, 0, detail)).max()) + 1):
        far = _to_edge(_Cells([each * octave_scale for each in places], randomness, by_pcg))
        nearer = distance + amplitude * (np.minimum(distance, far / octave_scale) - distance)
        lower = largest + amplitude * (reach / octave_scale - largest)
        rest = np.where(number <= detail, 1, detail - np.floor(detail)).astype(np.float32)
        rest = np.where((number > 0) & (is_one | (number > np.ceil(detail))), 0, rest)
        is_last = number > detail
        nearer = np.where(is_last, np.minimum(distance, nearer), nearer)
        distance, largest = distance + rest * (nearer - distance), largest + rest * (lower - largest)
        octave_scale, amplitude = octave_scale * lacunarity, amplitude * roughness
    return distance / largest if norm else distance


def _rows(distance, color=None, place=None) -> np.ndarray:
    nothing = np.zeros(1, np.float32)
    rows = [distance, *([nothing] * 3 if color is None else color)]
    count = 0 if place is None else len(place)
    at = {0: [nothing] * 4, 1: [nothing] * 3 + [*(place if count else ())]}.get(count)
    if at is None:
        at = [*place, *[nothing] * (4 - count)]
    return np.stack(np.broadcast_arrays(*rows, *at)).astype(np.float32)


FUNCTIONS = {"voronoi": voronoi}
