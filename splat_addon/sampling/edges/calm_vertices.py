# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds vertices of a mesh that cannot lie on a border edge: one pass over the corners spares `borders` most edges.

A vertex is represented by its shading normal in one of its triangles. If all directions around it are within half an
angle of that normal, they are within that angle of each other. It also requires that colours and materials are those of
that triangle, and that the triangles around the vertex close a fan.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from ...workers import run_all
from ..mesh.triangle_mesh import TriangleMesh, triangle_chunks

#: Bits of a vertex's hash that tell whether the triangles around another close a fan: sums of them are exact.
_FAN_BITS = 24


@dataclass(frozen=True, eq=False)
class CalmVertices:
    """is_calm: (V,) bool, by position. cosines: (T,) float32: cosine of the largest angle between a triangle's
    plane and the directions of its calm vertices; 1 if it has none.
    """

    is_calm: np.ndarray
    cosines: np.ndarray


def calm_vertices(
    mesh: TriangleMesh, places: np.ndarray, normals: np.ndarray, angles: np.ndarray, looks
) -> CalmVertices:
    """Find the calm vertices.

    places: (3, T) the vertex that represents each corner's position. normals: (3, T) float32, unit. angles: (T,)
    radians, the angle that makes a crease; at a vertex the smallest one counts. looks: (T,) label of each triangle's
    surface, or None if all are the same.
    """
    count, least_at = len(mesh), _least_cosines(mesh, places, angles)
    some = np.zeros(len(mesh.positions), np.intp)
    for k in range(3):
        some[places[k]] = np.arange(k, 3 * count, 3)
    directions = _directions(mesh, some, normals)
    labels = _labels(mesh, looks)
    label_of = None if labels is None else labels.take(some)
    is_restless = np.zeros(len(mesh.positions), bool)
    if mesh.surveyed is None or not mesh.surveyed.is_closed:
        is_restless |= _at_borders(mesh, places)
    toward = np.empty((3, count), np.float32)

    def compare(chunk: slice):
        given = None
        if mesh.corner_normals is not None:
            rows = mesh.corner_normals[chunk].reshape(-1, 9)
            given = np.ascontiguousarray(rows.T, np.float32).reshape(3, 3, -1)
        for k in range(3):
            vertex = places[k, chunk]
            direction = [component.take(vertex) for component in directions]
            cosine = toward[k, chunk]
            cosine[...] = _dot(direction, normals[:, chunk])
            least = least_at.take(vertex)
            strange = cosine < least
            if given is not None:
                strange |= _dot(direction, given[k]) < least * np.sqrt(_dot(given[k], given[k]))
            if labels is not None:
                strange |= labels[chunk.start * 3 + k : chunk.stop * 3 : 3] != label_of.take(vertex)
            is_restless[vertex.compress(strange)] = True

    run_all(partial(compare, chunk) for chunk in triangle_chunks(count))
    cosines = np.ones(count, np.float32)
    for row, vertices in zip(toward, places, strict=True):
        row[is_restless.take(vertices)] = 1
        np.minimum(cosines, row, out=cosines)
    return CalmVertices(~is_restless, cosines)


def _least_cosines(mesh: TriangleMesh, places: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """(V,) float32: the cosine of half the smallest angle around each vertex."""
    largest = angles.max()
    smallest = np.full(len(mesh.positions), largest)
    # The last of several values at one vertex stays, and that is the smallest.
    smaller = np.flatnonzero(angles < largest)
    smaller = smaller[np.argsort(-angles[smaller], kind="stable")]
    vertices = places.take(smaller, axis=1).T.ravel()
    smallest[vertices] = np.repeat(angles.take(smaller), 3)
    return np.cos(np.minimum(smallest / 2, np.pi / 2)).astype(np.float32)


def _directions(mesh: TriangleMesh, some: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """(3, V) float32 unit shading normals of vertices, each taken from one of its corners, (V,) indices 3 t + k."""
    if mesh.corner_normals is None:
        return normals.take(some // 3, axis=1)
    rows = mesh.corner_normals.reshape(-1, 3).take(some, axis=0)
    directions = np.ascontiguousarray(rows.T, np.float32)
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        length = np.sqrt(_dot(directions, directions))
        directions /= length
    poor = np.flatnonzero(~(np.isfinite(length) & (length > 1e-15)))
    directions[:, poor] = normals.take(some.take(poor) // 3, axis=1)
    return directions


def _dot(a, b) -> np.ndarray:
    """(n,) dot products of (3, n) vectors."""
    result = a[0] * b[0]
    result += a[1] * b[1]
    result += a[2] * b[2]
    return result


def _labels(mesh: TriangleMesh, looks: np.ndarray | None) -> np.ndarray | None:
    """(3 T,) uint64 labels of corners, equal if their colours and surfaces are equal; None if all are."""
    labels = None if looks is None else np.repeat(looks.astype(np.uint64), 3)
    if mesh.corner_colors is not None and any(surface.color.factors for surface in mesh.surfaces):
        rows = np.ascontiguousarray(mesh.corner_colors, np.float32).view(np.uint32)
        labels = np.zeros(3 * len(mesh), np.uint64) if labels is None else labels
        for column in rows.reshape(len(labels), -1).T:
            labels *= np.uint64(0x9E3779B97F4A7C15)
            labels ^= column
    return labels


def _at_borders(mesh: TriangleMesh, places: np.ndarray) -> np.ndarray:
    """(V,) bool: whether the triangles around a vertex do not close a fan.

    Each triangle adds a number for one neighbour of the vertex and subtracts one for the other; in a closed fan these
    cancel out.
    """
    shift = np.uint64(64 - _FAN_BITS)
    ends = (mesh.places >> shift).astype(np.float64).take(places)
    rest = np.zeros(len(mesh.positions))
    for k in range(3):
        rest += np.bincount(places[k], ends[(k + 1) % 3] - ends[(k + 2) % 3], len(rest))
    return rest != 0
