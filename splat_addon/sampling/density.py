# SPDX-License-Identifier: GPL-3.0-or-later
"""Sampling density: the spacing that each way to specify it results in, and the number of surfels.

This runs before `grid`. `camera_density` converts a density in pixels of a camera to a spacing.
"""

from __future__ import annotations

import math

from .ldc.grid import longest_edge
from .ldc.reductions import projected_area
from .mesh.cleaning import drop_unusable
from .mesh.triangle_mesh import TriangleMesh
from .options import Density


def grid_spacing(mesh: TriangleMesh, **density) -> float:
    """Cell size H, object units. density: the fields of `Density`."""
    return spacing_of(mesh, Density(**density))


def spacing_of(mesh: TriangleMesh, density: Density) -> float:
    """Cell size H, object units.

    It is the spacing itself, the longest edge of the usable triangles' box divided by the resolution, or
    sqrt(projected area / count).

    Raises ValueError with one sentence for a resolution or count of a mesh without usable triangles.
    """
    if density.spacing is not None:
        return float(density.spacing)
    mesh, _ = drop_unusable(mesh)
    if not len(mesh):
        what = "resolution" if density.count is None else "count"
        raise ValueError(f"A {what} means nothing for a mesh without usable triangles; give a spacing instead.")
    if density.count is not None:
        return math.sqrt(projected_area(mesh, density.reduction, density.grazing_angle) / density.count)
    return longest_edge(mesh) / density.resolution


def predict_count(mesh: TriangleMesh, **density) -> int:
    """The number of surfels that `sample_mesh` will make, computed from areas alone; 0 for a mesh without usable
    triangles. density: the fields of `Density`.

    3-to-1 makes fewer where sheets lie closer than a cell. Each part that no ray hits adds one surfel. A tolerance
    makes fewer: `flat_extents` tells how many fewer inside flat faces.
    """
    given = Density(**density)
    mesh, _ = drop_unusable(mesh)
    if not len(mesh):
        return 0
    return round(projected_area(mesh, given.reduction, given.grazing_angle) / spacing_of(mesh, given) ** 2)
