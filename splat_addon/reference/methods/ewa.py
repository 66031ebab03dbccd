# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twin of shaders/methods/ewa.glsl: EWA in the picture with amplitude compensation."""

from __future__ import annotations

from functools import partial

import numpy as np

from .plane import Plane, in_footprint, places, plane_depth

KERNEL_VARIANCE = 0.25
FILTER_VARIANCE = 0.5


def samples(
    plane: Plane, points: np.ndarray, pixel: np.ndarray, variance: float = FILTER_VARIANCE
) -> tuple[np.ndarray, np.ndarray]:
    """(M,) weights and (M,) depths at (M, 2) picture points (Zwicker et al. 2001, equations 9 to 12).

    variance: of the pixel's Gaussian, square pixels.
    """
    at = places(plane, points)
    j = np.stack([plane.a, plane.b], axis=1) / pixel[:, None]
    pixels = at.d / pixel
    area = KERNEL_VARIANCE * (j[0, 0] * j[1, 1] - j[0, 1] * j[1, 0])
    det = area**2 + variance * (KERNEL_VARIANCE * (j * j).sum() + variance)
    across = pixels @ np.array([j[1], -j[0]])
    squares = variance * (pixels**2).sum(axis=1) + KERNEL_VARIANCE * (across**2).sum(axis=1)
    rho2 = KERNEL_VARIANCE / det * squares
    amplitude = abs(area) / np.sqrt(det)
    is_inside = (rho2 <= 1) & in_footprint(plane, points, pixel, partial(_footprint, variance))
    return np.where(is_inside, amplitude * np.exp(-2 * rho2), 0.0), plane_depth(plane, at, pixel, variance**0.5)


def _footprint(variance: float, size: np.ndarray) -> np.ndarray:
    """Half-axes in pixels, a little longer than those of kernel and filter; the affine ellipse of a near splat can be
    far larger.
    """
    return 1.1 * np.sqrt(size**2 + 4 * variance)
