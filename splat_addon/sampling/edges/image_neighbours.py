# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the surfels that may reach each border edge, in the layered depth image that the surfels come from.

Samples lie at the centres of its cells, and along its axis a splat is a disc. So an edge is scan-converted into the
cells that it comes near to, row by row, and a run of cells is a run of the surfels, once these are in the order of
their cells. What lies in other layers of the same cells is told by the plane of the edge's face.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from itertools import product
from typing import NamedTuple

import numpy as np

from ...runs import expand, order_of, runs_of_equal, steps
from ..ldc.grid import BLOCK, Grid
from ..ldc.scan_conversion import batches

#: Around the image, in cells: samples lie in it, other surfels and edges at most this far outside.
_MARGIN = 3

#: An image with more cells than this, and more cells per surfel than this, is searched by sorting instead of counting.
_FEW_CELLS, _CELLS_A_SURFEL = 1 << 20, 16

#: Tolerance of a reach, in cells, for float32 rounding.
_SLACK = 1e-3

#: Edge of the blocks, in cells, in which edges are looked for beside few surfels.
_BLOCK = 8

#: Runs per band of rows, and pairs per batch.
_RUNS, _PAIRS = 65536, 32768


class Neighbours(NamedTuple):
    """What a band of an image has near edges.

    near: (s,) surfels that come near to any edge. Of p pairs, surfel: (p,) its number among these. side: (p,) of an
    edge. above: (p,) float32, how much higher the surfel lies than the plane of the side's face, cells.
    """

    near: np.ndarray
    surfel: np.ndarray
    side: np.ndarray
    above: np.ndarray


def image_neighbours(
    positions: np.ndarray,
    axis: int,
    ends: np.ndarray,
    edges: np.ndarray,
    planes: np.ndarray,
    reach: float,
    depth: float,
    grid: Grid,
) -> Iterator[Callable[[], Neighbours]]:
    """Yields a job for each band of rows of the image; a surfel lies in one band.

    positions: (N, 3) float32 surfels, relative to the grid's middle. ends: (2, 2, e) float32 of sides, across and up in
    the image along `axis`, in cells from there. edges: (e,) of which edge, ascending. planes: (3, e) float32, their
    rise across and up, and height there. reach: how near, in cells, as this image sees it. depth: how far above or
    below the plane.
    """
    along, up = ((axis + k) % 3 for k in (1, 2))
    width, height = (2 * int(grid.middle[a]) + 2 * BLOCK + 2 * _MARGIN for a in (along, up))
    # So that the centres of cells have whole numbers, of which none is below 0.
    shift = [np.float32(grid.middle[a] - 0.5 + _MARGIN) for a in (along, up)]
    size, scale = width * height, np.float32(1 / grid.spacing)
    kind = np.int32 if size < 2**31 else np.int64
    column, row = (np.rint(positions[:, a] * scale + s).astype(kind) for a, s in zip((along, up), shift, strict=True))
    # Sides of one edge share its runs.
    sides, sides_of = runs_of_equal(edges)
    x, y = (of.take(sides, axis=1) + s for of, s in zip(ends.swapaxes(0, 1), shift, strict=True))
    if len(positions) < len(sides):
        near = _near_any(x, y, reach + _SLACK, column, row, (width, height))
        sides, sides_of, x, y = sides.take(near), sides_of.take(near), x.take(near, axis=1), y.take(near, axis=1)
    first, stop = _rows(y, reach + _SLACK, height)
    runs_in = np.cumsum(np.bincount(first, minlength=height + 1) - np.bincount(stop, minlength=height + 1))[:height]

    def found_in(band: slice):
        within = np.flatnonzero((first < band.stop) & (stop > band.start))
        rows = np.maximum(first.take(within), band.start), np.minimum(stop.take(within), band.stop)
        edge, *runs = _runs(x.take(within, axis=1), y.take(within, axis=1), rows, reach + _SLACK, width)
        surfels = np.flatnonzero((row >= band.start) & (row < band.stop))
        cells = (row.take(surfels) - kind(band.start)) * kind(width) + column.take(surfels)
        for starts_or_stops in runs:
            starts_or_stops -= band.start * width
        near, firsts, counts = _surfels_in(*runs, cells, (band.stop - band.start) * width)
        near, there = surfels.take(near), np.flatnonzero(counts)
        edge = within.take(edge.take(there))
        run, number = expand(sides_of.take(edge))
        side, there = sides.take(edge).take(run) + number, there.take(run)
        place = np.ascontiguousarray(positions.take(near, axis=0).T[[along, up, axis]]) * scale
        pairs = _near_planes(place, firsts.take(there), counts.take(there), side, planes, np.float32(depth))
        return Neighbours(near, *pairs)

    return (partial(found_in, band) for band in batches(runs_in, _RUNS) if runs_in[band].any())


