# SPDX-License-Identifier: GPL-3.0-or-later
"""How deep a splat blends with others: as far as splats of its own surface lie off its plane, and no farther.

Where a surface is flat that is next to nothing, and what lies closely behind it does not shine through. Where triangles
turn against their neighbours by an angle b, a splat of radius R that is small beside a triangle of size l and reaches
over its edge is b R / 4 off on the average; one that reaches over many triangles follows the curvature b / l, which is
b R^2 / l over its radius.
"""

from __future__ import annotations

import numpy as np

#: In radii: below this, rounding would decide which of two splats of one plane is seen.
LEAST_BLENDING = 0.05

#: Of a bend, the least that counts: over one edge of a large triangle.
_OVER_ONE = 0.25


def blend_depths(bends: np.ndarray, sizes: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """(t,) float32, in radii. bends, sizes: (t,) of triangles, as `EdgeSurvey` has them. radii: (t,) of splats."""
    reach = np.maximum(radii / np.maximum(sizes, 1e-37), _OVER_ONE)
    return np.clip(bends * reach, LEAST_BLENDING, 1).astype(np.float32)
