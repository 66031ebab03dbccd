# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the flat faces of a mesh: triangles in one plane that are connected, and look the same everywhere.

`flat_blocks` makes large surfels inside of them.
"""

from __future__ import annotations

import numpy as np

from ...runs import grouped
from ...vectors import unit
from ..attributes.lifts import LEAST_LIFT, MOST_LIFT
from ..edges.borders import Borders, EdgeSurvey
from ..materials.surfaces import Computed, Surface, Texture, VertexColors
from ..mesh.connectivity import part_labels
from ..mesh.triangle_mesh import TriangleMesh, corner_indices

#: Normals, and colours, that differ by less than this are alike.
_ALIKE = 1e-3

#: Planes that differ by less than this, in radians, are one: within the largest splats, by a hundredth of a cell.
_ONE_PLANE = 1e-4

#: Bits of a hash of planes. Where few triangles share one, the face cannot be large, and is not looked at.
_SIEVE_BITS = 20


def flat_faces(
    mesh: TriangleMesh,
    survey: EdgeSurvey,
    least: float,
    spacing: float,
    *,
    bulges: np.ndarray | None = None,
    is_mapped: bool = False,
    deforms: bool = False,
) -> np.ndarray:
    """(T,) int32: the number of each triangle's flat face, or -1 if it is in none.

    survey: of the mesh; no face goes on across its borders. least: area of a face, in cells. bulges: of `lifts`, or
    None.
    is_mapped: whether images are looked up at render time: a triangle that has one is a face of its own, because
    coordinates may turn at its edges. deforms: whether triangles will move relative to each other: then each is.
    """
    faces = np.full(len(mesh), -1, np.int32)
    areas = 0.5 * survey.sizes.astype(np.float64) ** 2
    some = may_be_wide(survey.normals, areas, least * spacing**2)
    some = some[_are_even(mesh, some, is_mapped, bulges, spacing)]
    if not len(some):
        return faces
    labels = np.arange(len(some))
    if not deforms:
        pairs = _neighbours(mesh, some, survey.borders)
        pairs = pairs[_look_alike(mesh, survey.normals, *some.take(pairs.T))]
        if len(pairs):
            labels = part_labels(pairs.take([0, 1, 1], axis=1), labels)
    is_wide = np.bincount(labels, areas.take(some)).take(labels) >= least * spacing**2
    faces[some] = np.where(is_wide, labels, -1)
    return faces


def may_be_wide(normals: np.ndarray, areas: np.ndarray, least: float) -> np.ndarray:
    """The triangles whose planes may have so much area together. normals: (3, T) unit. areas: (T,)."""
    key = np.zeros(len(areas), np.int64)
    for component in normals:
        key *= 73_856_093
        key += np.rint(component * (1 / _ONE_PLANE)).astype(np.int64)
    key &= (1 << _SIEVE_BITS) - 1
    return np.flatnonzero(np.bincount(key, areas).take(key) >= least)


def _are_even(mesh: TriangleMesh, triangles: np.ndarray, is_mapped: bool, bulges, spacing: float) -> np.ndarray:
    """(t,) bool: whether each of (t,) triangles looks the same everywhere."""
    result = _of_surfaces(mesh, triangles, [is_plain(surface, is_mapped) for surface in mesh.surfaces])
    if bulges is not None:
        result &= MOST_LIFT * bulges.take(triangles, axis=1).max(axis=0) <= LEAST_LIFT * spacing
    if mesh.corner_normals is not None:
        result &= _are_alike(_unit_or_none(mesh.corner_normals.take(triangles, axis=0)))
    if _reads_colors(mesh):
        result &= _are_alike(mesh.corner_colors.take(triangles, axis=0))
    return result


def _of_surfaces(mesh: TriangleMesh, triangles: np.ndarray, values: list[bool]) -> np.ndarray:
    """(t,) bool: the value of each triangle's surface."""
    if mesh.materials is None:
        return np.full(len(triangles), values[0])
    return np.array(values)[np.minimum(mesh.materials.take(triangles), len(values) - 1)]


