# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twin of shaders/methods/quad.glsl: object-space surfel quads without a low-pass filter."""

from __future__ import annotations

import numpy as np

from .plane import Plane, places


def samples(plane: Plane, points: np.ndarray, pixel: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(M,) weights, a Gaussian of sigma 1/2 cut at the ellipse, and (M,) depths, at (M, 2) picture points."""
    at = places(plane, points)
    rho2 = np.einsum("ij,ij->i", at.uv, at.uv)
    with np.errstate(invalid="ignore", over="ignore"):
        weights = np.where((rho2 <= 1) & (at.k > 0), np.exp(-2 * rho2), 0.0)
    return weights, plane.depth + at.uv @ plane.slope
