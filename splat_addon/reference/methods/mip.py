# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twin of shaders/methods/mip.glsl: the pixel's Gaussian taken into the splat's plane."""

from __future__ import annotations

from functools import partial

import numpy as np

from .plane import Plane, gradients, in_footprint, places, plane_depth

KERNEL_VARIANCE = 0.25
FILTER_VARIANCE = 0.5
#: 0.5 - x (a + b x^2 + ...) is within 7e-4 of a normal distribution's share beyond x, from -NORMAL_END on.
NORMAL = 0.396668, -0.0613809, 0.00673240, -0.000320832
NORMAL_END = 2.6
#: Standard deviations beyond the rim at which nothing counts: a pixel of the filter's.
RIM_END = 1.4
#: In half-axes of the ellipse that the triangle is around.
FOOTPRINT_END = 1.5


def samples(
    plane: Plane, points: np.ndarray, pixel: np.ndarray, variance: float = FILTER_VARIANCE
) -> tuple[np.ndarray, np.ndarray]:
    """(M,) weights and (M,) depths at (M, 2) picture points; pixel: (2,) its size in the picture. variance: of
    its Gaussian, square pixels.

    Sigma = kernel + filter J J^T (Zwicker et al. 2001, in object space); the amplitude keeps the integral,
    and the rim is blurred as the filter blurs it.
    """
    at = places(plane, points)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        j = gradients(plane, at, pixel)
        # det J and q x J, multiplied out: edge-on, the differences that they stand for have no digits left.
        scale = at.k / at.det
        spread = variance * at.k * scale * pixel.prod()
        across = scale[:, None] * pixel * at.d[:, ::-1]
        det = spread**2 + KERNEL_VARIANCE * (variance * (j * j).sum(axis=(1, 2)) + KERNEL_VARIANCE)
        squares = KERNEL_VARIANCE * (at.uv**2).sum(axis=1) + variance * (across**2).sum(axis=1)
        rho2 = KERNEL_VARIANCE / det * squares
        reach = np.maximum(np.linalg.norm(at.uv, axis=1), 1e-30)
        along = np.linalg.norm(np.einsum("ni,nij->nj", at.uv, j), axis=1) / reach * variance**0.5
        is_inside = (at.k > 0) & in_footprint(plane, points, pixel, partial(_footprint, variance), FOOTPRINT_END)
        within = _within_rim(reach, along)
        weights = np.where(is_inside, within * KERNEL_VARIANCE / np.sqrt(det) * np.exp(-2 * rho2), 0.0)
        return weights, plane_depth(plane, at, pixel, variance**0.5)


def _within_rim(reach: np.ndarray, along: np.ndarray) -> np.ndarray:
    """(M,) share, within the kernel's rim at 1, of kernel times pixel along the line from the centre.

    reach: (M,) distance of the pixel from the centre; along: (M,) standard deviation of its filter that way.
    """
    share = KERNEL_VARIANCE / (KERNEL_VARIANCE + along**2)
    deviation = np.maximum(np.sqrt(KERNEL_VARIANCE * (1 - share)), 1e-6)
    x = np.maximum((reach * share - 1) / deviation, -NORMAL_END)
    with np.errstate(over="ignore", invalid="ignore"):
        within = 0.5 - x * sum(factor * x ** (2 * power) for power, factor in enumerate(NORMAL))
    return np.where(x < RIM_END, within, 0.0)


def _footprint(variance: float, size: np.ndarray) -> np.ndarray:
    """Half-axes in pixels: joined with a filter of 1.25 pixels, and at least 0.75 of a pixel longer; of a filter wider
    than the default more."""
    wider = max(variance / FILTER_VARIANCE, 1) ** 0.5
    return np.maximum(np.sqrt(size**2 + (1.25 * wider) ** 2), size + 0.75 * wider)
