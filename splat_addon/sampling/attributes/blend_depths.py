# SPDX-License-Identifier: GPL-3.0-or-later
"""Blend depth of each splat: as far as splats of its own surface lie off its plane, and no farther.

On a flat surface this is close to 0, so a second surface just behind does not shine through. Where triangles meet at an
angle b, a splat of radius R that is small beside a triangle of size l and reaches over its edge is off by b R / 4 on
average; a splat that reaches over many triangles follows the curvature b / l, which puts it off by b R^2 / l.
"""

from __future__ import annotations

import numpy as np

#: In radii: with less than this, rounding would decide which of two coplanar splats is visible.
LEAST_BLENDING = 0.01

#: The least blend depth, in radii, of splats on a triangle that bends by more than `BENT` radians: splats beside them
#: may bend more.
LEAST_BENT, BENT = 0.05, 0.01

#: The smallest share of a bend that counts: the share for a splat over one edge of a large triangle.
_OVER_ONE = 0.25


def blend_depths(bends: np.ndarray, sizes: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """(t,) float32, in radii. bends, sizes: (t,) of triangles, as `EdgeSurvey` has them. radii: (t,) of splats."""
    reach = np.maximum(radii / np.maximum(sizes, 1e-37), _OVER_ONE)
    least = np.where(bends > BENT, LEAST_BENT, LEAST_BLENDING)
    return np.clip(bends * reach, least, 1).astype(np.float32)
