# SPDX-License-Identifier: GPL-3.0-or-later
"""What to take from the coordinates of a survey so that 32-bit numbers hold them, and which files it is taken from."""

from __future__ import annotations

import numpy as np

#: Steps of float32 that are too coarse, in distances between points, and how many points a scan is taken to have at
#: least, so that a few of its points get the offset that all of them get.
_COARSE, _FEWEST = 1e-3, 10_000

#: Points that are looked at, and the share of them at each end that may be strays.
_SAMPLE, _STRAYS = 10_000, 0.02


def offset_for(positions: np.ndarray) -> np.ndarray:
    """(3,) whole numbers to take from (N, 3) float64 positions; 0 where float32 holds them without.

    They are multiples of the power of ten that is next above the extent, so that people recognise them.
    """
    sample = _sample(positions)
    low, high = np.quantile(sample, (_STRAYS, 1 - _STRAYS), axis=0) if len(sample) else np.zeros((2, 3))
    extent, farthest = float((high - low).max()), float(np.abs([low, high]).max())
    with np.errstate(over="ignore", invalid="ignore"):
        step = float(np.spacing(np.float32(farthest)))
    if not (np.isfinite(step) and extent > 0 and step > _COARSE * extent / np.sqrt(max(len(positions), _FEWEST))):
        return np.zeros(3)
    unit = 10.0 ** max(np.ceil(np.log10(extent)), 0)
    return np.rint((low + high) / 2 / unit) * unit


def needs_offset(offset: np.ndarray, middle: np.ndarray) -> bool:
    """Whether coordinates around (3,) `middle` are meant with an offset: they are nearer to it than to 0."""
    return bool(np.linalg.norm(middle - offset) < np.linalg.norm(middle))


def middle_of(positions: np.ndarray) -> np.ndarray:
    """(3,) float64 the median of some of (N, 3) positions; 0 without points."""
    sample = _sample(positions)
    return np.median(sample, axis=0) if len(sample) else np.zeros(3)


def _sample(positions: np.ndarray) -> np.ndarray:
    sample = positions[:: max(1, len(positions) // _SAMPLE)]
    return sample[np.isfinite(sample).all(axis=1)]
