# SPDX-License-Identifier: GPL-3.0-or-later
"""The first step of sampling: drops triangles that cannot be sampled, and counts them by reason."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from .survey import survey, survey_without
from .triangle_mesh import TriangleMesh

#: Coordinates beyond this make squared areas overflow float32; no scene is that large, but broken files are.
MAX_COORDINATE = 1e18


def drop_unusable(mesh: TriangleMesh) -> tuple[TriangleMesh, dict[str, int]]:
    """The mesh without its unusable triangles and unused vertices, and how many triangles were dropped, by reason.

    Each triangle is counted once, under the first reason that applies. Triangles that share the positions of all three
    corners with an earlier one are dropped, because they would double every sample; but a card's back that does not
    look like its front stays. A mesh without unusable triangles is returned unchanged.
    """
    mesh, _, dropped = _usable(mesh)
    return mesh, dropped


def usable_triangles(mesh: TriangleMesh) -> tuple[TriangleMesh, np.ndarray]:
    """What `drop_unusable` keeps, and the (t,) ascending indices of its triangles in `mesh`."""
    return _usable(mesh)[:2]


def _usable(mesh: TriangleMesh) -> tuple[TriangleMesh, np.ndarray, dict[str, int]]:
    """The result of `drop_unusable`, and between its parts the indices of the triangles."""
    rows, dropped = np.arange(len(mesh)), {}
    if mesh.known_usable:
        return mesh, rows, dropped
    low, high = mesh.bounds() if len(mesh) else (0, 0)
    if not (np.all(low >= -MAX_COORDINATE) and np.all(high <= MAX_COORDINATE)):
        for reason, is_bad_value in _BAD_VERTICES.items():
            is_bad = is_bad_value(mesh.positions).any(axis=1)
            mesh, rows = _without({reason: np.flatnonzero(is_bad[mesh.triangles].any(axis=1))}, mesh, rows, dropped)
    found = survey(mesh)
    pinched = found.flat[_repeats_index(mesh.triangles.take(found.flat, axis=0))]
    repeating = _repeating(mesh, np.setdiff1d(found.suspects, pinched))
    collinear = np.setdiff1d(found.flat, np.concatenate([pinched, repeating]))
    bad = {"with a repeated vertex": pinched, "that repeat another": repeating, "of zero area": collinear}
    whole = mesh
    mesh, rows = _without(bad, mesh, rows, dropped)
    if mesh is not whole:
        found = survey_without(whole, np.concatenate(list(bad.values())), mesh)
    if not found.is_used.all():
        new_index = np.cumsum(found.is_used) - 1
        mesh = replace(mesh, positions=mesh.positions[found.is_used], triangles=new_index[mesh.triangles])
        found = replace(found, is_used=np.ones(len(mesh.positions), bool))
    object.__setattr__(mesh, "surveyed", found)
    object.__setattr__(mesh, "known_usable", True)
    object.__setattr__(mesh, "facing_area", found.facing_area)
    return mesh, rows, dropped


def _without(
    bad: dict[str, np.ndarray], mesh: TriangleMesh, rows: np.ndarray, dropped: dict[str, int]
) -> tuple[TriangleMesh, np.ndarray]:
    """The mesh and the rows without the triangles of each reason, which are counted in `dropped`; the same mesh if
    there are none."""
    dropped |= {reason: len(those) for reason, those in bad.items() if len(those)}
    those = np.concatenate(list(bad.values()))
    if not len(those):
        return mesh, rows
    kept = np.delete(np.arange(len(mesh)), those)
    return mesh.with_triangles(kept), rows[kept]


def _repeats_index(triangles: np.ndarray) -> np.ndarray:
    a, b, c = triangles.T
    return (a == b) | (b == c) | (c == a)


def _repeating(mesh: TriangleMesh, suspects: np.ndarray) -> np.ndarray:
    """The triangles that have the same three corner positions as an earlier one and face the same way or look alike.

    suspects: (k,) the triangles to compare, ascending.
    """
    vertices, corners = np.unique(mesh.triangles[suspects], return_inverse=True)
    corners = _equal_rows(mesh.positions[vertices])[corners.reshape(-1, 3)]
    order = np.argsort(corners, axis=1, kind="stable")
    place = _equal_rows(np.take_along_axis(corners, order, axis=1))
    is_odd = (order[:, 0] > order[:, 1]) ^ (order[:, 0] > order[:, 2]) ^ (order[:, 1] > order[:, 2])
    look = [place if mesh.materials is None else mesh.materials[suspects]]
    for values in (mesh.corner_colors, mesh.corner_uvs):
        if values is not None:
            look += [*np.take_along_axis(values[suspects], order[..., None], axis=1).reshape(-1, 3 * values.shape[2]).T]
    firsts = [np.unique(_equal_rows(np.column_stack([place, *of])), return_index=True)[1] for of in ([is_odd], look)]
    return np.delete(suspects, np.intersect1d(*firsts))


def _equal_rows(rows: np.ndarray) -> np.ndarray:
    """(n,) integers that are equal exactly where two rows of (n, 3) are equal."""
    order = np.lexsort(rows.T)
    differs = (rows[order[1:]] != rows[order[:-1]]).any(axis=1)
    label = np.empty(len(rows), np.intp)
    label[order] = np.concatenate([[0], np.cumsum(differs)])
    return label


#: reason -> function of (V, 3) positions that returns the bad vertices.
_BAD_VERTICES = {
    "with a non-finite vertex": lambda p: ~np.isfinite(p),
    f"with a vertex beyond {MAX_COORDINATE:g}": lambda p: np.isfinite(p) & (np.abs(p) > MAX_COORDINATE),
}
