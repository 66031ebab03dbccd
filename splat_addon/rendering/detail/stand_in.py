# SPDX-License-Identifier: GPL-3.0-or-later
"""A few surfels in place of many, spread over all of them, for a view that waits for the rest."""

from __future__ import annotations

from weakref import WeakSet

import numpy as np

from ...clip_lines import CLIP_FIELDS
from ...large_surfels import LARGE_WEIGHT, are_large
from ...normal_fields import NORMAL_FIELDS
from ...surfels import Surfels

#: Surfels of all stand-ins of a view together.
STAND_IN = 1 << 16

#: Factor by which they are wider than those that they replace would be, were they evenly spread.
_WIDER = 1.3

#: Places in each part of the area, one of which is taken.
_PLACES = 1 << 10

#: Adding up the areas of more surfels takes longer than a picture may.
_MOST_BY_AREA = 1 << 18

#: Fields that they do not have: they are whole, and seen too shortly for their normals to change.
LEFT_OUT = (*CLIP_FIELDS, *NORMAL_FIELDS)

#: Fields that change over a half-axis, or are divided by it.
_PER_AXIS = ("uv_along_x", "uv_along_y", "uv_border")


#: Sets that stand for others. They have no levels of detail, which would take longer to build than they are seen.
STAND_INS: WeakSet[Surfels] = WeakSet()


def spread(count: int, wanted: int) -> np.ndarray:
    """(min(wanted, count),) int64 indices: one from each of as many equal runs, so that a set in any spatial order is
    covered evenly, and from changing places, so that a grid leaves no stripes."""
    wanted = min(wanted, count)
    ends = np.linspace(0, count, wanted + 1).astype(np.int64)
    chosen = np.arange(wanted, dtype=np.uint64) * np.uint64(0x9E3779B1) % np.uint64(1 << 32)
    return ends[:-1] + (np.diff(ends) * (chosen.astype(np.float64) / 2**32)).astype(np.int64)


def widened(arrays: dict[str, np.ndarray], areas: float | np.ndarray) -> dict[str, np.ndarray]:
    """The fields of n surfels that stand for others: as much wider as these would leave bare, and whole.

    areas: of what they stand for, relative to their own; one number, or (n,). 1 or less: they stand for themselves."""
    factor = np.where(np.less_equal(areas, 1), 1, _WIDER * np.sqrt(areas)).astype(np.float32)
    arrays = {name: array for name, array in arrays.items() if name not in LEFT_OUT}
    return {
        name: array * factor.reshape(-1, *[1] * (array.ndim - 1)) if name in ("scales", *_PER_AXIS) else array
        for name, array in arrays.items()
    }


def stand_in(surfels: Surfels, wanted: int) -> Surfels:
    """At most `wanted` surfels in place of a set: one for each part of about the same area, or number in large sets."""
    count = len(surfels)
    rows, areas = spread(count, wanted), count / max(min(wanted, count), 1)
    if wanted < count <= _MOST_BY_AREA:
        own = np.maximum(surfels.scales.prod(axis=1, dtype=np.float64), 1e-300)
        # Large ones overlap less, and stand for as much more.
        is_large = np.zeros(count, bool) if surfels.blend_depth is None else are_large(surfels.blend_depth)
        ends = np.cumsum(own * np.where(is_large, LARGE_WEIGHT, 1))
        # the places at which even parts of the whole area begin, moved as rows are
        places = (spread(_PLACES * wanted, wanted) + 0.5) * (ends[-1] / (_PLACES * wanted))
        rows = np.unique(np.searchsorted(ends, places))
        areas = ends[-1] / wanted / own[rows]
    arrays = widened({name: array[rows] for name, array in surfels.arrays().items()}, areas)
    return standing_in(Surfels(origin=surfels.origin, is_solid=surfels.is_solid, **arrays))


def standing_in(surfels: Surfels) -> Surfels:
    """The set, known as one that stands for others."""
    STAND_INS.add(surfels)
    return surfels
