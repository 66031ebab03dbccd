# SPDX-License-Identifier: GPL-3.0-or-later
"""Which of the three layered depth images keep a triangle's samples.

A reduction sees only the triangle's normal, so what it refuses is never computed, and the number of
surfels follows from areas alone: N = sum over triangles of A sum over kept axes of |n_axis|, over H^2.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .cleaning import drop_unusable
from .grid import check_fineness, grid_spacing
from .mesh import TriangleMesh, doubled_areas, gather_corners, triangle_chunks


def keep_all(normals: np.ndarray) -> np.ndarray:
    """Every sample of the three images."""
    return normals > 0


def keep_dominant(normals: np.ndarray) -> np.ndarray:
    """Only the image that the surface faces most; ties go to the lowest axis.

    View-independent object-space splatting's normal-based reduction, with the triangle's own normal: chosen by
    the interpolated normal, a sample's neighbour can pick another axis and leave a hole (facts/sampling.md section 5).
    """
    x, y, z = normals
    is_x = (x >= y) & (x >= z)
    is_y = ~is_x & (y >= z)
    return np.stack([is_x, is_y, ~(is_x | is_y)])


#: name -> function of (3, t) absolute normal components of any common scale, giving the (3, t) axes that are kept.
REDUCTIONS: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "none": keep_all,
    "normal": keep_dominant,
}


def find_reduction(name: str) -> Callable[[np.ndarray], np.ndarray]:
    """The reduction of this name; ValueError names those that exist."""
    if name not in REDUCTIONS:
        raise ValueError(f"reduction must be one of {', '.join(REDUCTIONS)}, not {name!r}.")
    return REDUCTIONS[name]


def projected_area(mesh: TriangleMesh, reduction: str = "normal") -> float:
    """Area of the usable triangles as the kept images see it, object units squared; over H^2 it is the count."""
    keeps = find_reduction(reduction)
    mesh, _ = drop_unusable(mesh)
    components = np.ascontiguousarray(mesh.positions.T)
    total = 0.0
    for chunk in triangle_chunks(len(mesh)):
        areas = np.abs(doubled_areas(gather_corners(components, mesh.triangles[chunk])))
        total += float((areas * keeps(areas)).sum()) / 2
    return total


def predict_count(
    mesh: TriangleMesh, *, spacing: float | None = None, resolution: float | None = None, reduction: str = "normal"
) -> int:
    """Number of surfels that `sample_mesh` will make, from areas alone; 0 for a mesh without usable triangles."""
    check_fineness(spacing, resolution)
    mesh, _ = drop_unusable(mesh)
    area = projected_area(mesh, reduction)
    return round(area / grid_spacing(mesh, spacing=spacing, resolution=resolution) ** 2) if len(mesh) else 0
