# SPDX-License-Identifier: GPL-3.0-or-later
"""How many surfels large ones spare at any spacing, estimated from what is known of flat faces before sampling.

A block lies where a window around it is in the face (`flat_blocks`). The places for the middle of such a window are the
face, eroded by a square, of half-side h. Their area is A - h P + c h^2, with the face's area A and P the sum of |du| +
|dv| over the edges of its outline; c is 4 for rectangles along the axes, and 8 for triangles and what is turned.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...runs import grouped
from ..attributes.lifts import LEAST_LIFT, MOST_LIFT, edge_bulges
from ..edges.borders import survey_edges, unit_normals
from ..ldc.grid import longest_edge
from ..ldc.reductions import DEFAULT_GRAZING_ANGLE, find_reduction
from ..materials.texture_mapping import is_texture_mapped
from ..mesh.triangle_mesh import TriangleMesh, corner_indices, corners_at
from .flat_blocks import BLOCKS, LEAST_AREA
from .flat_faces import flat_faces, may_be_wide

#: Looking at this many triangles that may be in flat faces takes half a second.
_MOST_TRIANGLES = 200_000

#: Flat faces are looked for that have a block with this many cells along the mesh's longest edge.
_CELLS = 2048


class FlatExtents(NamedTuple):
    """Flat faces as images see them, each (n,), object units. areas; outlines: the P above; boxes: area of each one's
    rectangle along the image's axes; bulges: the most of its triangles' `edge_bulges`."""

    areas: np.ndarray
    outlines: np.ndarray
    boxes: np.ndarray
    bulges: np.ndarray

    def saved(self, spacing: float) -> float:
        """The number of surfels that large ones spare at this spacing."""
        saved, before = 0.0, 1.0
        are_even = MOST_LIFT * self.bulges <= LEAST_LIFT * spacing
        for edge, ring in sorted(BLOCKS.items()):
            share = 1 / edge**2
            saved += (before - share) * self._places((edge + 2 * ring - 1) / 2 * spacing)[are_even].sum()
            before = share
        return float(saved / spacing**2)

    def _places(self, half: float) -> np.ndarray:
        """(n,) the area of the places of a window's middle. half: of the window's side, object units."""
        turned = np.clip(4 * self.boxes / self.areas, 4, 8)
        is_wide = half < self.outlines / (2 * turned)
        return np.maximum(self.areas - half * self.outlines + turned * half**2, 0) * is_wide


#: The extents for a mesh that is flat nowhere, and for one with too many triangles that may be in flat faces.
NO_FLAT_EXTENTS, UNKNOWN_FLAT_EXTENTS = (FlatExtents(*np.zeros((4, 0))) for _ in range(2))


def flat_extents(
    mesh: TriangleMesh,
    *,
    reduction: str = "normal",
    grazing_angle: float = DEFAULT_GRAZING_ANGLE,
    texture_mapped: bool = False,
    deforms: bool = False,
) -> FlatExtents:
    """The flat faces of a usable mesh. The others are fields of `SamplingOptions`."""
    chosen, spacing = find_reduction(reduction), longest_edge(mesh) / _CELLS
    if chosen.merge is not None:
        return NO_FLAT_EXTENTS
    # of a scan, no triangle needs to be looked at
    normals, sizes, _ = unit_normals(mesh)
    some = may_be_wide(normals, 0.5 * sizes.astype(np.float64) ** 2, LEAST_AREA * spacing**2)
    if not len(some):
        return NO_FLAT_EXTENTS
    if len(some) > _MOST_TRIANGLES:
        return UNKNOWN_FLAT_EXTENTS
    mesh, normals = mesh.with_triangles(some), np.abs(normals.take(some, axis=1))
    is_mapped = texture_mapped and is_texture_mapped(mesh.surfaces)
    faces = flat_faces(mesh, survey_edges(mesh), LEAST_AREA, spacing, is_mapped=is_mapped, deforms=deforms)
    some = np.flatnonzero(faces >= 0)
    labels, faces = np.unique(faces.take(some), return_inverse=True)
    first = np.full(len(labels), len(some))
    np.minimum.at(first, faces, np.arange(len(some)))
    mesh, normals = mesh.with_triangles(some), normals.take(some.take(first), axis=1)
    corners = corners_at(mesh.positions.T, corner_indices(mesh.triangles))
    outer, bulges, made = _outer_edges(mesh, faces), np.zeros(len(labels)), []
    if (of_edges := edge_bulges(mesh, 0.0)) is not None:
        np.maximum.at(bulges, faces, of_edges.max(axis=0))
    for axis, is_seen in enumerate(chosen.keeps(normals, grazing_angle)):
        seen = _projected(np.delete(corners, axis, axis=0), faces, outer, len(labels))
        made.append([of[is_seen] for of in (*seen, bulges)])
    return FlatExtents(*map(np.concatenate, zip(*made, strict=True)))


def _outer_edges(mesh: TriangleMesh, faces: np.ndarray) -> np.ndarray:
    """(3, T) bool: which edges, from each corner to the next, are not shared with a triangle of the same face."""
    corners = corner_indices(mesh.triangles)
    places = mesh.places.take(corners)
    order, starts, counts = grouped((places + places[[1, 2, 0]]).ravel())
    are_outer, of_edges = np.ones(corners.size, bool), np.tile(faces, 3)
    one, other = (order.take(starts[counts == 2] + k) for k in (0, 1))
    are_inner = of_edges[one] == of_edges[other]
    are_outer[one[are_inner]] = are_outer[other[are_inner]] = False
    return are_outer.reshape(corners.shape)


def _projected(corners: np.ndarray, faces: np.ndarray, outer: np.ndarray, count: int) -> list[np.ndarray]:
    """Areas, outlines and boxes of `count` faces. corners: (2, 3, T) in the image."""
    (u1, v1), (u2, v2) = (corners[:, k] - corners[:, 0] for k in (1, 2))
    areas = np.bincount(faces, 0.5 * np.abs(u1 * v2 - u2 * v1), count)
    lengths = np.abs(corners[:, [1, 2, 0]] - corners).sum(axis=0)
    outlines = np.bincount(faces, (lengths * outer).sum(axis=0), count)
    low, high = np.full((2, count), np.inf), np.full((2, count), -np.inf)
    for k in (0, 1):
        np.minimum.at(low[k], faces, corners[k].min(axis=0))
        np.maximum.at(high[k], faces, corners[k].max(axis=0))
    return [areas, outlines, (high - low).prod(axis=0)]
