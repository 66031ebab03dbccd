# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twin of shaders/methods/sprites.glsl: discs in point sprites."""

from __future__ import annotations

import numpy as np

from .plane import Plane

LEAST_COSINE = 0.1


def samples(plane: Plane, points: np.ndarray, pixel: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(M,) weights and (M,) depths at (M, 2) picture points (Botsch and Kobbelt 2003, equations 1 to 3)."""
    normal = plane.normal / np.linalg.norm(plane.normal)
    normal = normal if normal[2] >= 0 else -normal
    q = (points - plane.center) / (plane.radius * plane.scale)
    offset = -(q @ normal[:2]) / max(normal[2], LEAST_COSINE)
    rho2 = (q * q).sum(axis=1) + offset**2
    return np.where(rho2 <= 1, np.exp(-2 * rho2), 0.0), plane.depth - plane.radius * offset
