# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a mesh's surface breaks off: at creases, at borders of materials and colours, and where it is open.

There splats are to end: `clipping` cuts them at these edges.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np

from ..ldc.scan_conversion import expand
from ..mesh.joining import have_same_values
from ..mesh.triangle_mesh import TriangleMesh, corner_indices, corners_at, doubled_areas, triangle_chunks

#: Radians; planes that differ by more make a crease.
DEFAULT_CREASE_ANGLE = math.radians(30)

#: Largest difference of a component of colour across an edge where it still goes on.
COLOR_BREAK = 0.02


@dataclass(frozen=True, eq=False)
class Borders:
    """B sides of border edges: an edge between two faces has two, one of each face.

    start, end: (B, 3) float64, object units, with the face at the left. inward: (B, 3) unit, in the face's plane,
    across the edge. normals: (B, 3) unit, of the face. edges: (B,) number of the edge, ascending; sides of one edge
    share it. shading: (B, 3) unit mean of the face's shading normals at the edge. colors: (B, 4) mean corner colour,
    0 where the mesh has none. materials: (B,). triangles: (B,) the face.
    """

    start: np.ndarray
    end: np.ndarray
    inward: np.ndarray
    normals: np.ndarray
    edges: np.ndarray
    shading: np.ndarray
    colors: np.ndarray
    materials: np.ndarray
    triangles: np.ndarray

    def __len__(self) -> int:
        return len(self.start)

    def take(self, rows: np.ndarray) -> Borders:
        return Borders(*(getattr(self, f.name)[rows] for f in fields(self)))


@dataclass(frozen=True, eq=False)
class EdgeSurvey:
    """borders: where the surface breaks off. bends: (T,) radians, by how much each triangle's plane differs from those
    that it goes on in, at most."""

    borders: Borders
    bends: np.ndarray


def survey_edges(mesh: TriangleMesh, angle: float = DEFAULT_CREASE_ANGLE) -> EdgeSurvey:
    """The edges of a usable mesh.

    angle: radians; an edge is a crease where its faces' planes, or the shading normals at one of its ends, differ by
    more. Vertices at one place are one. An edge of one face, or of more than two, is a border of each. Faces that wind
    differently are compared as if they did not.
    """
    components = _face_normals(mesh)
    components /= np.maximum(np.sqrt((components * components).sum(axis=0)), 1e-300)
    triangles, numbers, edge, bends = _breaking(mesh, components, np.cos(angle))
    a, b = mesh.triangles[triangles, numbers], mesh.triangles[triangles, (numbers + 1) % 3]
    start, end = mesh.positions[a], mesh.positions[b]
    normals = components.take(triangles, axis=1).T
    inward = _unit(np.cross(normals, end - start))
    ends = np.stack([numbers, (numbers + 1) % 3], axis=1)
    shading = normals
    if mesh.corner_normals is not None:
        given = _unit(mesh.corner_normals[triangles[:, None], ends].astype(np.float64).sum(axis=1))
        shading = np.where((given != 0).any(axis=1)[:, None], given, shading)
    colors = np.zeros((len(triangles), 4))
    if mesh.corner_colors is not None:
        colors = mesh.corner_colors[triangles[:, None], ends, :4].mean(axis=1)
    materials = np.zeros(len(triangles), int) if mesh.materials is None else mesh.materials[triangles]
    borders = Borders(start, end, inward, normals, edge, shading, colors, materials, triangles)
    return EdgeSurvey(borders, bends)


