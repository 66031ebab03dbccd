# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds where a mesh's surface breaks off: at creases, at borders of materials and colours, and at open borders.

`clipping` cuts splats at these edges.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from functools import partial

import numpy as np

from ...runs import expand, grouped
from ...workers import run_all
from ..mesh.connectivity import connectivity
from ..mesh.joining import have_same_values
from ..mesh.triangle_mesh import TriangleMesh, corner_indices, corners_at, doubled_areas, triangle_chunks
from .calm_vertices import calm_vertices

#: Radians; planes that differ by more make a crease.
DEFAULT_CREASE_ANGLE = math.radians(20)

#: Beside a triangle that is larger than splats reach, the crease's angle is smaller in proportion, down to this share
#: of it. Such folds are few. Splats that reach over them stick out of silhouettes, and hide and shadow the face beyond.
LEAST_FOLD = 1 / 6

#: As large as a triangle counts its height, or this share of its longest edge where that is less: on triangles of a few
#: splats, as scans have, there would be a line in every splat, and `fitted_planes` follows such a surface as well.
_OF_LENGTH = 1 / 4

#: Largest difference of a component of colour across an edge where it still goes on.
COLOR_BREAK = 0.02

#: Tolerance of a cosine in float32: planes that differ by exactly the angle, as in a regular prism, make no crease.
_ROUNDING = 1e-6

#: On a cylinder two neighbours' planes differ twice as much as each does from the direction of a vertex between them.
_BEND = 2


#: Directions around an edge in which more sides than this are told apart.
_DIRECTIONS = 32

#: Minimum height of a triangle relative to its longest edge; below it, height is rounding error of float32 coordinates.
_LEAST_HEIGHT = 1e-6


@dataclass(frozen=True, eq=False)
class Borders:
    """B sides of border edges: an edge between two faces has two, one of each face.

    start, end: (B, 3) float64, object units, with the face at the left. inward: (B, 3) unit, in the face's plane,
    across the edge. normals: (B, 3) unit, of the face. edges: (B,) number of the edge, ascending; sides of one edge
    share it. shading: (B, 3) unit mean of the face's shading normals at the edge. colors: (B, 4) mean corner colour,
    0 where the mesh has none. materials: (B,). triangles: (B,) the face. opposite: (B, 3) a point of the face across
    from the edge, its third corner.
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
    opposite: np.ndarray

    def __len__(self) -> int:
        return len(self.start)

    def are_closed(self) -> bool:
        """Whether each edge has two faces or more."""
        return not (np.bincount(self.edges) == 1).any()

    def take(self, rows: np.ndarray) -> Borders:
        return Borders(*(getattr(self, f.name)[rows] for f in fields(self)))

    def followed_by(self, other: Borders) -> Borders:
        """Both together; the numbers of the others' edges are moved past these."""
        moved = replace(other, edges=other.edges + int(self.edges.max(initial=-1)) + 1)
        return Borders(*(np.concatenate([getattr(of, f.name) for of in (self, moved)]) for f in fields(self)))


@dataclass(frozen=True, eq=False)
class EdgeSurvey:
    """borders: where the surface breaks off. normals: (3, T) float32, unit, of the triangles. bends: (T,) float32
    radians, by how much each triangle's plane differs from those that it goes on in, at most, or from the directions of
    its calm vertices (`calm_vertices`). sizes: (T,) float32, the root of twice each one's area, object units."""

    borders: Borders
    normals: np.ndarray
    bends: np.ndarray
    sizes: np.ndarray


def survey_edges(mesh: TriangleMesh, angle: float = DEFAULT_CREASE_ANGLE, reach: float = math.inf) -> EdgeSurvey:
    """The edges of a usable mesh.

    angle: radians; an edge is a crease if the planes of its faces, or the shading normals at one of its ends, differ by
    more than this, or by a share of it beside a triangle that is larger than the splats. reach: of the splats, object
    units. Vertices at the same position count as one. An edge with one face, or with more than two, is a border of each
    of them. Faces with opposite winding are compared as if it were the same.
    """
    normals, sizes, lengths = unit_normals(mesh)
    # Twice the area by the length is the height.
    extents = np.minimum(sizes * (sizes / lengths), lengths * _OF_LENGTH)
    angles, large = np.full(len(mesh), float(angle)), np.flatnonzero(extents > reach)
    angles[large] *= np.maximum(reach / extents[large], LEAST_FOLD)
    triangles, numbers, edge, bends = _breaking(mesh, normals, angles)
    corners = corners_at(mesh.positions.T, corner_indices(mesh.triangles.take(triangles, axis=0)))
    # In rows, of which some are taken later.
    by_corner, rows = np.ascontiguousarray(corners.transpose(1, 2, 0)), np.arange(len(triangles))
    start, end, opposite = (by_corner[(numbers + step) % 3, rows] for step in range(3))
    doubled = np.ascontiguousarray(doubled_areas(corners).T)
    if not (has_plane := _have_planes(corners, doubled)).all():
        rows = triangles, numbers, edge, start, end, opposite, doubled
        triangles, numbers, edge, start, end, opposite, doubled = (each[has_plane] for each in rows)
    planes = unit_vectors(doubled)
    inward = unit_vectors(np.cross(planes, end - start))
    ends = np.stack([numbers, (numbers + 1) % 3], axis=1)
    shading = planes
    if mesh.corner_normals is not None:
        rows = mesh.corner_normals.reshape(-1, 3)
        given = unit_vectors(sum(rows.take(3 * triangles + end, axis=0) for end in ends.T))
        shading = np.where((given != 0).any(axis=1)[:, None], given, shading)
    colors = np.zeros((len(triangles), 4))
    if mesh.corner_colors is not None:
        rows = mesh.corner_colors.reshape(3 * len(mesh), -1)
        colors = sum(rows.take(3 * triangles + end, axis=0)[:, :4] for end in ends.T) / 2
    materials = np.zeros(len(triangles), int) if mesh.materials is None else mesh.materials[triangles]
    borders = Borders(start, end, inward, planes, edge, shading, colors, materials, triangles, opposite)
    return EdgeSurvey(_in_different_directions(borders), normals, bends, sizes)


