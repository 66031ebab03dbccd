# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds where a part of a mesh stands on a face of another: edges that lie in the face, as those of a box on a floor.

The box's splats end at such an edge. If the floor's did not, a pixel's filter would mix both beside the edge, although
only the floor is there; so they end there, too, on each side.
"""

from __future__ import annotations

import numpy as np

from ...runs import expand
from ..ldc.grid import Grid
from ..mesh.barycentric import barycentric
from ..mesh.connectivity import connectivity
from ..mesh.triangle_mesh import TriangleMesh
from .borders import Borders, EdgeSurvey, unit_vectors
from .places_on_triangles import places_on_triangles

#: How far from a face's plane, and beyond its sides, an edge that lies in it may be, in spacings.
_TOUCH = 0.05

#: Distance of the places along an edge at which faces are looked for, and the least length of a contact, in spacings.
_STEP, _SHORT = 2.0, 0.05

#: Distance of the places at which the cells that contacts cross are looked up, in spacings.
_CROSSED = 0.5


def find_contacts(mesh: TriangleMesh, survey: EdgeSurvey, spacing: float) -> Borders:
    """The sides of all contacts, two of each in the face that is touched; their edges are numbered from 0.

    survey: of the mesh. spacing: of the samples, object units. The edges are borders of one part, the faces belong to
    another.
    """
    borders, near = survey.borders, _TOUCH * spacing
    nothing = borders.take(np.empty(0, np.intp))
    if not len(borders):
        return nothing
    part = connectivity(mesh).parts
    if (part == part[0]).all():
        return nothing
    sides = _one_of_each(borders)
    places, owner = _along(borders.start[sides], borders.end[sides], _STEP * spacing)
    place, triangle = places_on_triangles(mesh, survey.normals, places, near)
    side = sides.take(owner.take(place))
    are_apart = part.take(borders.triangles.take(side)) != part.take(triangle)
    side, triangle = np.divmod(np.unique((side * len(mesh) + triangle)[are_apart]), len(mesh))
    corners = mesh.positions[mesh.triangles[triangle]]
    normals = unit_vectors(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    ends, of_side, is_along = _in_triangles(borders.start[side], borders.end[side], corners, normals, near)
    # What lies on a side of the triangle is a contact unless that is a border anyway. The neighbour there has it, too,
    # in the opposite direction.
    is_counted = ~is_along | (of_side >= 0) & ~np.isin(triangle * 3 + of_side, _sides_of(mesh, borders))
    is_counted &= np.linalg.norm(ends[1] - ends[0], axis=1) > _SHORT * spacing
    rows = np.flatnonzero(is_counted)
    return _both_sides(mesh, *(of[rows] for of in (*ends, triangle, corners, normals)), spacing)


def crossed_cells(contacts: Borders, grid: Grid) -> list[np.ndarray]:
    """For each image, (3, c): a triangle that is touched, and the row and column of a cell that the contact crosses."""
    sides = _one_of_each(contacts)
    places, owner = _along(contacts.start[sides], contacts.end[sides], _CROSSED * grid.spacing)
    cells = np.rint(grid.coordinates(places)).astype(np.int64)
    triangles = contacts.triangles.take(sides.take(owner))
    return [np.stack([triangles, cells[(axis + 2) % 3], cells[(axis + 1) % 3]]) for axis in range(3)]


def _one_of_each(borders: Borders) -> np.ndarray:
    """The first side of each edge."""
    return np.flatnonzero(np.diff(borders.edges, prepend=-1))


def _along(start: np.ndarray, end: np.ndarray, step: float) -> tuple[np.ndarray, np.ndarray]:
    """(n, 3) places in the middles of equal parts of edges, no longer than a step, and the (n,) edge of each."""
    counts = np.maximum(np.ceil(np.linalg.norm(end - start, axis=1) / step).astype(np.int64), 1)
    owner, number = expand(counts)
    share = ((number + 0.5) / counts.take(owner))[:, None]
    return start.take(owner, axis=0) + (end - start).take(owner, axis=0) * share, owner


def _in_triangles(start: np.ndarray, end: np.ndarray, corners: np.ndarray, normals: np.ndarray, near: float):
    """(2, p, 3) ends of the parts of p edges that lie in triangles, in their planes; without length where none does.

    Also (p,) the number of the triangle's side along which the edge lies in the same direction, or -1, and (p,) bool,
    whether it lies along one. corners: (p, 3, 3), of the triangles. normals: (p, 3).
    """
    off = [np.einsum("ij,ij->i", end - corners[:, 0], normals) for end in (start, end)]
    is_in_plane = (np.abs(off) <= near).all(axis=0)
    start, end = (place - normals * each[:, None] for place, each in zip((start, end), off, strict=True))
    low, high = np.zeros(len(start)), np.ones(len(start))
    of_side, is_along = np.full(len(start), -1), np.zeros(len(start), bool)
    for k in range(3):
        side = corners[:, (k + 1) % 3] - corners[:, k]
        inward = unit_vectors(np.cross(normals, side))
        first, last = (np.einsum("ij,ij->i", place - corners[:, k], inward) for place in (start, end))
        along = (np.abs(first) <= near) & (np.abs(last) <= near)
        is_along |= along
        of_side[along & (np.einsum("ij,ij->i", end - start, side) > 0)] = k
        with np.errstate(divide="ignore", invalid="ignore"):
            crossing = first / (first - last)
        low = np.where(~along & (first < 0) & (last > 0), np.maximum(low, crossing), low)
        high = np.where(~along & (first > 0) & (last < 0), np.minimum(high, crossing), high)
        high[~along & (first <= 0) & (last <= 0)] = 0
    high = np.where(is_in_plane, np.maximum(high, low), low)
    return np.stack([start + (end - start) * share[:, None] for share in (low, high)]), of_side, is_along


def _sides_of(mesh: TriangleMesh, borders: Borders) -> np.ndarray:
    """(B,) three times the triangle of each border, and the number of its corner at which the border starts."""
    corners = mesh.positions[mesh.triangles[borders.triangles]]
    return 3 * borders.triangles + (corners == borders.start[:, None]).all(axis=2).argmax(axis=1)


def _both_sides(mesh: TriangleMesh, start, end, triangles, corners, normals, spacing: float) -> Borders:
    """Both sides of edges in faces: (m, 3) ends, (m,) triangles, their (m, 3, 3) corners and (m, 3) normals."""
    start, end = (np.stack(both, axis=1).reshape(-1, 3) for both in ((start, end), (end, start)))
    triangles, corners, normals = (np.repeat(values, 2, axis=0) for values in (triangles, corners, normals))
    inward = unit_vectors(np.cross(normals, end - start))
    # Where the triangle ends at the edge, its neighbour goes on in the same plane.
    away = np.einsum("ikj,ij->ik", corners - start[:, None], inward)
    farthest = np.take_along_axis(corners, away.argmax(axis=1)[:, None, None], axis=1)[:, 0]
    is_wide = (away.max(axis=1) > _TOUCH * spacing)[:, None]
    opposite = np.where(is_wide, farthest, (start + end) / 2 + spacing * inward)
    shares = barycentric(mesh, triangles, (start + end) / 2)
    shading, colors = normals, np.zeros((len(triangles), 4))
    if mesh.corner_normals is not None:
        given = unit_vectors(np.einsum("ikj,ik->ij", mesh.corner_normals[triangles].astype(np.float64), shares))
        shading = np.where((given != 0).any(axis=1)[:, None], given, shading)
    if mesh.corner_colors is not None:
        colors = np.einsum("ikj,ik->ij", mesh.corner_colors[triangles].astype(np.float64), shares)[:, :4]
    materials = np.zeros(len(triangles), int) if mesh.materials is None else mesh.materials[triangles]
    edges = np.arange(len(triangles)) // 2
    return Borders(start, end, inward, normals, edges, shading, colors, materials, triangles, opposite)
