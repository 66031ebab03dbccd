# SPDX-License-Identifier: GPL-3.0-or-later
"""Leaves out the triangles that cannot be sampled, and counts them by reason; the first step of sampling."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .mesh import TriangleMesh, corner_indices, doubled_areas, gather_corners, triangle_chunks

#: Beyond this the square of an area leaves float32's range; no scene is that large, but broken files are.
MAX_COORDINATE = 1e18


def drop_unusable(mesh: TriangleMesh) -> tuple[TriangleMesh, dict[str, int]]:
    """The mesh without its unusable triangles and unused vertices, and how many triangles went, by reason.

    Each triangle is counted once, under the first reason that applies. Triangles that share the positions
    of all three corners with an earlier one, in either orientation, are dropped: they would double every sample.
    A mesh that was returned by this function is returned as it is.
    """
    if mesh.known_usable:
        return mesh, {}
    kept, dropped, facing_area = None, {}, 0.0
    triangles = mesh.triangles
    for reason, is_bad in _CHECKS.items():
        bad = is_bad(mesh.positions, triangles)
        if reason == _NO_AREA:
            bad, facing_area = bad
        if bad is not None and bad.any():
            good = np.flatnonzero(~bad)
            dropped[reason] = int(len(bad) - len(good))
            kept = good if kept is None else kept.take(good)
            triangles = triangles.take(good, axis=0)
    if kept is not None:
        mesh = replace(mesh, **{name: array.take(kept, axis=0) for name, array in mesh.per_triangle().items()})
    usable = _without_unused_vertices(mesh)
    object.__setattr__(usable, "facing_area", facing_area)
    return usable, dropped


def _without_unused_vertices(mesh: TriangleMesh) -> TriangleMesh:
    """The same triangles over the vertices that they use, marked as usable; the bounds then hold no strays."""
    used = np.zeros(len(mesh.positions), bool)
    used[mesh.triangles.ravel()] = True
    if used.all():
        mesh = replace(mesh)
    else:
        new_index = np.cumsum(used) - 1
        mesh = replace(mesh, positions=mesh.positions[used], triangles=new_index[mesh.triangles])
    object.__setattr__(mesh, "known_usable", True)
    return mesh


def _with_bad_vertex(is_bad_value):
    """A check that finds the triangles of vertices with such a value; None where there is none."""

    def check(positions, triangles):
        values = is_bad_value(positions)
        return values.any(axis=1)[triangles].any(axis=1) if values.any() else None

    return check


def _repeats_index(positions, triangles):
    bad = np.empty(len(triangles), bool)
    for chunk in triangle_chunks(len(triangles)):
        a, b, c = np.ascontiguousarray(triangles[chunk].T)
        bad[chunk] = (a == b) | (b == c) | (c == a)
    return bad


def _has_no_area(positions, triangles):
    """The (t,) bad ones, and what the others make up as `TriangleMesh.facing_area`, which is next to nothing here."""
    components = np.ascontiguousarray(positions.T)
    bad, facing_area = np.empty(len(triangles), bool), 0.0
    # A corner that was refused is gone from `triangles`, so nothing here overflows.
    for chunk in triangle_chunks(len(triangles)):
        x, y, z = doubled_areas(gather_corners(components, triangles[chunk]))
        bad[chunk] = (x == 0) & (y == 0) & (z == 0)
        facing_area += float(np.maximum(np.maximum(np.abs(x), np.abs(y)), np.abs(z)).sum()) / 2
    return bad, facing_area


def _repeats_another(positions, triangles):
    """All but the first of the triangles with the same three corner positions in any order.

    Sums of 64-bit vertex hashes find the suspects in one sort; only those are compared exactly.
    """
    vertex_keys = vertex_hashes(positions)
    keys = np.empty(len(triangles), np.uint64)
    for chunk in triangle_chunks(len(triangles)):
        a, b, c = vertex_keys.take(corner_indices(triangles[chunk]))
        keys[chunk] = a + b + c
    ordered = np.sort(keys)
    shared = ordered[1:][ordered[1:] == ordered[:-1]]
    if not len(shared):
        return None
    suspects = np.flatnonzero(np.isin(keys, shared))
    vertices, corners = np.unique(triangles[suspects], return_inverse=True)
    place = _equal_rows(positions[vertices])
    corners = np.sort(place[corners.reshape(-1, 3)], axis=1)
    group = _equal_rows(corners)
    _, first = np.unique(group, return_index=True)
    bad = np.zeros(len(triangles), bool)
    bad[suspects] = True
    bad[suspects[first]] = False
    return bad


def vertex_hashes(positions: np.ndarray) -> np.ndarray:
    """(V,) uint64 that are equal for equal positions; adding 0.0 turns -0.0 into 0.0."""
    keys = np.zeros(len(positions), np.uint64)
    for column in positions.T:
        keys ^= np.ascontiguousarray(column + 0.0).view(np.uint64)
        keys *= np.uint64(0x9E3779B97F4A7C15)
        keys ^= keys >> np.uint64(29)
        keys *= np.uint64(0xBF58476D1CE4E5B9)
        keys ^= keys >> np.uint64(32)
    return keys


def _equal_rows(rows: np.ndarray) -> np.ndarray:
    """(n,) integers that are equal exactly where two rows of (n, 3) are."""
    order = np.lexsort(rows.T)
    differs = (rows[order[1:]] != rows[order[:-1]]).any(axis=1)
    label = np.empty(len(rows), np.intp)
    label[order] = np.concatenate([[0], np.cumsum(differs)])
    return label


_NO_AREA = "of zero area"

#: reason -> function of (positions, remaining triangles) giving the (t,) bad ones, or None for none. The areas come
#: last: only then are they those of the triangles that stay.
_CHECKS = {
    "with a non-finite vertex": _with_bad_vertex(lambda p: ~np.isfinite(p)),
    f"with a vertex beyond {MAX_COORDINATE:g}": _with_bad_vertex(
        lambda p: np.isfinite(p) & (np.abs(p) > MAX_COORDINATE)
    ),
    "with a repeated vertex": _repeats_index,
    "that repeat another": _repeats_another,
    _NO_AREA: _has_no_area,
}
