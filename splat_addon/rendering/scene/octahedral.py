# SPDX-License-Identifier: GPL-3.0-or-later
"""The octahedral map of all directions to a square, with a border of one texel for interpolation: beyond an edge lies
what is beside its other half (Meyer et al. 2010, "On Floating-Point Normal Vectors")."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np


def octahedral_directions(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """(..., 3) unit directions of places in the map, from -1 to 1; those beyond its edges are folded back."""
    x, y = np.array(x, np.float64), np.array(y, np.float64)
    for a, b in ((x, y), (y, x)):
        beyond = np.abs(a) > 1
        a[beyond] = np.sign(a[beyond]) * 2 - a[beyond]
        b[beyond] = -b[beyond]
    z = 1 - np.abs(x) - np.abs(y)
    fold = np.maximum(-z, 0)
    x, y = x - np.where(x >= 0, fold, -fold), y - np.where(y >= 0, fold, -fold)
    directions = np.stack([x, y, z], axis=-1)
    return directions / np.linalg.norm(directions, axis=-1, keepdims=True)


@dataclass(frozen=True)
class Octahedral:
    """A panorama's projection: the map of `side` texels along an edge, and its border. Directions are those of the
    camera's own axes."""

    side: int

    def directions(self, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        places = (((place * (self.side + 2) - 1) / self.side) * 2 - 1 for place in (u, v))
        return octahedral_directions(*np.broadcast_arrays(*places))

    def angles(self) -> tuple[float, float]:
        """So that a pixel is as large as the mean of them."""
        across = math.sqrt(4 * math.pi) * (self.side + 2) / self.side
        return across, across


def bordered(inner: np.ndarray) -> np.ndarray:
    """(n + 2, n + 2, c) a map (n, n, c) with its border."""
    made = np.empty((inner.shape[0] + 2, inner.shape[1] + 2, *inner.shape[2:]), inner.dtype)
    made[1:-1, 1:-1] = inner
    made[0, 1:-1], made[-1, 1:-1] = inner[0, ::-1], inner[-1, ::-1]
    made[1:-1, 0], made[1:-1, -1] = inner[::-1, 0], inner[::-1, -1]
    made[0, 0], made[0, -1], made[-1, 0], made[-1, -1] = inner[-1, -1], inner[-1, 0], inner[0, -1], inner[0, 0]
    return made
