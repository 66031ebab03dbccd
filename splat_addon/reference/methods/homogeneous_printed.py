# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twin of shaders/methods/homogeneous_printed.glsl: the formulas as the paper has them."""

from __future__ import annotations

import numpy as np

from . import quad
from .homogeneous import adjusted, is_parallel
from .plane import Plane


def samples(plane: Plane, points: np.ndarray, pixel: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(M,) weights and (M,) depths at (M, 2) picture points (Guennebaud et al. 2006, equations 4 to 10)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        if is_parallel(plane):
            return quad.samples(adjusted(plane, pixel, as_printed=True), points, pixel)
        u, v, w, _ = window_map(adjusted(plane, pixel, as_printed=True)) @ np.c_[points, np.ones(len(points))].T
        rho2 = (u * u + v * v) / (w * w)
        return np.where((rho2 <= 1) & (w > 0), np.exp(-2 * rho2), 0.0), 1 / w


def window_map(plane: Plane, a: float = 0.0, b: float = 1.0) -> np.ndarray:
    """(4, 3) from (x, y, 1) in the picture to (u w, v w, w) with w = b / depth, and to a + w: the depth in the window
    of a perspective view that has it so (Guennebaud et al. 2006, equations 6 and 7).
    """
    p = plane.depth * np.array([*plane.center, 1.0])
    s, t = (
        plane.depth * np.array([*(moved + plane.center * change), change])
        for moved, change in zip((plane.a, plane.b), plane.gh, strict=True)
    )
    adjoint = np.stack([np.cross(t, p), np.cross(p, s), np.cross(s, t)])
    scaled = b / (adjoint[2] @ p) * adjoint
    return np.vstack([scaled, scaled[2] + (0, 0, a)])
