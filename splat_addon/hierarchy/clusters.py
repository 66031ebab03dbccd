# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the surfels of a level that become one: those on one sheet of surface over one cell of a grid.

A surfel belongs to the grid that its plane faces most, of three along the axes with two sides each, as the samples of a
layered depth cube do (Pfister et al. 2000): opposite sides of a thin sheet never meet, and a cell's normals stay within
a cone. Over a cell a surfel has the depth in which its plane meets the cell's middle line; surfels of one smooth
surface have nearly the same depth there, and a gap separates sheets.
"""

from __future__ import annotations

import numpy as np

from ..runs import ranges, sorted_with_order
from .nodes import PORTION, Leaves, Table
from .ordering import BITS

#: In cells: the gap in depth after which another sheet begins, and the maximum extent of a sheet.
GAP = 0.25
MOST_DEPTH = 1.5

#: Steps of depth per cell, by which the surfels of a cell are ordered.
_STEPS = 16


def clustered(
    table: Table | Leaves, rows: np.ndarray, cell: float, has_extremes: bool = False
) -> tuple[np.ndarray, np.ndarray]:
    """(n,) order that brings the given rows together by cluster, and the (m,) sizes of the clusters in that order.

    has_extremes: whether other rows are so far away that the grid must not begin at them.
    """
    order, is_first, depth = _sorted(table, rows, cell, has_extremes)
    starts = np.flatnonzero(is_first)
    deepest = depth[np.append(starts[1:], len(order)) - 1] - depth[starts]
    # a chain of small gaps is cut if it gets too deep
    most = int(MOST_DEPTH * _STEPS)
    deep = np.flatnonzero(deepest >= most)
    if len(deep):
        counts = np.diff(np.append(starts, len(order)))[deep]
        chains = ranges(starts[deep], counts)
        layer = (depth[chains] - np.repeat(depth[starts[deep]], counts)) // most
        is_first[chains[1:][layer[1:] != layer[:-1]]] = True
        starts = np.flatnonzero(is_first)
    return order, np.diff(np.append(starts, len(order)))


def _sorted(
    table: Table | Leaves, rows: np.ndarray, cell: float, has_extremes: bool
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(n,) order by place and depth; in this order, (n,) bool that marks each new place and each gap, and (n,) depths
    in steps, of which only differences within a place count.
    """
    geometry, materials = table.geometry, table.column("materials")
    counted = (geometry[rows], materials[rows]) if has_extremes else (geometry, materials)
    low, high = (np.array([end(column) for column in counted[0].T[:3]]) for end in (np.min, np.max))
    cells = int(float((high - low).max()) / cell) + 2
    # materials and sides, columns, rows, and depths over a cell, which reach a cell farther at either end; one more bit
    # of depth, so that keys of different places differ more than those beside a gap
    bits = [n.bit_length() for n in (6 * int(counted[1].max()) + 5, cells, cells, 2 * (cells + 2) * _STEPS)]
    fits, gap = sum(bits) <= BITS, GAP * _STEPS
    # a place too far for whole numbers is told from others as it is
    kind, number = (np.int64, np.float32) if fits else (np.float64, np.float64)
    keys = np.empty(len(rows) if fits else (4, len(rows)), kind)
    has_all = len(rows) == len(table)
    for start in range(0, len(rows), PORTION):
        part = slice(start, start + PORTION)
        some = part if has_all else rows[part]
        columns = np.ascontiguousarray(geometry[some].T)
        columns = _places(columns[:3].astype(number, copy=False), columns[3:6], materials[some], low, number(cell))
        keys[..., part] = _packed(columns, bits) if fits else columns
    is_first = np.ones(len(rows), bool)
    if fits:
        order, keys = sorted_with_order(keys, 1 << sum(bits))
        np.greater(np.diff(keys), gap, out=is_first[1:])
        return order, is_first, keys
    order = np.lexsort(keys[::-1])
    place, depth = keys[:-1, order], keys[-1, order]
    is_first[1:] = (place[:, 1:] != place[:, :-1]).any(axis=0) | (np.diff(depth) > gap)
    return order, is_first, depth


def _packed(columns: list[np.ndarray], bits: list[int]) -> np.ndarray:
    """The rows packed into one number each."""
    key = columns[0]
    for column, width in zip(columns[1:], bits[1:], strict=True):
        key = key << width | column
    return key


def _places(positions, normals, materials, low: np.ndarray, size) -> list[np.ndarray]:
    """Non-negative whole numbers for each surfel: its material and side, its cell's column and row, and its depth in
    the cell, of edge `size`; as float64 if the positions are, else as int64.
    """
    sizes = np.abs(normals)
    is_x = (sizes[0] >= sizes[1]) & (sizes[0] >= sizes[2])
    is_y = ~is_x & (sizes[1] >= sizes[2])
    columns = np.empty((4, len(is_x)), np.int64 if positions.dtype == np.float32 else np.float64)
    for axis, is_facing in enumerate((is_x, is_y, ~(is_x | is_y))):
        # samples of a grid come axis by axis
        at = slice(None) if is_facing.all() else np.flatnonzero(is_facing)
        normal = normals[axis, at]
        columns[0, at] = np.maximum(6 * materials[at].astype(np.int64) + 2 * axis + (normal < 0), 0)
        depth = (positions[axis, at] - low[axis]) / size
        for k in (1, 2):
            other = (axis + k) % 3
            along = (positions[other, at] - low[other]) / size
            whole = np.floor(along)
            columns[k, at] = whole
            # half a cell along a plane that faces this axis most changes depth by at most half a cell
            depth -= (whole + np.float32(0.5) - along) * (normals[other, at] / normal)
        columns[3, at] = np.maximum(np.floor((depth + 1) * _STEPS), 0)
    return list(columns)