def _in_different_directions(borders: Borders) -> Borders:
    """The sides without those of edges that have very many, as a book's spine has, in nearly the same direction.

    A surfel near such an edge would be compared with all of them, and ends at the same line for each.
    """
    counts = np.bincount(borders.edges)
    rows = np.flatnonzero((counts > _DIRECTIONS).take(borders.edges))
    if not len(rows):
        return borders
    first = np.searchsorted(borders.edges, borders.edges.take(rows))
    across = borders.inward.take(first, axis=0)
    upward = np.cross(unit_vectors((borders.end - borders.start).take(first, axis=0)), across)
    inward = borders.inward.take(rows, axis=0)
    angle = np.arctan2(_dots(inward, upward), _dots(inward, across))
    direction = np.floor((angle / (2 * np.pi) + 0.5) * _DIRECTIONS).astype(np.int64)
    _, kept = np.unique(borders.edges.take(rows) * (_DIRECTIONS + 1) + direction, return_index=True)
    is_left = (counts <= _DIRECTIONS).take(borders.edges)
    is_left[rows.take(kept)] = True
    return borders.take(np.flatnonzero(is_left))


def _have_planes(corners: np.ndarray, doubled: np.ndarray) -> np.ndarray:
    """(B,) bool: False for triangles whose corners are on one line within rounding.

    Their normals are meaningless, and there is no surface that a splat could end on or leave bare. corners: (3, 3, B).
    doubled: (B, 3).
    """
    longest = np.maximum.reduce([((corners[:, k] - corners[:, k - 1]) ** 2).sum(axis=0) for k in range(3)])
    return np.sqrt(_dots(doubled, doubled)) > _LEAST_HEIGHT * longest


def _breaking(mesh: TriangleMesh, normals: np.ndarray, angles: np.ndarray):
    """(B,) triangles, (B,) corners at which their edge starts, (B,) edges, ascending; and (T,) bends.

    normals: (3, T) float32, unit. angles: (T,) radians; the smaller of both faces' makes a crease. Of an edge with
    a calm end nothing more needs to be known.
    """
    one_of = connectivity(mesh).twins
    places = corner_indices(mesh.triangles if one_of is None else one_of.take(mesh.triangles))
    looks = _looks(mesh)
    calm = calm_vertices(mesh, places, normals, angles, looks)
    bends = _BEND * np.arccos(np.clip(calm.cosines, -1, 1))
    triangle, number, ends = _restless_edges(places, ~calm.is_calm)
    order, starts, counts = grouped(mesh.places.take(ends[0]) + mesh.places.take(ends[1]))
    pairs = np.flatnonzero(counts == 2)
    sides = [order.take(starts.take(pairs) + side) for side in (0, 1)]
    one, other = (_Corners(triangle.take(side), number.take(side), ends[0].take(side)) for side in sides)
    least = np.cos(np.minimum(angles.take(one.triangle), angles.take(other.triangle))) - _ROUNDING
    breaks, cosine = _breaks(mesh, normals, looks, one, other, least.astype(np.float32))
    is_border = counts != 2
    is_border[pairs] = breaks
    goes_on = np.flatnonzero(~breaks & (cosine < 1))
    by_edge, bend = np.zeros((3, len(mesh)), np.float32), np.arccos(np.maximum(cosine.take(goes_on), -1))
    for corners in (one, other):
        by_edge[corners.number.take(goes_on), corners.triangle.take(goes_on)] = bend
    for row in by_edge:
        np.maximum(bends, row, out=bends)
    found = np.flatnonzero(is_border)
    edge, within = expand(counts.take(found))
    row = order.take(starts.take(found).take(edge) + within)
    return triangle.take(row), number.take(row), edge, bends


