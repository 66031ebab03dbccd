# SPDX-License-Identifier: GPL-3.0-or-later
"""Sampling density: the spacing that each way to specify it results in, and the number of surfels.

This runs before `grid`. `camera_density` converts a density in pixels of a camera to a spacing.
"""

from __future__ import annotations

import math

import numpy as np

from .ldc.grid import longest_edge
from .ldc.reductions import projected_area
from .mesh.cleaning import drop_unusable
from .mesh.survey import signed_volumes
from .mesh.triangle_mesh import TriangleMesh, corner_indices, corners_at, doubled_areas
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


def mean_width(mesh: TriangleMesh) -> float:
    """Four times the volume of a mesh by its area, object units: the diameter of a long cylinder, and twice the
    thickness of a plate. Of an open mesh, the volume between it and the mean of its corners counts, which is two thirds
    of a tube's and 0 for a flat sheet. A mesh without area has no width.
    """
    if not len(mesh):
        return 0.0
    positions = mesh.positions - mesh.positions[mesh.triangles.ravel()].mean(axis=0)
    doubled = doubled_areas(corners_at(positions.T, corner_indices(mesh.triangles)))
    area = float(np.sqrt((doubled * doubled).sum(axis=0)).sum()) / 2
    return 4 * abs(float(signed_volumes(positions, mesh.triangles).sum())) / 6 / area if area else 0.0


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
