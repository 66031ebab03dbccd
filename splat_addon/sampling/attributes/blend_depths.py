# SPDX-License-Identifier: GPL-3.0-or-later
"""How deep a splat blends with others: as far as splats of its own surface lie off its plane, and no farther.

Where a surface is flat that is next to nothing, and what lies closely behind it does not shine through. Where triangles
turn against their neighbours by an angle b, a splat of radius R that is small beside a triangle of size l and reaches
over its edge is b R / 4 off on the average; one that reaches over many triangles follows the curvature b / l, which is
b R^2 / l over its radius.
"""

from __future__ import annotations

import numpy as np

from ..mesh.triangle_mesh import TriangleMesh, corner_indices, corners_at, doubled_areas

#: In radii: below this, rounding would decide which of two splats of one plane is seen.
LEAST_BLENDING = 0.05

#: Of a bend, the least that counts: over one edge of a large triangle.
_OVER_ONE = 0.25


def blending_per_radius(mesh: TriangleMesh, bends: np.ndarray) -> np.ndarray:
    """(T, 2) what `blend_depths` needs of each triangle: its bend, radians, and its size, object units.

    bends: (T,), as `EdgeSurvey` has them.
    """
    corners = corners_at(np.ascontiguousarray(mesh.positions.T), corner_indices(mesh.triangles))
    areas = np.linalg.norm(doubled_areas(corners), axis=0)
    return np.stack([bends, np.sqrt(areas)], axis=1)


def blend_depths(triangles: np.ndarray, radii: np.ndarray) -> np.ndarray:
    """(t,) float32, in radii. triangles: (t, 2) of `blending_per_radius`. radii: (t,) of their splats."""
    bends, sizes = triangles.T
    reach = np.maximum(radii / np.maximum(sizes, 1e-300), _OVER_ONE)
    return np.clip(bends * reach, LEAST_BLENDING, 1).astype(np.float32)
