# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twin of shaders/methods/ewa.glsl: screen-space affine EWA with amplitude compensation."""

from __future__ import annotations

import numpy as np

from .plane import Plane, places, plane_depth

KERNEL_VARIANCE = 0.25
FILTER_SIGMA = 0.5**0.5


def samples(plane: Plane, points: np.ndarray, pixel: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(M,) weights and (M,) depths at (M, 2) picture points (Zwicker et al. 2001, equations 9 to 12)."""
    at = places(plane, points)
    j = np.stack([plane.a, plane.b], axis=1) / pixel[:, None]
    variance = KERNEL_VARIANCE * j @ j.T + FILTER_SIGMA**2 * np.eye(2)
    pixels = at.d / pixel
    rho2 = KERNEL_VARIANCE * np.einsum("ni,ij,nj->n", pixels, np.linalg.inv(variance), pixels)
    amplitude = abs(KERNEL_VARIANCE * np.linalg.det(j)) / np.sqrt(np.linalg.det(variance))
    return np.where(rho2 <= 1, amplitude * np.exp(-2 * rho2), 0.0), plane_depth(plane, at, pixel, FILTER_SIGMA)
