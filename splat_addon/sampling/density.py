# SPDX-License-Identifier: GPL-3.0-or-later
"""Sampling density: the ways to specify it, and the spacing that each results in.

This runs before `grid`. `camera_density` converts a density in pixels of a camera to a spacing.
"""

from __future__ import annotations

import math

from .ldc.grid import longest_edge
from .ldc.reductions import DEFAULT_GRAZING_ANGLE, projected_area
from .mesh.cleaning import drop_unusable
from .mesh.triangle_mesh import TriangleMesh


def check_fineness(spacing: float | None = None, resolution: float | None = None, count: float | None = None):
    """Raise ValueError with one sentence unless exactly one option is given, and it is finite and above 0."""
    values = {"spacing": spacing, "resolution": resolution, "count": count}
    given = {name: value for name, value in values.items() if value is not None}
    if len(given) != 1:
        raise ValueError(f"Give one of spacing, resolution and count, not {' and '.join(given) or 'none of them'}.")
    for name, value in given.items():
        if not (math.isfinite(value) and value > 0):
            raise ValueError(f"The {name} must be a finite number above 0, not {value}.")


def grid_spacing(
    mesh: TriangleMesh,
    *,
    spacing: float | None = None,
    resolution: float | None = None,
    count: float | None = None,
    reduction: str = "normal",
    grazing_angle: float = DEFAULT_GRAZING_ANGLE,
) -> float:
    """Cell size H, object units, from exactly one of the three options.

    spacing: H itself. resolution: cells along the longest edge of the usable triangles' box.
    count: surfels that the reduction should leave; H = sqrt(projected area / count).
    Raises ValueError with one sentence if a value is not above 0, if not exactly one is given, and for a resolution or
    count of a mesh without usable triangles.
    """
    check_fineness(spacing, resolution, count)
    if spacing is not None:
        return float(spacing)
    mesh, _ = drop_unusable(mesh)
    if not len(mesh):
        what = "resolution" if count is None else "count"
        raise ValueError(f"A {what} means nothing for a mesh without usable triangles; give a spacing instead.")
    if count is not None:
        return math.sqrt(projected_area(mesh, reduction, grazing_angle) / count)
    return longest_edge(mesh) / resolution


def predict_count(
    mesh: TriangleMesh,
    *,
    spacing: float | None = None,
    resolution: float | None = None,
    count: float | None = None,
    reduction: str = "normal",
    grazing_angle: float = DEFAULT_GRAZING_ANGLE,
) -> int:
    """The number of surfels that `sample_mesh` will make, computed from areas alone; 0 for a mesh without usable
    triangles.

    3-to-1 makes fewer where sheets lie closer than a cell. Each part that no ray hits adds one surfel.
    """
    check_fineness(spacing, resolution, count)
    mesh, _ = drop_unusable(mesh)
    if not len(mesh):
        return 0
    how = {"reduction": reduction, "grazing_angle": grazing_angle}
    cell = grid_spacing(mesh, spacing=spacing, resolution=resolution, count=count, **how)
    return round(projected_area(mesh, **how) / cell**2)
