# SPDX-License-Identifier: GPL-3.0-or-later
"""What the figures of several papers share: settings, and how a splat's weight is shown."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from splat_addon.rendering import Settings

FLAT = Settings(supersampling=1, shading="flat", outputs=("color",), detail_tolerance=0.0, as_printed=True)
LIT = replace(FLAT, shading="phong", shadow_resolution=0)
UNFILTERED, FILTERED = (replace(LIT, method=name, lights_splats=True) for name in ("sprites_unfiltered", "sprites"))

Draw = Callable[..., np.ndarray]


def in_steps(weights: np.ndarray) -> np.ndarray:
    """(h, w) weights -> (h, w, 3), in steps of an eighth of the largest."""
    return np.repeat(1 - np.ceil(8 * weights / weights.max())[..., None] / 8, 3, axis=2) ** 2.2