def _restless_edges(places: np.ndarray, is_restless: np.ndarray):
    """(e,) triangles, (e,) corners at which their edges start, and (2, e) positions of the ends, for edges that
    may be borders.
    """
    among = is_restless.take(places)
    rows = [np.flatnonzero(among[k] & among[(k + 1) % 3]) for k in range(3)]
    ends = [np.concatenate([places[(k + step) % 3].take(rows[k]) for k in range(3)]) for step in (0, 1)]
    number = np.repeat(np.arange(3), [len(row) for row in rows])
    return np.concatenate(rows), number, ends


@dataclass(frozen=True, eq=False)
class _Corners:
    """p corners at which an edge starts: their triangle, their number in it, and their position."""

    triangle: np.ndarray
    number: np.ndarray
    place: np.ndarray


def _breaks(mesh: TriangleMesh, normals: np.ndarray, looks, one: _Corners, other: _Corners, least: np.ndarray):
    """(p,) bool: whether edges with two sides are borders; and (p,) cosines between their planes. least: (p,)
    cosine above which the surface continues.
    """
    s, t = one.triangle, other.triangle
    ahead = one.place == other.place
    cosine = sum(component.take(s) * component.take(t) for component in normals)
    # Two faces that go along their edge in the same direction wind differently.
    np.negative(cosine, out=cosine, where=ahead)
    breaks = cosine < least
    has_colors = mesh.corner_colors is not None and any(surface.color.factors for surface in mesh.surfaces)
    for step in (0, 1):
        # The same end of the edge, in both triangles.
        mine = 3 * s + (one.number + step) % 3
        its = 3 * t + (other.number + np.where(ahead, step, 1 - step)) % 3
        if mesh.corner_normals is not None:
            rows = mesh.corner_normals.reshape(-1, 3)
            a, b = rows.take(mine, axis=0), rows.take(its, axis=0)
            product, square = _dots(a, b), _dots(a, a) * _dots(b, b)
            np.negative(product, out=product, where=ahead)
            breaks |= product < least * np.sqrt(square)
        if has_colors:
            rows = mesh.corner_colors.reshape(-1, mesh.corner_colors.shape[2])
            for column in (rows.take(mine, axis=0) - rows.take(its, axis=0)).T:
                breaks |= np.abs(column) > COLOR_BREAK
    if looks is not None:
        breaks |= looks.take(s) != looks.take(t)
    return breaks, cosine


def _looks(mesh: TriangleMesh) -> np.ndarray | None:
    """(T,) numbers of the surfaces, equal for equal surfaces; None if all triangles look alike."""
    if mesh.materials is None or len(mesh.surfaces) == 1:
        return None
    names = np.arange(len(mesh.surfaces))
    for k, surface in enumerate(mesh.surfaces):
        names[k] = next(i for i in range(k + 1) if have_same_values(mesh.surfaces[i], surface))
    return names.take(np.minimum(mesh.materials, len(names) - 1)) if names.any() else None


def unit_normals(mesh: TriangleMesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(3, T) float32 unit normals of the triangles; (T,) float32 root of twice their areas; (T,) float32 longest
    edges.
    """
    normals, sizes = np.empty((3, len(mesh)), np.float32), np.empty(len(mesh), np.float32)
    lengths = np.empty(len(mesh), np.float32)

    def fill(chunk: slice):
        corners = corners_at(mesh.positions.T, corner_indices(mesh.triangles[chunk]))
        edges = corners - corners[:, (1, 2, 0)]
        edges *= edges
        longest = np.maximum(edges.sum(axis=0).max(axis=0), 1e-300)
        np.sqrt(longest, out=lengths[chunk], casting="same_kind")
        vectors = doubled_areas(corners)
        square = vectors[0] * vectors[0]
        square += vectors[1] * vectors[1]
        square += vectors[2] * vectors[2]
        length = np.sqrt(np.maximum(square, 1e-300, out=square), out=square)
        np.sqrt(length, out=sizes[chunk], casting="same_kind")
        np.divide(vectors, length, out=normals[:, chunk], casting="same_kind")

    run_all(partial(fill, chunk) for chunk in triangle_chunks(len(mesh)))
    return normals, sizes, lengths


def _dots(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(n,) dot products of (n, 3) vectors."""
    return a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1] + a[:, 2] * b[:, 2]


def unit_vectors(vectors: np.ndarray) -> np.ndarray:
    """(n, 3) float64 unit vectors; 0 for vectors without length."""
    vectors = np.asarray(vectors, np.float64)
    with np.errstate(invalid="ignore", over="ignore"):
        length = np.sqrt(_dots(vectors, vectors))[:, None]
        return np.where((length > 0) & np.isfinite(length), vectors / np.where(length > 0, length, 1), 0.0)
