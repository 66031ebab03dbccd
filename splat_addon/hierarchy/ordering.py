# SPDX-License-Identifier: GPL-3.0-or-later
"""Orders places along a Morton curve, so that neighbours come close together."""

from __future__ import annotations

import numpy as np

from ..runs import sorted_with_order

#: Bits of a number that is sorted.
BITS = 63
#: Bits of each coordinate in the order along which neighbours are gathered.
ORDER_BITS = 16
#: Places that are worked on at a time, so that they stay in the processor's cache.
_PORTION = 1 << 15


def spatial_order(positions: np.ndarray) -> np.ndarray:
    """(N,) indices that order (N, 3) positions along a Morton curve through their box.

    Neighbours come close together; positions in the same cell keep their order.
    """
    if not len(positions):
        return np.zeros(0, int)
    low, high = positions.min(axis=0).astype(np.float64), positions.max(axis=0).astype(np.float64)
    # so many that cells are a fraction of the distance between neighbours, and keys are sorted fast
    bits = min(ORDER_BITS, (BITS - max(len(positions) - 1, 1).bit_length()) // 3)
    return sorted_with_order(morton_codes(positions, low, high, bits), 1 << 3 * bits)[0]


def morton_codes(positions: np.ndarray, low: np.ndarray, high: np.ndarray, bits: int = ORDER_BITS) -> np.ndarray:
    """(N,) int64 places of (N, 3) positions along a Morton curve through the box from `low` to `high`.

    bits: of each coordinate, at most `ORDER_BITS`.
    """
    size = max((high - low).max(), 1e-300)
    codes = np.empty(len(positions), np.int64)
    for start in range(0, len(positions), _PORTION):
        some = slice(start, start + _PORTION)
        shares = (positions[some] - low) / size
        cells = np.minimum(shares * 2**bits, 2**bits - 1).astype(np.int64)
        x, y, z = (_spread(np.ascontiguousarray(cells[:, axis])) for axis in range(3))
        codes[some] = x | y << 1 | z << 2
    return codes


def _spread(bits: np.ndarray) -> np.ndarray:
    """16-bit numbers with two zeros after each bit."""
    for shift, mask in ((16, 0x0000FF0000FF), (8, 0x00F00F00F00F), (4, 0x0C30C30C30C3), (2, 0x249249249249)):
        bits = (bits | bits << shift) & mask
    return bits
