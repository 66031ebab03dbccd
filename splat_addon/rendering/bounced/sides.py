# SPDX-License-Identifier: GPL-3.0-or-later
"""The six sides of a cube, by which surfaces are told apart: 2 for each axis, the first towards its positive end."""

from __future__ import annotations

import numpy as np

SIDES = 6


def side_of(vectors: np.ndarray) -> np.ndarray:
    """(n,) uint8 sides that (n, 3) vectors are nearest to: 2 for each axis, the first towards its positive end."""
    x, y, z = np.abs(vectors.T)
    is_x, is_y = (x >= y) & (x >= z), y >= z
    largest = np.where(is_x, np.uint8(0), np.where(is_y, np.uint8(1), np.uint8(2)))
    is_negative = vectors.T < 0
    return 2 * largest + np.where(is_x, is_negative[0], np.where(is_y, is_negative[1], is_negative[2]))


def facing_sides(directions: np.ndarray) -> np.ndarray:
    """(n, 3) for each axis the side that looks against (n, 3) directions."""
    return 2 * np.arange(3) + (directions > 0)
