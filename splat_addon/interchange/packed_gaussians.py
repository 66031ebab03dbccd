# SPDX-License-Identifier: GPL-3.0-or-later
"""Unpacks the compressed PLY of SuperSplat and PlayCanvas: Gaussians as four integers of 32 bits.

| property | bits, from the highest | meaning |
|---|---|---|
| packed_position | 11, 10, 11 | x y z, from `min_x` to `max_x` ... |
| packed_scale | 11, 10, 11 | logarithms of sigma, from `min_scale_x` to `max_scale_x` ... |
| packed_rotation | 2, 10, 10, 10 | which of w x y z is the largest; the others in order, from -sqrt(1/2) to sqrt(1/2) |
| packed_color | 8, 8, 8, 8 | display red, green, blue, from `min_r` to `max_r` ... (or 0 to 1), and opacity |

Each 256 share the bounds that a row of the element `chunk` has; the element `sh` has what changes with the view.
"""

from __future__ import annotations

import numpy as np

from .columns import ROTATION, as_columns, has, matrix
from .gaussian_forms import COLOR, OPACITY, SCALE
from .gaussians import SH_DEGREE_0

_PACKED = ("packed_position", "packed_rotation", "packed_scale", "packed_color")
_PER_CHUNK = 256
CHUNK, HARMONICS = "chunk", "sh"

#: The logarithm of odds that stands for an opacity of 1, and negative for 0.
_SURE = 40.0


def is_packed(columns: dict[str, np.ndarray]) -> bool:
    """Whether the columns of the points are the four of the table."""
    return has(columns, _PACKED)


def unpacked(columns: dict[str, np.ndarray], chunks: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The columns of ordinary Gaussians. chunks: the columns of the element `chunk`. Raises ValueError if these are too
    few or lack a bound."""
    count = len(columns[_PACKED[0]])
    bounds = [_bounds(chunks, prefix, "xyz", count) for prefix in ("", "scale_")]
    colors = _bounds(chunks, "", "rgb", count) if "min_r" in chunks else (0.0, 1.0)
    shown = _fractions(columns[_PACKED[3]], (8, 8, 8, 8))
    # bounds that are not finite make numbers that are not, which are counted as such
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        positions, scales = (
            low + (high - low) * _fractions(columns[name], (11, 10, 11))
            for name, (low, high) in zip((_PACKED[0], _PACKED[2]), bounds, strict=True)
        )
        low, high = colors
        harmonics = (low + (high - low) * shown[:, :3] - 0.5) / SH_DEGREE_0
        odds = np.clip(np.log(shown[:, 3] / (1 - shown[:, 3])), -_SURE, _SURE)
    return {
        **as_columns(("x", "y", "z"), positions),
        **as_columns(SCALE, scales),
        **as_columns(ROTATION, _quaternions(columns[_PACKED[1]])),
        **as_columns(COLOR, harmonics),
        OPACITY[0]: odds,
    }


def _bounds(chunks: dict[str, np.ndarray], prefix: str, axes: str, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Two (count, 3) float64 bounds of each Gaussian."""
    ends = [tuple(f"{end}_{prefix}{axis}" for axis in axes) for end in ("min", "max")]
    if not has(chunks, *ends) or len(chunks[ends[0][0]]) * _PER_CHUNK < count:
        raise ValueError(
            f"The PLY file is compressed, but its element 'chunk' lacks {ends[0][0]!r} and others, or is too short for "
            f"{count:,} points; it is damaged."
        )
    chunk = np.arange(count) // _PER_CHUNK
    low, high = (matrix(chunks, names, np.float64)[chunk] for names in ends)
    return low, high


def _fractions(packed: np.ndarray, bits: tuple[int, ...]) -> np.ndarray:
    """(N, fields) float64 from 0 to 1. bits: the width of each field, from the highest bits down."""
    values, low = packed.astype(np.uint32), sum(bits)
    fields = []
    for width in bits:
        low -= width
        most = (1 << width) - 1
        fields.append((values >> np.uint32(low) & np.uint32(most)) / most)
    return np.stack(fields, axis=1)


def _quaternions(packed: np.ndarray) -> np.ndarray:
    """(N, 4) unit quaternions w x y z."""
    largest = (packed.astype(np.uint32) >> np.uint32(30)).astype(np.intp)
    others = (_fractions(packed, (10, 10, 10)) - 0.5) * np.sqrt(2)
    made = np.empty((len(packed), 4))
    rows = np.arange(len(packed))
    made[rows, largest] = np.sqrt(np.maximum(1 - (others**2).sum(axis=1), 0))
    for place in range(3):
        made[rows, place + (place >= largest)] = others[:, place]
    return made
