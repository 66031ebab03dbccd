# SPDX-License-Identifier: GPL-3.0-or-later
"""Linear colours in other primaries. It sits just above `surfels`, because both streaming and Blender convert them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .surfels import Surfels


def converted(colors: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """(..., 3) or (..., 4) colours with a (3, 3) matrix applied, in their own type; alpha stays. For the identity, the
    same array."""
    if np.array_equal(matrix, np.eye(3)):
        return colors
    result, most = np.array(colors), np.finfo(colors.dtype).max
    # a colour at the end of the range stays there
    result[..., :3] = np.clip(colors[..., :3].astype(np.float64) @ matrix.T, -most, most)
    return result


def recolored(surfels: Surfels, matrix: np.ndarray) -> Surfels:
    """The surfels with their colours and emission converted; for the identity, the same object."""
    if np.array_equal(matrix, np.eye(3)):
        return surfels
    emission = None if surfels.emission is None else converted(surfels.emission, matrix)
    return replace(surfels, colors=converted(surfels.colors, matrix), emission=emission)
