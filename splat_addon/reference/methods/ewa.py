# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twin of shaders/methods/ewa.glsl: EWA in the picture with amplitude compensation."""

from __future__ import annotations

import numpy as np

from .plane import Plane, in_footprint, places, plane_depth

KERNEL_VARIANCE = 0.25
FILTER_SIGMA = 0.5**0.5


def samples(plane: Plane, points: np.ndarray, pixel: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(M,) weights and (M,) depths at (M, 2) picture points (Zwicker et al. 2001, equations 9 to 12)."""
    at = places(plane, points)
    j = np.stack([plane.a, plane.b], axis=1) / pixel[:, None]
    pixels = at.d / pixel
    area = KERNEL_VARIANCE * (j[0, 0] * j[1, 1] - j[0, 1] * j[1, 0])
    det = area**2 + FILTER_SIGMA**2 * (KERNEL_VARIANCE * (j * j).sum() + FILTER_SIGMA**2)
    across = pixels @ np.array([j[1], -j[0]])
    squares = FILTER_SIGMA**2 * (pixels**2).sum(axis=1) + KERNEL_VARIANCE * (across**2).sum(axis=1)
    rho2 = KERNEL_VARIANCE / det * squares
    amplitude = abs(area) / np.sqrt(det)
    is_inside = (rho2 <= 1) & in_footprint(plane, points, pixel, _footprint)
    return np.where(is_inside, amplitude * np.exp(-2 * rho2), 0.0), plane_depth(plane, at, pixel, FILTER_SIGMA)


def _footprint(size: np.ndarray) -> np.ndarray:
    """Half-axes in pixels, a little longer than those of kernel and filter; the affine ellipse of a near splat can be
    far larger.
    """
    return 1.1 * np.sqrt(size**2 + (2 * FILTER_SIGMA) ** 2)
