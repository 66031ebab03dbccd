# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twin of shaders/methods/raycast.glsl: ray casting with the union of kernel and low-pass."""

from __future__ import annotations

import numpy as np

from .plane import Plane, places, plane_depth

#: How far from the depths of the ellipse what the low-pass adds may be, in radii.
OVER_RIM = 0.25


def samples(plane: Plane, points: np.ndarray, pixel: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(M,) weights and (M,) depths at (M, 2) picture points (Botsch et al. 2005, sections 3 and 5)."""
    at = places(plane, points)
    with np.errstate(invalid="ignore", over="ignore"):
        inside = np.einsum("ij,ij->i", at.uv, at.uv)
        is_inside = (inside <= 1) & (at.k > 0)
        rho2 = np.minimum(np.where(is_inside, inside, 2.0), ((at.d / pixel) ** 2).sum(axis=1) / 2)
        depth = plane_depth(plane, at, pixel, 0.5**0.5, OVER_RIM)
    return np.where(rho2 <= 1, np.exp(-2 * rho2), 0.0), depth
