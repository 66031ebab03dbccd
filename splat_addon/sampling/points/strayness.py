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


def strayness(positions: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """(N,) float64 that grows with how stray each surfel is, 1 where it is far from its neighbours, while these are
    close to others, far from them beside the median of all, or much larger than they are.

    positions: (N, 3) finite. radii: (N,) the larger half-axes. Of several in one place the first is looked at, and the
    others have 0; so have all if there are too few to compare.
    """
    made = np.zeros(len(positions))
    if len(positions) <= _NEIGHBOURS:
        return made
    first = first_of_each(np.asarray(positions, np.float64))
    if len(first) <= _NEIGHBOURS:
        return made
    neighbours, distances = nearest_neighbours(np.asarray(positions, np.float64)[first], _NEIGHBOURS)
    mean, size = distances.mean(axis=1, dtype=np.float64), np.asarray(radii, np.float64)[first]
    with np.errstate(divide="ignore", invalid="ignore"):
        from_others = mean / np.median(mean[neighbours], axis=1) / ISOLATED_RATIO
        from_all = mean / np.median(mean) / ISOLATED_FROM_ALL_RATIO
        too_large = size / np.median(size[neighbours], axis=1) / _TOO_LARGE
    made[first] = np.nan_to_num(np.maximum.reduce([from_others, from_all, too_large]), nan=0.0)
    return made
