# SPDX-License-Identifier: GPL-3.0-or-later
"""The layered depth cube: the spans of samples that each of three orthogonal layered depth images keeps.

Only spans are held here, 16 bytes for a whole run of samples; `attributes` gives the samples their values.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .grid import Grid
from .mesh import doubled_areas, gather_corners, triangle_chunks
from .scan_conversion import Spans, scan_convert

#: Rows of an array index surfels with 32 bits elsewhere; nobody means to make more.
MAX_SAMPLES = 2**31 - 1


def depth_cube(
    coordinates: np.ndarray,
    triangles: np.ndarray,
    grid: Grid,
    keeps: Callable[[np.ndarray], np.ndarray],
    report: Callable[[float], None],
) -> tuple[Spans, Spans, Spans]:
    """One `Spans` for the image along each of x, y, z.

    coordinates: (3, V) float64, of the vertices on the grid. triangles: (T, 3).
    keeps: (3, t) absolute normal components -> the (3, t) images that sample a triangle.
    report: called with the finished share, 0 to 1. The axis is chosen from the snapped corners, whose normal is exact.
    Raises ValueError with one sentence where there would be more samples than `MAX_SAMPLES`.
    """
    images: tuple[list, list, list] = ([], [], [])
    total = 0
    for chunk in triangle_chunks(len(triangles)):
        corners = grid.snapped(gather_corners(coordinates, triangles[chunk]))
        normals = np.abs(doubled_areas(corners))
        kept = keeps(normals) & (normals > 0)
        for axis, spans in enumerate(images):
            picked = np.flatnonzero(kept[axis])
            u, v = (corners[(axis + k) % 3].take(picked, axis=1) for k in (1, 2))
            for part in scan_convert(u, v, picked + chunk.start, grid.subcells):
                spans.append(part)
                total += int(part.counts.sum(dtype=np.int64))
                if total > MAX_SAMPLES:
                    raise ValueError(f"More than {MAX_SAMPLES:,} surfels would be made; use a larger spacing.")
        report(chunk.stop / len(triangles))
    return tuple(Spans.joined(spans) for spans in images)
