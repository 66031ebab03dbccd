# SPDX-License-Identifier: GPL-3.0-or-later
"""What a render gives back."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

#: Depth where nothing was hit, as Cycles writes it.
EMPTY_DEPTH = 1e10


@dataclass(frozen=True, eq=False)
class Frame:
    """float32 arrays, row 0 at the bottom; None where `Settings.outputs` left one out.

    color: (h, w, 4) scene-linear, premultiplied.
    depth: (h, w) distance along the camera's -Z, world units, of the nearest sample in the pixel;
        `EMPTY_DEPTH` where nothing was hit.
    normal: (h, w, 3) world-space shading normal turned to the viewer, averaged over the pixel's samples,
        empty ones counting as 0.
    coverage: (h, w) share of the pixel's samples that hit a splat.
    stats: what was drawn, and milliseconds by pass where `Settings.profile` asked for them.
    """

    color: np.ndarray | None
    depth: np.ndarray | None
    normal: np.ndarray | None
    coverage: np.ndarray | None
    stats: dict = field(default_factory=dict)
