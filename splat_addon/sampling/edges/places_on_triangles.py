# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the triangles that places lie in. Both are looked up by cells of space, along the axis that sees the triangle
best."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...runs import expand, order_of
from ..ldc.scan_conversion import batches
from ..mesh.triangle_mesh import TriangleMesh

#: Cells along the longest edge of the mesh.
_CELLS = 128

#: Pairs in a batch.
_BATCH = 1 << 20


def places_on_triangles(
    mesh: TriangleMesh, normals: np.ndarray, places: np.ndarray, tolerance: float
) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of a place and a triangle, as (p,) indices of each, such that the place lies in the triangle.

    normals: (3, T) unit, of the triangles. places: (n, 3) within the mesh's box. tolerance: object units, off the
    triangle's plane and beyond its sides.
    """
    found = [np.empty((2, 0), np.int64)]
    facing = np.abs(normals).argmax(axis=0)
    # Relative to the mesh's corner, or rounding would count where it is far from the origin.
    columns = np.ascontiguousarray((places - mesh.bounds()[0]).T)
    offsets = np.einsum("ij,ji->i", mesh.positions.take(mesh.triangles[:, 0], axis=0) - mesh.bounds()[0], normals)
    for axis in range(3):
        for place, triangle in _in_same_cells(mesh, np.flatnonzero(facing == axis), places, axis, tolerance):
            off = offsets.take(triangle)
            for normal, column in zip(normals, columns, strict=True):
                off -= normal.take(triangle) * column.take(place)
            near = np.flatnonzero(np.abs(off, out=off) <= tolerance)
            place, triangle = place.take(near), triangle.take(near)
            inside = np.flatnonzero(_are_between_sides(mesh, normals, places, place, triangle, tolerance))
            found.append(np.stack([place.take(inside), triangle.take(inside)]))
    place, triangle = np.concatenate(found, axis=1)
    return place, triangle


def _in_same_cells(
    mesh: TriangleMesh, triangles: np.ndarray, places: np.ndarray, axis: int, tolerance: float
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Yields pairs of a place and one of these triangles, seen along an axis, that share a cell and the depth there."""
    along = [(axis + 1) % 3, (axis + 2) % 3, axis]  # the last one is the depth
    low, high = mesh.bounds()
    edge = max(float((high - low).max()) / _CELLS, 1e-300)

    def cells_of(values: np.ndarray) -> np.ndarray:
        return np.clip(np.floor((values - low[along]) / edge), 0, _CELLS).astype(np.int64)

    cells = cells_of(places[:, along]) @ ((_CELLS + 1) ** 2, _CELLS + 1, 1)
    order = order_of(cells)
    cells = cells.take(order)
    starts = np.searchsorted(cells, np.arange((_CELLS + 1) ** 2 + 1) * (_CELLS + 1))
    corners = mesh.positions[:, along][mesh.triangles.take(triangles, axis=0)]
    first, last = cells_of(corners.min(axis=1) - tolerance), cells_of(corners.max(axis=1) + tolerance)
    some = np.flatnonzero(_places_between(starts, first[:, :2], last[:, :2]))
    triangles, first, last = triangles.take(some), first.take(some, axis=0), last.take(some, axis=0)
    size = (last - first + 1)[:, :2]
    for part in batches(size.prod(axis=1), _BATCH):
        row, step = expand(size[part].prod(axis=1))
        row += part.start
        seen = first[:, :2].take(row, axis=0) + np.stack(np.divmod(step, size[:, 1].take(row)), axis=1)
        cell = seen @ (_CELLS + 1, 1) * (_CELLS + 1)
        start = np.searchsorted(cells, cell + first[:, 2].take(row))
        counts = np.searchsorted(cells, cell + last[:, 2].take(row), side="right") - start
        for few in batches(counts, _BATCH):
            pair, step = expand(counts[few])
            pair += few.start
            yield order.take(start.take(pair) + step), triangles.take(row.take(pair))


def _places_between(starts: np.ndarray, first: np.ndarray, last: np.ndarray) -> np.ndarray:
    """(t,) how many places lie in cells first to last, (t, 2) each. starts: (cells + 1,) the first place of each."""
    before = np.zeros((_CELLS + 2, _CELLS + 2), np.int64)
    before[1:, 1:] = np.diff(starts).reshape(_CELLS + 1, _CELLS + 1).cumsum(axis=0).cumsum(axis=1)
    (top, left), (bottom, right) = first.T, last.T + 1
    return before[bottom, right] - before[top, right] - before[bottom, left] + before[top, left]


def _are_between_sides(mesh: TriangleMesh, normals, places, place, triangle, tolerance: float) -> np.ndarray:
    """(p,) bool: whether each place lies in its triangle, apart from its distance from the plane."""
    normal, at = normals.T.take(triangle, axis=0).astype(np.float64), places.take(place, axis=0)
    corners = mesh.positions.take(mesh.triangles.take(triangle, axis=0), axis=0)
    result = np.ones(len(place), bool)
    for k in range(3):
        side = corners[:, (k + 1) % 3] - corners[:, k]
        inside = np.einsum("ij,ij->i", np.cross(side, at - corners[:, k]), normal)
        result &= inside >= -tolerance * np.linalg.norm(side, axis=1)
    return result
