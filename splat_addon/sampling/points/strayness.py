# SPDX-License-Identifier: GPL-3.0-or-later
"""How much each of some surfels stands alone, or hangs in the air as a disc that is too large."""

from __future__ import annotations

import numpy as np

from .cleanup import ISOLATED_FROM_ALL_RATIO, ISOLATED_RATIO, first_of_each
from .neighbours import nearest_neighbours

#: Neighbours that are looked at.
_NEIGHBOURS = 12
#: A disc is too large from this many times the median size of its neighbours on, beside which it was estimated.
_TOO_LARGE = 5.0
#: A surfel lies off the surface if it is this many times as far from its neighbours' planes as these are from theirs,
#: and this share of the distance between surfels.
_OFF_OTHERS, _OFF_SPACING = 6.0, 0.3
#: Surfels per batch.
_CHUNK = 1 << 16


def strayness(positions: np.ndarray, radii: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """(N,) float64 that grows with how stray each surfel is: 0 where it is like its neighbours, 1 where it is far from
    them, while these are close to others, far from them beside the median of all, off the planes in which they lie, or
    much larger than they are.

    positions: (N, 3) finite. radii: (N,) the larger half-axes. normals: (N, 3). Of several in one place the first is
    looked at, and the others have 0; so have all if there are too few to compare.
    """
    made = np.zeros(len(positions))
    if len(positions) <= _NEIGHBOURS:
        return made
    first = first_of_each(np.asarray(positions, np.float64))
    if len(first) <= _NEIGHBOURS:
        return made
    places, size = np.asarray(positions, np.float64)[first], np.asarray(radii, np.float64)[first]
    neighbours, distances = nearest_neighbours(places, _NEIGHBOURS)
    mean, off = distances.mean(axis=1, dtype=np.float64), _off_planes(places, np.asarray(normals)[first], neighbours)
    with np.errstate(divide="ignore", invalid="ignore"):
        from_others = _share(mean / _around(mean, neighbours), ISOLATED_RATIO)
        from_all = _share(mean / np.median(mean), ISOLATED_FROM_ALL_RATIO)
        from_surface = np.minimum(_share(off / _around(off, neighbours), _OFF_OTHERS), off / mean / _OFF_SPACING)
        too_large = _share(size / _around(size, neighbours), _TOO_LARGE)
    found = np.nan_to_num([from_others, from_all, from_surface, too_large], nan=0.0)
    made[first] = np.maximum(found.max(axis=0), 0)
    return made


def _share(ratios: np.ndarray, most: float) -> np.ndarray:
    """Of the way from what is usual, a ratio of 1, to `most`."""
    return (ratios - 1) / (most - 1)


def _around(values: np.ndarray, neighbours: np.ndarray) -> np.ndarray:
    """(N,) medians over each one's neighbours."""
    return np.median(values[neighbours], axis=1)


def _off_planes(positions: np.ndarray, normals: np.ndarray, neighbours: np.ndarray) -> np.ndarray:
    """(N,) median distance of each surfel from the planes of its neighbours."""
    off = np.empty(len(positions))
    for start in range(0, len(positions), _CHUNK):
        part = slice(start, start + _CHUNK)
        away = positions[part, None] - positions[neighbours[part]]
        off[part] = np.median(np.abs(np.einsum("nkc,nkc->nk", normals[neighbours[part]], away)), axis=1)
    return off
