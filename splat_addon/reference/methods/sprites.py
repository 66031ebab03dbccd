# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twin of shaders/methods/sprites.glsl: discs in point sprites."""

from __future__ import annotations

import numpy as np

from .plane import Plane

LEAST_COSINE = 0.1


def samples(
    plane: Plane, points: np.ndarray, pixel: np.ndarray, as_printed: bool = False
) -> tuple[np.ndarray, np.ndarray]:
    """(M,) weights and (M,) depths at (M, 2) picture points (Botsch and Kobbelt 2003, equations 1 to 4).

    as_printed: the square's side is one radius by equation 1, and the offset of equation 2, which is in radii and
    towards the viewer, is added to the distance as it is.
    """
    normal = plane.normal / np.linalg.norm(plane.normal)
    normal = normal if normal[2] >= 0 else -normal
    q = (points - plane.center) / ((0.5 if as_printed else 1.0) * plane.radius * plane.scale)
    offset = -(q @ normal[:2]) / max(normal[2], LEAST_COSINE)
    rho2 = (q * q).sum(axis=1) + offset**2
    depths = plane.depth + (offset if as_printed else -plane.radius * offset)
    return np.where(rho2 <= 1, np.exp(-2 * rho2), 0.0), depths


def window_depth(depth: np.ndarray, near: float, far: float, as_printed: bool = False) -> np.ndarray:
    """The window depth of a distance from the eye, 0 at `near` and 1 at `far` (Botsch and Kobbelt 2003, equation 4).

    as_printed: with b twice as large, so that everything nearer than about 2 near gets a negative depth.
    """
    a, b = far / (far - near), -(2 if as_printed else 1) * far * near / (far - near)
    return (a * depth + b) / depth