def _near_any(x: np.ndarray, y: np.ndarray, reach: float, column: np.ndarray, row: np.ndarray, size) -> np.ndarray:
    """Indices of edges that may be near a surfel: long ones, and those with one in the blocks around their middles.

    x, y: (2, e) of the edges' ends. column, row: of the surfels. size: (width, height) of the image.
    """
    wide, high = (cells // _BLOCK + 3 for cells in size)
    is_near = np.zeros((high, wide), bool)
    at = row // _BLOCK + 1, column // _BLOCK + 1
    for up, across in product((-1, 0, 1), repeat=2):
        is_near[at[0] + up, at[1] + across] = True
    across, up = (
        np.clip((of[0] + of[1]) / (2 * _BLOCK) + 1, 0, n - 1).astype(np.intp) for of, n in ((x, wide), (y, high))
    )
    is_long = np.hypot(x[1] - x[0], y[1] - y[0]) / 2 + reach > _BLOCK - 1
    return np.flatnonzero(is_near[up, across] | is_long)


def _surfels_in(starts: np.ndarray, stops: np.ndarray, cells: np.ndarray, size: int):
    """The surfels in any of r runs, in the order of their cells, as indices of `cells`; and for each run its first
    among these and their count.

    starts, stops: (r,) first cell of each run, and the cell after its last. cells: (n,) of surfels. size: number of
    cells.
    """
    if size > max(_FEW_CELLS, _CELLS_A_SURFEL * len(cells)):
        near = order_of(cells)
        cells = cells.take(near)
        firsts = np.searchsorted(cells, starts)
        return near, firsts, np.searchsorted(cells, stops) - firsts
    crossings = np.bincount(starts, minlength=size + 1) - np.bincount(stops, minlength=size + 1)
    near = np.flatnonzero((np.cumsum(crossings) > 0).take(cells, mode="clip"))
    cells = cells.take(near)
    near = near.take(order_of(cells))
    firsts = np.zeros(size + 1, np.intp)
    np.cumsum(np.bincount(cells, minlength=size), out=firsts[1:])
    firsts, stops = firsts.take(starts), firsts.take(stops)
    return near, firsts, stops - firsts


def _near_planes(place, firsts: np.ndarray, counts: np.ndarray, side: np.ndarray, planes: np.ndarray, depth):
    """The pairs of surfels and sides near the plane of the side's face, as the last three of `Neighbours`.

    The candidates are runs of surfels, `counts` long, from `firsts` on. place: (s,) each: across, up and along the
    image's axis.
    """
    # In batches that fit into the processor's cache.
    parts = [(np.zeros(0, np.intp), np.zeros(0, np.intp), np.zeros(0, np.float32))]
    for part in batches(counts, _PAIRS):
        # The surfels of a run are consecutive, so the values of each pair are read in order.
        lengths, sides = counts[part], side[part]
        surfel = steps(lengths)
        surfel += np.repeat(firsts[part], lengths)
        across, up, height = (np.repeat(of.take(sides), lengths) for of in planes)
        above = place[2].take(surfel)
        above -= height
        for rise, values in ((across, place[0]), (up, place[1])):
            rise *= values.take(surfel)
            above -= rise
        at = np.flatnonzero(np.abs(above) <= depth)
        parts.append((surfel.take(at), np.repeat(sides, lengths).take(at), above.take(at)))
    return tuple(np.concatenate(found) for found in zip(*parts, strict=True))


def _rows(y: np.ndarray, reach: float, height: int) -> tuple[np.ndarray, np.ndarray]:
    """(e,) the first row within `reach` of each edge, and (e,) the row after the last. y: (2, e) of the edges' ends."""
    low, high = y.min(axis=0) - reach, y.max(axis=0) + reach
    first = np.clip(np.ceil(low), 0, height).astype(np.intp)
    return first, np.maximum(np.clip(np.floor(high), -1, height - 1).astype(np.intp) + 1, first)


def _runs(x: np.ndarray, y: np.ndarray, rows: tuple[np.ndarray, np.ndarray], reach: float, width: int):
    """Runs of cells within `reach` of edges, and slightly more around the ends.

    Returns for each of r runs the edge, the first cell, and the cell after the last. x, y: (2, e) coordinates of the
    edges' ends. rows: of each edge, its first and the one after its last.
    """
    first, stop = rows
    edge, number = expand(stop - first)
    row = number + first.take(edge)
    across, rise = x[1] - x[0], y[1] - y[0]
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = across / rise
        half = reach * np.hypot(across, rise) / np.abs(rise)
    is_flat = ~(np.abs(rise) > 1e-6 * reach)
    slope[is_flat], half[is_flat] = 0, np.inf
    middle = slope.take(edge)
    middle *= row - y[0].take(edge)
    middle += x[0].take(edge)
    half = half.take(edge)
    left = np.maximum(middle - half, (x.min(axis=0) - reach).take(edge))
    middle += half
    right = np.minimum(middle, (x.max(axis=0) + reach).take(edge))
    left = np.clip(np.ceil(left), 0, width).astype(np.intp)
    right = np.clip(np.floor(right), -1, width - 1).astype(np.intp)
    there = np.flatnonzero(right >= left)
    row *= width
    left += row
    right += row + 1
    return edge.take(there), left.take(there), right.take(there)
