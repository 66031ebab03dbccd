# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twin of shaders/methods/homogeneous_printed.glsl: the formulas as the paper has them."""

from __future__ import annotations

import numpy as np

from . import homogeneous
from .plane import Plane


def samples(plane: Plane, points: np.ndarray, pixel: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(M,) weights and (M,) depths at (M, 2) picture points (Guennebaud et al. 2006, equations 8 to 10)."""
    return homogeneous.samples(plane, points, pixel, as_printed=True)
