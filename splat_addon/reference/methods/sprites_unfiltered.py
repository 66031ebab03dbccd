# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twin of shaders/methods/sprites_unfiltered.glsl: discs in sprites; only the nearest one is visible."""

from __future__ import annotations

import numpy as np

from . import sprites
from .plane import Plane


def samples(plane: Plane, points: np.ndarray, pixel: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(M,) weights, 1 in the disc, and (M,) depths, the centre's (Botsch and Kobbelt 2003, sections 3.1 and 3.2)."""
    weights, _ = sprites.samples(plane, points, pixel)
    return (weights > 0).astype(np.float64), np.full(len(points), plane.depth)
