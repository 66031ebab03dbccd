# SPDX-License-Identifier: GPL-3.0-or-later
"""What makes a whole set of surfels look like a mistake, such as an opacity of 0 everywhere: it would be an empty
picture, or one colour, without a word. It sits in the bottom layer beside `surfels`."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .surfels import Surfels

#: An opacity below this is 0 in 8 bits.
_CLEAR = 0.5 / 255

#: From this share of surfels on, transparency looks like a mistake.
_MANY = 0.5

#: Half-axes, as shares of the extent of all surfels: below, no picture of all of them shows one; above, half of them
#: cover everything.
_TINY, _HUGE = 1e-7, 1.0

#: The relative rounding of float32, and how far it may move surfels, in their smaller half-axes.
_ROUNDING, _VISIBLE = 2.0**-24, 0.1

#: A few surfels may well be larger than what they span.
_FEWEST = 16

#: Places beyond this leave float32's range as soon as they are squared (sampling leaves out points there).
_FARTHEST = 1e18


def doubts(surfels: Surfels) -> list[str]:
    """A sentence about each."""
    if not len(surfels):
        return []
    transparency = doubts_of_transparency(clear_count(surfels), len(surfels))
    return [*transparency, *(_of_size(surfels) or doubts_of_rounding([surfels])), *_of_place(surfels)]


def clear_count(surfels: Surfels) -> int:
    """The number of surfels that cannot be seen, because they are fully transparent."""
    return int(np.count_nonzero(surfels.colors[:, 3] < _CLEAR))


def doubts_of_transparency(clear: int, total: int) -> list[str]:
    """A sentence if many of `total` surfels are clear, or nothing."""
    if clear <= _MANY * total:
        return []
    return [f"{clear:,} of {total:,} surfels are fully transparent (alpha 0), so that nobody sees them"]


def doubts_of_rounding(parts: Sequence[Surfels]) -> list[str]:
    """A sentence if some surfels lie so far from the origin of the first set that float32 moves them visibly when they
    are kept relative to it, or nothing."""
    parts = [part for part in parts if len(part)]
    if not parts:
        return []
    ends = [part.origin - parts[0].origin + end for part in parts for end in part.local_bounds]
    farthest = float(np.abs(ends).max())
    rounding, size = farthest * _ROUNDING, min(float(np.median(part.scales.min(axis=1))) for part in parts)
    if not rounding > _VISIBLE * size:
        return []
    return [
        f"Positions are rounded by up to {rounding:.2g}, because surfels with half-axes of {size:.2g} lie up to "
        f"{farthest:,.0f} from the others; keep them in sets of their own"
    ]


def _of_size(surfels: Surfels) -> list[str]:
    low, high = (end(surfels.positions, axis=0).astype(np.float64) for end in (np.min, np.max))
    extent = float((high - low).max())
    if len(surfels) < _FEWEST or not extent > 0:
        return []
    if surfels.largest < _TINY * extent:
        return [
            f"The largest of {len(surfels):,} surfels has a half-axis of {surfels.largest:.3g}, which is too small to "
            f"be seen beside their extent of {extent:.3g}"
        ]
    middle = float(np.median(surfels.scales.min(axis=1)))
    if middle > _HUGE * extent:
        return [
            f"Half of {len(surfels):,} surfels have half-axes above {middle:.3g}, more than the extent of all, "
            f"{extent:.3g}"
        ]
    return []


def _of_place(surfels: Surfels) -> list[str]:
    low, high = surfels.local_bounds
    if max(np.abs(surfels.origin + low).max(), np.abs(surfels.origin + high).max()) <= _FARTHEST:
        return []
    with np.errstate(over="ignore"):
        far = (np.abs(surfels.positions + surfels.origin) > _FARTHEST).any(axis=1)
    count = int(np.count_nonzero(far))
    return (
        [f"{count:,} of {len(surfels):,} surfels lie beyond {_FARTHEST:g}, where nothing can be drawn"] if count else []
    )
