# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twin of shaders/methods/ewa_object.glsl: kernel and pixel joined in the splat's plane."""

from __future__ import annotations

import numpy as np

from .plane import Plane, places, plane_depth

KERNEL_VARIANCE = 0.25
FILTER_VARIANCE = 0.5
#: Minimum ratio of the squared half-axes in the picture; splats at more grazing angles are not widened.
LEAST_FLATNESS2 = 0.004
#: Share of the splat's depth: what is enlarged nearer to the eye's plane is not drawn.
LEAST_DEPTH = 1e-3


def samples(
    plane: Plane, points: np.ndarray, pixel: np.ndarray, variance: float = FILTER_VARIANCE
) -> tuple[np.ndarray, np.ndarray]:
    """(M,) weights and (M,) depths at (M, 2) picture points (Ren et al. 2002; view-independent paper, equation 10).

    variance: of the pixel's Gaussian, square pixels.
    """
    at = places(plane, points)
    _, lengths, along = np.linalg.svd(np.stack([plane.a, plane.b], axis=1) / pixel[:, None])
    amplitude = np.prod(KERNEL_VARIANCE**0.5 * lengths / np.sqrt(KERNEL_VARIANCE * lengths**2 + variance))
    lengths2 = np.maximum(lengths**2, [0, LEAST_FLATNESS2 * lengths[0] ** 2])
    half_axes = 2 * np.sqrt(KERNEL_VARIANCE + variance / np.maximum(lengths2, 1e-30))
    with np.errstate(invalid="ignore", over="ignore"):
        rho2 = ((at.uv @ along.T / half_axes) ** 2).sum(axis=1)
        weights = np.where((rho2 <= 1) & (at.k > LEAST_DEPTH), amplitude * np.exp(-2 * rho2), 0.0)
        return weights, plane_depth(plane, at, pixel, variance**0.5)
