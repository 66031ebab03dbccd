# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a mesh's surface breaks off: at creases, at borders of materials and colours, and where it is open.

There splats are to end: `clipping` cuts them at these edges.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np

from .joining import have_same_values
from .mesh import TriangleMesh, corner_indices, corners_at, doubled_areas

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
    normals = _unit(_face_normals(mesh))
    triangles, numbers, edge, bends = _breaking(mesh, normals, np.cos(angle))
    a, b = mesh.triangles[triangles, numbers], mesh.triangles[triangles, (numbers + 1) % 3]
    start, end = mesh.positions[a], mesh.positions[b]
    inward = _unit(np.cross(normals[triangles], end - start))
    ends = np.stack([numbers, (numbers + 1) % 3], axis=1)
    shading = normals[triangles]
    if mesh.corner_normals is not None:
        given = _unit(mesh.corner_normals[triangles[:, None], ends].astype(np.float64).sum(axis=1))
        shading = np.where((given != 0).any(axis=1)[:, None], given, shading)
    colors = np.zeros((len(triangles), 4))
    if mesh.corner_colors is not None:
        colors = mesh.corner_colors[triangles[:, None], ends, :4].mean(axis=1)
    materials = np.zeros(len(triangles), int) if mesh.materials is None else mesh.materials[triangles]
    borders = Borders(start, end, inward, normals[triangles], edge, shading, colors, materials, triangles)
    return EdgeSurvey(borders, bends)


def _breaking(mesh: TriangleMesh, normals: np.ndarray, least: float):
    """(B,) triangles, (B,) corners at which their edge starts, (B,) edges, ascending; and (T,) bends."""
    places = mesh.places.take(corner_indices(mesh.triangles))
    # The sum of two hashes names an edge alike from both sides.
    keys = np.concatenate([places[0] + places[1], places[1] + places[2], places[2] + places[0]])
    order = np.argsort(keys, kind="stable")
    ordered = keys.take(order)
    is_first = np.ones(len(order) + 1, bool)
    np.not_equal(ordered[1:], ordered[:-1], out=is_first[1:-1])
    starts = np.flatnonzero(is_first)
    counts = np.diff(starts)
    count = len(mesh)
    is_border = counts != 2
    pairs = np.flatnonzero(~is_border)
    (k, s), (n, t) = (np.divmod(order.take(starts.take(pairs) + side), count) for side in (0, 1))
    breaks, cosine = _breaks(mesh, normals, places, (s, k), (t, n), least)
    is_border[pairs] = breaks
    bends = np.zeros(count)
    goes_on = np.flatnonzero(~breaks & (cosine < 1))
    bend = np.arccos(np.clip(cosine[goes_on], -1, 1))
    for triangle in (s, t):
        np.maximum.at(bends, triangle[goes_on], bend)
    found = np.flatnonzero(is_border)
    sides = counts.take(found)
    edge = np.repeat(np.arange(len(found)), sides)
    within = np.arange(len(edge)) - np.repeat(np.cumsum(sides) - sides, sides)
    number, triangle = np.divmod(order.take(np.repeat(starts.take(found), sides) + within), count)
    return triangle, number, edge, bends


def _breaks(mesh: TriangleMesh, normals: np.ndarray, places: np.ndarray, one, other, least: float) -> np.ndarray:
    """(p,) bool of edges with two sides, each given by its triangle and its corner; and (p,) cosines of planes."""
    (s, k), (t, n) = one, other
    ahead = places[k, s] == places[n, t]
    cosine = sum(normals[s, c] * normals[t, c] for c in range(3))
    # Two faces that go along their edge in the same direction wind differently.
    planes = np.where(ahead, -cosine, cosine)
    breaks = planes < least
    rest = np.flatnonzero(~breaks)
    s, k, t, n, ahead = (values[rest] for values in (s, k, t, n, ahead))
    breaks_too = np.zeros(len(rest), bool)
    # The same end of the edge, in both triangles.
    far = np.where(ahead, n, (n + 1) % 3), np.where(ahead, (n + 1) % 3, n)
    for mine, its in zip((k, (k + 1) % 3), far, strict=True):
        if mesh.corner_normals is not None:
            a, b = _unit(mesh.corner_normals[s, mine]), _unit(mesh.corner_normals[t, its])
            cosine = np.where(ahead, -1, 1) * (a * b).sum(axis=1)
            breaks_too |= (cosine < least) & ((a != 0).any(axis=1) & (b != 0).any(axis=1))
        if mesh.corner_colors is not None and any(surface.color.factors for surface in mesh.surfaces):
            difference = np.abs(mesh.corner_colors[s, mine] - mesh.corner_colors[t, its])
            breaks_too |= difference.max(axis=1) > COLOR_BREAK
    if mesh.materials is not None:
        breaks_too |= _look_different(mesh, mesh.materials[s], mesh.materials[t])
    breaks[rest] = breaks_too
    return breaks, planes


def _look_different(mesh: TriangleMesh, s: np.ndarray, t: np.ndarray) -> np.ndarray:
    """(p,) bool: whether two materials' surfaces are not the same."""
    last = len(mesh.surfaces) - 1
    s, t = np.minimum(s, last), np.minimum(t, last)
    names = np.arange(last + 1)
    for k, surface in enumerate(mesh.surfaces):
        names[k] = next(i for i in range(k + 1) if have_same_values(mesh.surfaces[i], surface))
    return names[s] != names[t]


def _face_normals(mesh: TriangleMesh) -> np.ndarray:
    """(T, 3), as long as twice the area."""
    return doubled_areas(corners_at(np.ascontiguousarray(mesh.positions.T), corner_indices(mesh.triangles))).T


def _unit(vectors: np.ndarray) -> np.ndarray:
    """(..., 3) float64 of unit length; 0 where there is none."""
    vectors = np.asarray(vectors, np.float64)
    with np.errstate(invalid="ignore", over="ignore"):
        length = np.linalg.norm(vectors, axis=-1, keepdims=True)
        return np.where((length > 0) & np.isfinite(length), vectors / np.where(length > 0, length, 1), 0.0)
