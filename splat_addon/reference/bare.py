# SPDX-License-Identifier: GPL-3.0-or-later
"""Measures how much of a mesh its surfels leave uncovered."""

from __future__ import annotations

import numpy as np

#: Number of nearby surfels tested per point; a cell has at most about 15 within reach.
NEIGHBOURS = 32


def uncovered_points(mesh, surfels, spacing: float, count: int = 40_000) -> np.ndarray:
    """(n, 3) those of `count` random points on a mesh's surface that no splat covers.

    A splat covers a point if its projection onto the splat's plane is inside the ellipse, within half a cell of the
    plane.
    """
    points = random_points(mesh, count)
    sizes = np.rint(np.log2(surfels.scales[:, 1]))
    # each size separately: many small neighbours must not hide a large one that reaches farther
    for size in np.unique(sizes):
        points = points[~_covered(points, surfels, np.flatnonzero(sizes == size), spacing)]
    return points


def _covered(points, surfels, rows, spacing) -> np.ndarray:
    """(n,) bool: which points these surfels cover."""
    from scipy.spatial import cKDTree

    positions, normals = surfels.origin + surfels.positions[rows], surfels.geometric_normals()[rows]
    axes = [axis[rows] for axis in surfels.half_axes()]
    reach = 1.001 * float(surfels.radius[rows].max()) + 0.5 * spacing
    _, neighbours = cKDTree(positions).query(points, k=NEIGHBOURS, distance_upper_bound=reach)
    covered = np.zeros(len(points), bool)
    for column in neighbours.T:
        at = np.flatnonzero(column < len(positions))
        surfel = column[at]
        away = points[at] - positions[surfel]
        height = (away * normals[surfel]).sum(axis=1)
        outside = sum(((away * a[surfel]).sum(axis=1) / (a[surfel] ** 2).sum(axis=1)) ** 2 for a in axes)
        covered[at] |= (outside <= 1) & (np.abs(height) <= 0.5 * spacing)
    return covered


def random_points(mesh, count: int) -> np.ndarray:
    """(count, 3) points, evenly over the surface, the same every time."""
    random = np.random.default_rng(0)
    a, b, c = np.moveaxis(mesh.positions[mesh.triangles], 1, 0)
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    picked = random.choice(len(areas), count, p=areas / areas.sum())
    u, v = np.sort(random.random((2, count)), axis=0)[..., None]
    return a[picked] * u + b[picked] * (v - u) + c[picked] * (1 - v)
