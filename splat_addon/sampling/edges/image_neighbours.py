# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the surfels that may reach each border edge, in the layered depth image that the surfels come from.

Samples lie at the centres of its cells, and along its axis a splat is a disc. So an edge is scan-converted into the
cells that it comes near to, row by row, and a run of cells is a run of the surfels, once these are in the order of
their cells. What lies in other layers of the same cells is told by the plane of the edge's face.
"""

from __future__ import annotations

import numpy as np

from ..ldc.grid import BLOCK, Grid
from ..ldc.scan_conversion import batches, expand
from .ordering import order_of

#: Around the image, in cells: samples lie in it, other surfels and edges at most this far outside.
_MARGIN = 3

#: An image with more cells than this, and more cells per surfel than this, is searched by sorting instead of counting.
_FEW_CELLS, _CELLS_A_SURFEL = 1 << 20, 16

#: Tolerance of a reach, in cells, for float32 rounding.
_SLACK = 1e-3

#: Pairs per batch.
_PAIRS = 32768


def image_neighbours(
    positions: np.ndarray, axis: int, ends: np.ndarray, planes: np.ndarray, reach: float, depth: float, grid: Grid
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """(s,) surfels that come near to any edge; and of p pairs the (p,) surfel, by its number among these, the (p,) edge
    and how much higher the surfel lies than the plane of the edge's face, (p,) cells.

    positions: (N, 3) float32 surfels, relative to the grid's middle. ends: (2, 2, e) float32 of edges, across and up in
    the image along `axis`, in cells from there. planes: (3, e) float32, their rise across and up, and height there.
    reach: how near, in cells, as this image sees it. depth: how far above or below the plane.
    """
    along, up = ((axis + k) % 3 for k in (1, 2))
    width, height = (2 * int(grid.middle[a]) + 2 * BLOCK + 2 * _MARGIN for a in (along, up))
    # So that the centres of cells have whole numbers, of which none is below 0.
    shift = [np.float32(grid.middle[a] - 0.5 + _MARGIN) for a in (along, up)]
    size, scale = width * height, np.float32(1 / grid.spacing)
    kind = np.int32 if size < 2**31 else np.int64
    column, row = (np.rint(positions[:, a] * scale + s).astype(kind) for a, s in zip((along, up), shift, strict=True))
    edge, starts, stops = _runs(ends[:, 0] + shift[0], ends[:, 1] + shift[1], reach + _SLACK, width, height)
    row *= kind(width)
    row += column
    is_counted = size <= max(_FEW_CELLS, _CELLS_A_SURFEL * len(positions))
    if is_counted:
        crossings = np.bincount(starts, minlength=size + 1) - np.bincount(stops, minlength=size + 1)
        near = np.flatnonzero((np.cumsum(crossings) > 0).take(row, mode="clip"))
    else:
        near = np.arange(len(row))
    cells = row.take(near)
    order = order_of(cells)
    cells, near = cells.take(order), near.take(order)
    if is_counted:
        firsts = np.zeros(size + 1, np.intp)
        np.cumsum(np.bincount(cells, minlength=size), out=firsts[1:])
        firsts_of, stops = firsts.take(starts), firsts.take(stops)
    else:
        firsts_of, stops = np.searchsorted(cells, starts), np.searchsorted(cells, stops)
    counts = stops - firsts_of
    there = np.flatnonzero(counts)
    edge, counts, firsts_of = edge.take(there), counts.take(there), firsts_of.take(there)
    place = [positions[:, a].take(near) * scale for a in (along, up, axis)]
    # In batches that fit into the processor's cache.
    parts = [
        _near_planes(place, firsts_of[part], counts[part], edge[part], planes, np.float32(depth))
        for part in batches(counts, _PAIRS)
    ]
    nothing = np.zeros(0, np.intp), np.zeros(0, np.intp), np.zeros(0, np.float32)
    return near, *(np.concatenate(found) for found in zip(*parts, nothing, strict=True))


def _near_planes(place, firsts: np.ndarray, counts: np.ndarray, edge: np.ndarray, planes: np.ndarray, depth):
    """The pairs of edges and surfels near the plane of the edge's face, in the form of `image_neighbours`.

    The candidates are runs of surfels, `counts` long, from `firsts` on. place: (s,) each: across, up and along the
    image's axis.
    """
    # The surfels of a run are consecutive, so the values of each pair are read in order.
    surfel = np.repeat(firsts - (np.cumsum(counts) - counts), counts)
    surfel += np.arange(len(surfel))
    above = place[2].take(surfel)
    above -= np.repeat(planes[2].take(edge), counts)
    for rise, values in zip(planes, place[:2], strict=False):
        step = np.repeat(rise.take(edge), counts)
        step *= values.take(surfel)
        above -= step
    at = np.flatnonzero(np.abs(above) <= depth)
    return surfel.take(at), np.repeat(edge, counts).take(at), above.take(at)


def _runs(x: np.ndarray, y: np.ndarray, reach: float, width: int, height: int):
    """Runs of cells within `reach` of edges, and slightly more around the ends.

    Returns for each of r runs the edge, the first cell, and the cell after the last. x, y: (2, e) coordinates of the
    edges' ends.
    """
    low, high = y.min(axis=0) - reach, y.max(axis=0) + reach
    first = np.clip(np.ceil(low), 0, height).astype(np.intp)
    last = np.clip(np.floor(high), -1, height - 1).astype(np.intp)
    edge, number = expand(np.maximum(last - first + 1, 0))
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
