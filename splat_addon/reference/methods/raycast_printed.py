# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twin of shaders/methods/raycast_printed.glsl: ray casting within the paper's square."""

from __future__ import annotations

import numpy as np

from . import raycast
from .plane import Plane, places


def samples(plane: Plane, points: np.ndarray, pixel: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(M,) weights and (M,) depths at (M, 2) picture points (Botsch et al. 2005, sections 3 and 5)."""
    weights, _ = raycast.samples(plane, points, pixel)
    at, half_square = places(plane, points), max(plane.radius * plane.scale / pixel.min(), 1)
    is_drawn = ((abs(at.d) / pixel).max(axis=1) <= half_square) & (at.k > 0)
    with np.errstate(invalid="ignore", over="ignore"):
        return np.where(is_drawn, weights, 0.0), plane.depth + at.uv @ plane.slope
