# SPDX-License-Identifier: GPL-3.0-or-later
"""The numpy twin of shaders/methods/sprites_printed.glsl: equations 1 and 4 as the paper has them."""

from __future__ import annotations

import numpy as np

from . import sprites
from .plane import Plane


def samples(plane: Plane, points: np.ndarray, pixel: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(M,) weights and (M,) depths at (M, 2) picture points (Botsch and Kobbelt 2003, equations 1 to 4)."""
    return sprites.samples(plane, points, pixel, as_printed=True)