def _textures(surface: Surface) -> list[Texture | Computed]:
    """What may vary in a triangle whose corners have the same colours."""
    return [f for channel in surface.channels().values() for f in channel.factors if not isinstance(f, VertexColors)]


def is_plain(surface: Surface, is_mapped: bool) -> bool:
    """Whether a surface looks the same everywhere in a triangle whose corners look alike, or has an image that is
    looked up there. Coordinates that are wrapped or mirrored for it do not change evenly, and its alpha is not looked
    up."""
    textures = _textures(surface)
    if not (is_mapped and textures == [surface.color_texture]):
        return not textures
    (texture,) = textures
    return texture.wraps is None and (texture.image.is_opaque or not texture.uses_alpha)


def _reads_colors(mesh: TriangleMesh) -> bool:
    channels = (channel for surface in mesh.surfaces for channel in surface.channels().values())
    factors = [factor for channel in channels for factor in channel.factors]
    reads = any(isinstance(f, VertexColors) or (isinstance(f, Computed) and f.graph.reads_colors) for f in factors)
    return reads and mesh.corner_colors is not None


def _unit_or_none(normals: np.ndarray) -> np.ndarray:
    """Unit vectors of (..., 3) normals. Those without length, 0 here, stand for the triangle's own normal."""
    normals = unit(normals.astype(np.float64))
    return np.where(np.isfinite(normals).all(axis=-1, keepdims=True), normals, 0)


def _are_alike(corners: np.ndarray) -> np.ndarray:
    """(t,) bool: whether (t, c, k) values at c corners are the same; NaN is not."""
    with np.errstate(invalid="ignore"):
        return (np.abs(corners[:, 1:] - corners[:, :1]) <= _ALIKE).all(axis=(1, 2))


def _neighbours(mesh: TriangleMesh, some: np.ndarray, borders: Borders) -> np.ndarray:
    """(p, 2) pairs of these triangles, by their index in `some`, that share an edge which is no border."""
    corners = corner_indices(mesh.triangles.take(some, axis=0))
    places = mesh.places.take(corners)
    keys = (places + places[[1, 2, 0]]).ravel()
    order, starts, counts = grouped(keys)
    starts = starts[counts == 2]
    pairs = np.stack([order.take(starts), order.take(starts + 1)], axis=1) % len(some)
    ends = np.flatnonzero(borders.edges[1:] == borders.edges[:-1])
    broken = _pair_keys(borders.triangles.take(ends), borders.triangles.take(ends + 1), len(mesh))
    return pairs[~np.isin(_pair_keys(*some.take(pairs.T), len(mesh)), broken)]


def _pair_keys(one: np.ndarray, other: np.ndarray, count: int) -> np.ndarray:
    return np.minimum(one, other).astype(np.int64) * count + np.maximum(one, other)


def _look_alike(mesh: TriangleMesh, normals: np.ndarray, one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """(p,) bool: whether even triangles lie in one plane and look the same. normals: (3, T). one, other: (p,)."""
    off = normals.take(one, axis=1) - normals.take(other, axis=1)
    result = (off * off).sum(axis=0) < _ONE_PLANE**2
    result &= _of_surfaces(mesh, one, [not _textures(surface) for surface in mesh.surfaces])
    if mesh.materials is not None:
        result &= mesh.materials.take(one) == mesh.materials.take(other)
    if mesh.corner_normals is not None:
        firsts = mesh.corner_normals[:, 0]
        result &= _are_alike(np.stack([_unit_or_none(firsts.take(each, axis=0)) for each in (one, other)], axis=1))
    if _reads_colors(mesh):
        firsts = mesh.corner_colors[:, 0]
        result &= _are_alike(np.stack([firsts.take(each, axis=0) for each in (one, other)], axis=1))
    return result
