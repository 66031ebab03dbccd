# SPDX-License-Identifier: GPL-3.0-or-later
"""The layered depth cube: three orthogonal layered depth images, each stored as spans of samples.

Only spans are stored here, 16 bytes for a whole run of samples; `attributes` gives the samples their values.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ..mesh.triangle_mesh import corner_indices, corners_at, doubled_areas, triangle_chunks
from .grid import Grid
from .missed_components import SampledSurface
from .scan_conversion import Spans, scan_convert

#: Surfel rows are indexed with 32 bits elsewhere, which is far beyond practical counts.
MAX_SAMPLES = 2**31 - 1


#: Triangles per batch: larger than elsewhere, because few triangles reach the expensive steps.
_CHUNK = 24576

#: Bits per component of a packed cell: room for the cells along an edge, 2^19, and a sign.
_CELL_BITS = 21


def depth_cube(
    coordinates: np.ndarray,
    triangles: np.ndarray,
    grid: Grid,
    keeps: Callable[[np.ndarray], np.ndarray],
    surface: SampledSurface,
    report: Callable[[float], None],
    bands: np.ndarray | None = None,
) -> tuple[Spans, Spans, Spans]:
    """One `Spans` for the image along each of x, y, z.

    coordinates: (3, V) float64 grid coordinates of the vertices. triangles: (T, 3).
    keeps: (3, t) absolute normal components -> the (3, t) images that sample a triangle.
    surface: is told which triangles are sampled; has the same vertices.
    bands: (2, 3) float64, the half-open range of rows wanted of each image; None: all.
    report: called with the finished share, 0 to 1. The axis is chosen from the snapped corners, whose normal is exact.
        Raises ValueError with one sentence if there would be more than `MAX_SAMPLES` samples.
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
        candidates = np.flatnonzero(hits.any(axis=0))
        corners = corners_at(snapped, indices.take(candidates, axis=1))
        normals = doubled_areas(corners)
        np.abs(normals, out=normals)
        kept = keeps(normals)
        kept &= hits.take(candidates, axis=1)
        kept &= normals > 0
        if bands is not None:
            kept &= _reaches(corners, bands * grid.subcells)
        picked = [np.flatnonzero(row) for row in kept]
        places = candidates.take(np.concatenate(picked))
        ends = np.cumsum([len(part) for part in picked])
        # All images at once, because numpy is slow on small arrays.
        rows = None if bands is None else np.repeat(bands, [len(part) for part in picked], axis=1)
        for found in scan_convert(*(_seen(corners, picked, k) for k in (1, 2)), grid.subcells, rows):
            stops = np.searchsorted(found.triangles, ends)
            sampled = places.take(found.triangles)
            found = replace(found, triangles=(sampled + chunk.start).astype(np.int32))
            for spans, start, stop in zip(images, (0, *stops), stops, strict=False):
                spans.append(found[start:stop])
            surface.add(indices, sampled)
            total += int(found.counts.sum(dtype=np.int64))
            if total > MAX_SAMPLES:
                raise ValueError(f"More than {MAX_SAMPLES:,} surfels would be made; use a larger spacing.")
        surface.grow(indices, chunk.start)
        report(chunk.stop / len(triangles))
    return tuple(Spans.joined(spans) for spans in images)


def surface_of(triangles: np.ndarray, images: tuple[Spans, ...], vertices: int) -> SampledSurface:
    """Tell a surface which triangles these spans sample, as `depth_cube` does while it makes them."""
    surface, is_sampled = SampledSurface(vertices), np.zeros(len(triangles), bool)
    for spans in images:
        is_sampled[spans.triangles] = True
    for chunk in triangle_chunks(len(triangles), _CHUNK):
        indices = corner_indices(triangles[chunk])
        surface.add(indices, np.flatnonzero(is_sampled[chunk]))
        surface.grow(indices, chunk.start)
    return surface


def row_bands(coordinates: np.ndarray, grid: Grid, number: int, blocks: int, step: int = 1) -> np.ndarray:
    """(2, 3) float64: the first row of this block in each image, and the first row of the next block; whole steps."""
    ends = np.ceil(grid.snapped(coordinates.max(axis=1)) / grid.subcells)[[2, 0, 1]].astype(np.int64)
    ends = -(-ends // step)
    return step * np.stack([ends * number // blocks, ends * (number + 1) // blocks]).astype(np.float64)


def in_bands(images: tuple[Spans, ...], bands: np.ndarray) -> tuple[Spans, ...]:
    """The spans that lie in these rows. bands: of `row_bands`."""
    kept = (
        np.flatnonzero((spans.rows >= first) & (spans.rows < last))
        for spans, first, last in zip(images, *bands, strict=True)
    )
    return tuple(spans[some] for spans, some in zip(images, kept, strict=True))


def _reaches(corners: np.ndarray, bands: np.ndarray) -> np.ndarray:
    """(3, t) bool: whether a triangle may have a row in the image's band. bands: (2, 3), in sub-cells."""
    rows = corners[[2, 0, 1]]
    return (rows.min(axis=1) < bands[1, :, None]) & (rows.max(axis=1) > bands[0, :, None])


def _seen(corners: np.ndarray, picked: list[np.ndarray], k: int) -> np.ndarray:
    """(3, n) component axis + k of the corners of the triangles that each image samples, one image after another."""
    seen, start = np.empty((3, sum(map(len, picked)))), 0
    for axis, triangles in enumerate(picked):
        for values, row in zip(corners[(axis + k) % 3], seen, strict=True):
            values.take(triangles, out=row[start : start + len(triangles)], mode="clip")
        start += len(triangles)
    return seen


def _packed_cells(snapped: np.ndarray, subcells: int) -> np.ndarray:
    """(V,) int64 that pack the first cell centre at or after each component of (3, V) snapped coordinates."""
    packed = np.zeros(snapped.shape[1], np.int64)
    for component in snapped:
        packed <<= _CELL_BITS
        packed |= np.ceil(component * (1 / subcells)).astype(np.int64)
    return packed


def _images_with_samples(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> np.ndarray:
    """(3, t) bool, for each image and triangle with corners in these cells: whether any of the image's rays passes
    through the triangle's box.

    There is no ray between corners that have the same first cell centre, half-open as in the scan conversion.
    """
    differ = a ^ b
    differ |= a ^ c
    mask = (1 << _CELL_BITS) - 1
    x, y, z = ((differ & (mask << shift)) != 0 for shift in (2 * _CELL_BITS, _CELL_BITS, 0))
    hits = np.empty((3, len(differ)), bool)
    for row, (first, second) in zip(hits, ((y, z), (z, x), (x, y)), strict=True):
        np.logical_and(first, second, out=row)
    return hits


def axes_of(images: tuple[Spans, ...]) -> np.ndarray:
    """(N,) the axis along which each sample of the images was taken."""
    return np.repeat(np.arange(3), _samples(images))


def triangles_of(images: tuple[Spans, ...]) -> np.ndarray:
    """(N,) the triangle of each sample of the images."""
    return np.concatenate([np.repeat(spans.triangles, spans.counts) for spans in images])


def rows_of(images: tuple[Spans, ...]) -> list[tuple[int, slice]]:
    """Each axis, and the slice of the samples of its image."""
    ends = np.cumsum(_samples(images)).tolist()
    return [(axis, slice(start, end)) for axis, (start, end) in enumerate(zip((0, *ends), ends, strict=False))]


def _samples(images: tuple[Spans, ...]) -> list[int]:
    return [int(spans.counts.sum(dtype=np.int64)) for spans in images]