def _breaking(mesh: TriangleMesh, normals: np.ndarray, least: float):
    """(B,) triangles, (B,) corners at which their edge starts, (B,) edges, ascending; and (T,) bends.

    normals: (3, T) unit. A *corner* here is a number k T + t: the k-th of triangle t, at which its k-th edge starts.
    """
    count = len(mesh)
    places = mesh.places.take(corner_indices(mesh.triangles))
    # The sum of two hashes names an edge alike from both sides.
    keys = (places + places[[1, 2, 0]]).ravel()
    order = np.argsort(keys)
    ordered = keys.take(order)
    is_first = np.ones(len(order) + 1, bool)
    np.not_equal(ordered[1:], ordered[:-1], out=is_first[1:-1])
    starts = np.flatnonzero(is_first)
    counts = np.diff(starts)
    is_border = counts != 2
    pairs = np.flatnonzero(~is_border)
    one, other = (order.take(starts.take(pairs) + side) for side in (0, 1))
    breaks, cosine = _breaks(mesh, normals, places.ravel(), one, other, least)
    is_border[pairs] = breaks
    bends = np.zeros(count)
    goes_on = np.flatnonzero(~breaks & (cosine < 1))
    bend = np.arccos(np.maximum(cosine.take(goes_on), -1))
    for corners in (one, other):
        np.maximum.at(bends, corners.take(goes_on) % count, bend)
    found = np.flatnonzero(is_border)
    edge, within = expand(counts.take(found))
    number, triangle = np.divmod(order.take(starts.take(found).take(edge) + within), count)
    return triangle, number, edge, bends


def _breaks(mesh: TriangleMesh, normals: np.ndarray, places: np.ndarray, one, other, least: float):
    """(p,) bool of edges with two sides, which start at a corner each; and (p,) cosines of planes."""
    count = len(mesh)
    s, t = one % count, other % count
    ahead = places.take(one) == places.take(other)
    cosine = sum(row.take(s) * row.take(t) for row in normals)
    # Two faces that go along their edge in the same direction wind differently.
    np.negative(cosine, out=cosine, where=ahead)
    breaks = cosine < least
    k, n = one // count, other // count
    has_colors = mesh.corner_colors is not None and any(surface.color.factors for surface in mesh.surfaces)
    for step in (0, 1):
        # The same end of the edge, in both triangles.
        mine, its = 3 * s + (k + step) % 3, 3 * t + (n + np.where(ahead, step, 1 - step)) % 3
        if mesh.corner_normals is not None:
            at, a, b = _differing(mesh.corner_normals, mine, its)
            side = np.where(ahead.take(at), -1.0, 1.0) * _dots(_unit(a), _unit(b))
            breaks[at] |= (side < least) & (a != 0).any(axis=1) & (b != 0).any(axis=1)
        if has_colors:
            at, a, b = _differing(mesh.corner_colors, mine, its)
            breaks[at] |= np.abs(a - b).max(axis=1, initial=0) > COLOR_BREAK
    if mesh.materials is not None:
        breaks |= _look_different(mesh, mesh.materials.take(s), mesh.materials.take(t))
    return breaks, cosine


def _differing(values: np.ndarray, one: np.ndarray, other: np.ndarray):
    """Which of two (p,) corners, 3 t + k, have different values of (T, 3, c), and these, (d, c) each."""
    rows = values.reshape(-1, values.shape[2])
    differs = np.zeros(len(one), bool)
    for column in rows.T:
        differs |= column.take(one) != column.take(other)
    at = np.flatnonzero(differs)
    return at, rows.take(one.take(at), axis=0), rows.take(other.take(at), axis=0)


def _look_different(mesh: TriangleMesh, s: np.ndarray, t: np.ndarray) -> np.ndarray:
    """(p,) bool: whether two materials' surfaces are not the same."""
    last = len(mesh.surfaces) - 1
    s, t = np.minimum(s, last), np.minimum(t, last)
    names = np.arange(last + 1)
    for k, surface in enumerate(mesh.surfaces):
        names[k] = next(i for i in range(k + 1) if have_same_values(mesh.surfaces[i], surface))
    return names[s] != names[t]


def _face_normals(mesh: TriangleMesh) -> np.ndarray:
    """(3, T), as long as twice the area."""
    components, normals = np.ascontiguousarray(mesh.positions.T), np.empty((3, len(mesh)))
    for chunk in triangle_chunks(len(mesh)):
        normals[:, chunk] = doubled_areas(corners_at(components, corner_indices(mesh.triangles[chunk])))
    return normals


def _dots(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("ij,ij->i", a, b)


def _unit(vectors: np.ndarray) -> np.ndarray:
    """(..., 3) float64 of unit length; 0 where there is none."""
    vectors = np.asarray(vectors, np.float64)
    with np.errstate(invalid="ignore", over="ignore"):
        length = np.linalg.norm(vectors, axis=-1, keepdims=True)
        return np.where((length > 0) & np.isfinite(length), vectors / np.where(length > 0, length, 1), 0.0)
