# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twin of shaders/methods/quad.glsl: object-space surfel quads without a low-pass filter."""

from __future__ import annotations

import numpy as np


def footprint_corner(position: np.ndarray, axis_u: np.ndarray, axis_v: np.ndarray, corner: np.ndarray) -> np.ndarray:
    """(..., 3) corner of the quad. position, axes: (..., 3), corner: (..., 2) of -1 or 1."""
    return position + axis_u * corner[..., :1] + axis_v * corner[..., 1:]


def kernel_weight(place: np.ndarray) -> np.ndarray:
    """(...,) Gaussian of sigma 1/2 at (..., 2) places in units of the half-axes; 0 outside the ellipse."""
    rho2 = np.einsum("...i,...i->...", place, place)
    with np.errstate(invalid="ignore"):
        return np.where(rho2 <= 1.0, np.exp(-2.0 * rho2), 0.0)
