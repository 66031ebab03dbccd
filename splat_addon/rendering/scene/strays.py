# SPDX-License-Identifier: GPL-3.0-or-later
"""Few places that lie thousands of times as far away as the others extend, such as stray vertices and points."""

from __future__ import annotations

import numpy as np

from ...surfels import Surfels

#: There are strays if all places extend more than this many times as far as the nearest quarter of them around one in
#: their midst, judged from about so many of them.
_STRAY, _SOME = 1024, 64

#: What lies within so many times the extent of that quarter is together; strays beyond are apart by powers of the
#: second number.
_TOGETHER, _STEP = 64.0, 32.0


def middle_of(places: np.ndarray) -> np.ndarray:
    """(3,) the origin for (n, 3) places: the middle of their box. If there are strays, relative to which float32 would
    place the others visibly wrong, it is a place in the midst of the others."""
    low, high = places.min(axis=0), places.max(axis=0)
    midst, extent = _midst(places)
    return midst if (high - low).max() > _STRAY * extent else (low + high) / 2


def without_strays(shape):
    """The surfels or polygons of a set in sets that each lie together, the strays apart from the others; the set alone
    if there are none."""
    if not len(shape):
        return (shape,)
    low, high = shape.local_bounds
    midst, extent = _midst(shape.positions)
    each = 1 if isinstance(shape, Surfels) else 3
    extent = max(extent, shape.largest) if each == 1 else extent
    if not (high - low).max() > _STRAY * extent:
        return (shape,)
    farthest = np.abs(shape.positions.astype(np.float64) - midst).max(axis=1).reshape(-1, each).max(axis=1)
    with np.errstate(divide="ignore"):
        steps = np.log(farthest / max(_TOGETHER * extent, 1e-300)) / np.log(_STEP)
    shells = np.ceil(np.maximum(steps, 0))
    return tuple(shape.take(np.repeat(shells == shell, each)) for shell in np.unique(shells))


def _midst(places: np.ndarray) -> tuple[np.ndarray, float]:
    """(3,) the place that the nearest quarter of all places lies closest around, and how far those extend."""
    some = places[:: max(len(places) // _SOME, 1)].astype(np.float64)
    distances = np.sort(np.abs(some[:, None] - some).max(axis=2), axis=1)
    nearest = distances[:, -(-(len(some) - 1) // 4)]
    return some[nearest.argmin()], float(nearest.min())
