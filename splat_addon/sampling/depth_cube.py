# SPDX-License-Identifier: GPL-3.0-or-later
"""The layered depth cube: the spans of samples that each of three orthogonal layered depth images keeps.

Only spans are held here, 16 bytes for a whole run of samples; `attributes` gives the samples their values.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .grid import Grid
from .mesh import corner_indices, corners_at, doubled_areas, triangle_chunks
from .scan_conversion import Spans, scan_convert

#: Rows of an array index surfels with 32 bits elsewhere; nobody means to make more.
MAX_SAMPLES = 2**31 - 1

#: Triangles at a time: more than elsewhere, as few come through to where most is done with each.
_CHUNK = 24576

#: Bits of a packed cell for each component: more than the cells along an edge, 2^19, and a sign.
_CELL_BITS = 21


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
    snapped, cells = np.empty_like(coordinates), np.empty(coordinates.shape[1], np.int64)
    for chunk in triangle_chunks(len(cells)):
        grid.snapped(coordinates[:, chunk], out=snapped[:, chunk])
        cells[chunk] = _packed_cells(snapped[:, chunk], grid.subcells)
    images: tuple[list, list, list] = ([], [], [])
    total = 0
    for chunk in triangle_chunks(len(triangles), _CHUNK):
        indices = corner_indices(triangles[chunk])
        hits = _images_with_samples(*cells.take(indices))
        candidates = np.flatnonzero(hits)
        hits = hits.take(candidates)
        corners = corners_at(snapped, indices.take(candidates, axis=1))
        normals = doubled_areas(corners)
        np.abs(normals, out=normals)
        kept = keeps(normals)
        for axis, spans in enumerate(images):
            picked = np.flatnonzero(kept[axis] & (hits & (1 << axis)).astype(bool) & (normals[axis] > 0))
            u, v = (corners[(axis + k) % 3].take(picked, axis=1) for k in (1, 2))
            for part in scan_convert(u, v, candidates.take(picked) + chunk.start, grid.subcells):
                spans.append(part)
                total += int(part.counts.sum(dtype=np.int64))
                if total > MAX_SAMPLES:
                    raise ValueError(f"More than {MAX_SAMPLES:,} surfels would be made; use a larger spacing.")
        report(chunk.stop / len(triangles))
    return tuple(Spans.joined(spans) for spans in images)


def _packed_cells(snapped: np.ndarray, subcells: int) -> np.ndarray:
    """(V,) int64 that hold, for each component of (3, V) snapped coordinates, the first cell centre at or after it."""
    packed = np.zeros(snapped.shape[1], np.int64)
    for component in snapped:
        packed <<= _CELL_BITS
        packed |= np.ceil(component * (1 / subcells)).astype(np.int64)
    return packed


def _images_with_samples(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    """(t,) uint8, for each triangle with its corners in these cells a bit for each image: whether any of its rays goes
    through the triangle's box.

    Between corners with the same first cell centre lies none, half-open as in the scan conversion.
    """
    differ = a ^ b
    differ |= a ^ c
    mask = (1 << _CELL_BITS) - 1
    x, y, z = (((differ & (mask << shift)) != 0).view(np.uint8) for shift in (2 * _CELL_BITS, _CELL_BITS, 0))
    return (y & z) | (z & x) << 1 | (x & y) << 2
