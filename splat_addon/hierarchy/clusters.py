# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the surfels of a level that become one: those on one sheet of surface over one cell of a grid.

A surfel belongs to the grid that its plane faces most, of three along the axes with two sides each, as the samples of a
layered depth cube do (Pfister et al. 2000): opposite sides of a thin sheet never meet, and a cell's normals stay within
a cone. Over a cell a surfel has the depth in which its plane meets the cell's middle line; surfels of one smooth
surface have nearly the same depth there, and a gap separates sheets.
"""

from __future__ import annotations

import numpy as np

from .nodes import PORTION, Leaves, Table
from .ordering import BITS, sorted_with_order

#: In cells: the gap in depth after which another sheet begins, and the maximum extent of a sheet.
GAP = 0.5
MOST_DEPTH = 1.5

#: Steps of depth per cell, by which the surfels of a cell are ordered.
_STEPS = 16


def clustered(table: Table | Leaves, rows: np.ndarray, cell: float) -> tuple[np.ndarray, np.ndarray]:
    """(n,) order that brings the given rows together by cluster, and the (m,) sizes of the clusters in that order."""
    order, is_first, depth = _sorted(table, rows, cell)
    is_first[1:] |= depth[1:] - depth[:-1] > GAP * _STEPS
    # a chain of small gaps is cut if it gets too deep
    starts = np.flatnonzero(is_first)
    depth = depth - np.repeat(depth[starts], np.diff(np.append(starts, len(order))))
    layer = depth // int(MOST_DEPTH * _STEPS)
    is_first[1:] |= layer[1:] != layer[:-1]
    starts = np.flatnonzero(is_first)
    return order, np.diff(np.append(starts, len(order)))


def _sorted(table: Table | Leaves, rows: np.ndarray, cell: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(n,) order by place and depth; in this order, (n,) bool that marks each new place, and the (n,) depths in
    steps.
    """
    positions, normals = table.column("positions"), table.column("normals")
    materials = table.column("materials").astype(np.int64)
    low, cells = positions.min(axis=1), int(np.ptp(positions, axis=1).max() / cell) + 2
    # materials and sides, columns, rows, and depths over a cell, which reach a cell farther at either end
    bits = [n.bit_length() for n in (6 * int(materials.max()) + 5, cells, cells, (cells + 2) * _STEPS)]
    fits = sum(bits) <= BITS
    parts = []
    for start in range(0, len(rows), PORTION):
        some = rows[start : start + PORTION]
        columns = _places(positions[:, some], normals[:, some], materials[some], low, cell)
        parts.append(_packed(columns, bits) if fits else np.stack(columns))
    keys = np.concatenate(parts, axis=-1)
    is_first = np.ones(len(rows), bool)
    if fits:
        keys, order = sorted_with_order(keys, sum(bits))
        place, depth = keys >> bits[-1], keys & ((1 << bits[-1]) - 1)
        is_first[1:] = place[1:] != place[:-1]
    else:
        order = np.lexsort(keys[::-1])
        place, depth = keys[:-1, order], keys[-1, order]
        is_first[1:] = (place[:, 1:] != place[:, :-1]).any(axis=0)
    return order, is_first, depth


def _packed(columns: list[np.ndarray], bits: list[int]) -> np.ndarray:
    """The rows packed into one number each."""
    key = columns[0]
    for column, width in zip(columns[1:], bits[1:], strict=True):
        key = key << width | column
    return key


def _places(positions, normals, materials, low: np.ndarray, cell: float) -> list[np.ndarray]:
    """Non-negative integers for each surfel: its material and side, its cell's column and row, and its depth in
    the cell.
    """
    facing = np.abs(normals).argmax(axis=0)
    columns = np.empty((4, len(facing)), np.int64)
    for axis in range(3):
        at = np.flatnonzero(facing == axis)
        normal, size = normals[axis, at], np.float32(cell)
        columns[0, at] = 6 * materials[at] + 2 * axis + (normal < 0)
        depth = (positions[axis, at] - low[axis]) / size
        for k in (1, 2):
            other = (axis + k) % 3
            along = (positions[other, at] - low[other]) / size
            whole = np.floor(along)
            columns[k, at] = whole
            # half a cell along a plane that faces this axis most changes depth by at most half a cell
            depth -= (whole + np.float32(0.5) - along) * (normals[other, at] / normal)
        columns[3, at] = np.floor((depth + 1) * _STEPS)
    return list(np.maximum(columns, 0))
