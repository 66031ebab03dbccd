# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds surfels along the edges between the parts of a mesh that are drawn as polygons and as splats.

Source: Guennebaud, Barthe, Paulin 2006, section 5.1: where polygons end, the sum of weights must be 1. It is if splats
with their centres on these edges sample them evenly. Section 5.2: splats too close to such an edge are removed.
"""

from __future__ import annotations

from itertools import product

import numpy as np

from ...quaternions import axes_quaternions
from ...runs import expand, ranges
from ...surfels import Surfels, concatenate
from ..materials.material_sampler import MaterialSampler, Samples
from ..mesh.triangle_mesh import TriangleMesh, doubled_areas, gather_corners
from ..table import empty_column

#: Surfels nearer than this share of their spacing to a sample of an edge are too close to it: the paper has no number.
TOO_CLOSE = 0.5
#: What faces another way, by the cosine, belongs to another side of the mesh and stays.
SAME_SIDE = 0.5


def joined_at_edges(surfels: Surfels, near: TriangleMesh, far: TriangleMesh, spacing: float) -> Surfels:
    """The surfels of `far`, without those that are too close to its edges with `near`, and surfels along these edges.

    spacing: of the surfels. Parts without a common edge leave the surfels as they are.
    """
    if not (len(surfels) and len(near) and len(transition_edges(near, far)[0])):
        return surfels
    edges = edge_samples(near, far, spacing, float(np.median(surfels.scales)), surfels.origin)
    kept = ~too_close(surfels, edges, TOO_CLOSE * spacing)
    return concatenate([surfels.take(kept), edges])


def too_close(surfels: Surfels, edges: Surfels, distance: float) -> np.ndarray:
    """(N,) bool: which surfels have a sample of an edge within the distance, and face the way that it does.

    Both have the same origin. Looks in the cells around each sample, as wide as the distance.
    """
    places, samples = surfels.positions.astype(np.float64), edges.positions.astype(np.float64)
    lowest = np.minimum(places.min(axis=0), samples.min(axis=0))
    cells, around = (((at - lowest) / distance).astype(np.int64) + 1 for at in (places, samples))
    count = np.maximum(cells.max(axis=0), around.max(axis=0)) + 2
    strides = np.array((count[1] * count[2], count[2], 1))
    order = np.argsort(cells @ strides, kind="stable")
    keys, around = (cells @ strides)[order], around @ strides
    normals, facing = surfels.geometric_normals(), edges.geometric_normals()
    found = np.zeros(len(surfels), bool)
    for column in product((-1, 0, 1), repeat=2):  # of three cells that follow one another
        middle = around + column @ strides[:2]
        first, last = np.searchsorted(keys, middle - 1, "left"), np.searchsorted(keys, middle + 1, "right")
        sample, number = np.repeat(np.arange(len(edges)), last - first), order[ranges(first, last - first)]
        is_near = np.linalg.norm(places[number] - samples[sample], axis=1) < distance
        is_same = np.einsum("nk,nk->n", normals[number], facing[sample]) > SAME_SIDE
        found[number[is_near & is_same]] = True
    return found


def transition_edges(near: TriangleMesh, far: TriangleMesh) -> tuple[np.ndarray, np.ndarray]:
    """The edges of `far` that `near` has too: (E,) triangles and (E,) numbers k of the edge from corner k to the next.

    Both parts index the same vertices.
    """
    of_far = far.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    of_near = near.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    count = len(far.positions)
    keys, others = (edges.min(axis=1).astype(np.int64) * count + edges.max(axis=1) for edges in (of_far, of_near))
    _, first = np.unique(keys, return_index=True)
    shared = first[np.isin(keys[first], others)]
    return shared // 3, shared % 3


def edge_samples(
    near: TriangleMesh, far: TriangleMesh, spacing: float, half_size: float, origin=(0.0, 0.0, 0.0)
) -> Surfels:
    """Discs along the edges that both parts share, at most `spacing` apart, with a half-axis of `half_size`.

    They lie between the two parts' planes and have attributes interpolated from the corners of `far`. Raises ValueError
    if the parts share no edge.
    """
    triangles, number = transition_edges(near, far)
    if not len(triangles):
        raise ValueError("The two parts of the mesh have no edge in common.")
    start, end = far.triangles[triangles, number], far.triangles[triangles, (number + 1) % 3]
    along = far.positions[end] - far.positions[start]
    length = np.linalg.norm(along, axis=1)
    counts = np.maximum(np.ceil(length / spacing), 1).astype(int)
    edge, number_on_edge = expand(counts)
    place = (number_on_edge + 0.5) / counts[edge]
    shares = np.zeros((len(edge), 3))
    at = np.arange(len(edge))
    shares[at, number[edge]], shares[at, (number[edge] + 1) % 3] = 1 - place, place
    triangle = triangles[edge]
    normals = _unit(_plane_normals(far)[triangle] + _beside(near, far, start, end)[edge])
    x = _unit(along[edge] - normals * np.einsum("nk,nk->n", along[edge], normals)[:, None])
    positions = far.positions[start[edge]] + along[edge] * place[:, None]
    origin = np.asarray(origin, np.float64)
    shading = normals if far.corner_normals is None else _unit(_mean(far.corner_normals[triangle], shares), normals)
    sampler = MaterialSampler(far.surfaces)
    materials = np.zeros(len(edge), np.int32) if far.materials is None else far.materials[triangle].astype(np.int32)
    out = {"colors": np.empty((len(edge), 4), np.float32), "normals": shading.astype(np.float32)}
    out |= {name: empty_column(name, len(edge)) for name in sampler.optional}
    sampler.fill(
        out, _samples(far, triangle, shares, materials, spacing / np.maximum(length[edge], 1e-300), number[edge])
    )
    return Surfels(
        positions=positions - origin,
        rotations=axes_quaternions(x, np.cross(normals, x), normals),
        scales=np.full((len(edge), 2), half_size),
        materials=materials,
        origin=origin,
        **out,
    )


def _samples(far: TriangleMesh, triangle, shares, materials, step, number) -> Samples:
    """Inputs for evaluating the materials of the samples. step: their distance, in lengths of their edge."""
    colors = None if far.corner_colors is None else _mean(far.corner_colors[triangle], shares).T
    if far.corner_uvs is None:
        return Samples(materials, colors)
    corners, at = far.corner_uvs[triangle], np.arange(len(triangle))
    along = (corners[at, (number + 1) % 3] - corners[at, number]) * step[:, None]
    return Samples(materials, colors, _mean(corners, shares).T, np.stack([along.T, along.T]))


def _mean(corners: np.ndarray, shares: np.ndarray) -> np.ndarray:
    return np.einsum("nkc,nk->nc", corners.astype(np.float64), shares)


def _plane_normals(mesh: TriangleMesh) -> np.ndarray:
    """(T, 3) unit normals of the triangles' planes; 0 for triangles without area."""
    return _unit(doubled_areas(gather_corners(np.ascontiguousarray(mesh.positions.T), mesh.triangles)).T)


def _beside(near: TriangleMesh, far: TriangleMesh, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """(E, 3) normals of the polygons at the edges."""
    count = len(far.positions)
    edges = near.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    keys = edges.min(axis=1).astype(np.int64) * count + edges.max(axis=1)
    order = np.argsort(keys, kind="stable")
    wanted = np.minimum(start, end).astype(np.int64) * count + np.maximum(start, end)
    return _plane_normals(near)[order[np.searchsorted(keys[order], wanted)] // 3]


def _unit(vectors: np.ndarray, otherwise=(0.0, 0.0, 1.0)) -> np.ndarray:
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.where(length > 1e-12, vectors / np.where(length > 1e-12, length, 1), otherwise)
