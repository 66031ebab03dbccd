# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes one surfel for each part that no ray hits: a disc at its centroid with the projected area of the part."""

from __future__ import annotations

import math

import numpy as np

from ...quaternions import quaternion_axes
from ..attributes.ellipses import ellipse_rotations
from ..ldc.grid import Grid
from ..materials.material_sampler import MaterialSampler, Samples
from ..materials.texture_mapping import BORDER, UV_FIELDS, fill_uvs
from ..mesh.triangle_mesh import TriangleMesh, doubled_areas, gather_corners
from ..table import SampleTable, empty_column

#: Half-axis of the smallest disc, in spacings: specks without measurable area still get a surfel.
_LEAST_RADIUS = 1e-3

#: Added to all areas, cells squared, so that parts without measurable area have a centroid too.
_TINY_AREA = 1e-100


def component_surfels(
    mesh: TriangleMesh,
    coordinates: np.ndarray,
    grid: Grid,
    missed: tuple[np.ndarray, np.ndarray],
    largest_radius: float,
    sampler: MaterialSampler,
    tangents: np.ndarray | None,
    texture_mapped: bool,
) -> SampleTable:
    """The arrays of `Surfels` of p parts, positions relative to the grid's middle, and their largest triangles.

    coordinates: (3, V) float64 grid coordinates of the mesh's vertices. missed: result of `missed_components`.
    largest_radius: of a disc, in spacings. sampler, tangents: as in `SampleFiller`.
    texture_mapped: whether the surfels get texture coordinates.
    The disc lies at the area-weighted centroid, faces the direction that most of the area faces, and has the area
    projected onto that direction. The shading normal is the mean over the triangles on its front; material and material
    values are those of the largest triangle.
    """
    triangles, part = missed
    corners = gather_corners(coordinates, mesh.triangles[triangles])
    vectors = doubled_areas(corners) / 2
    areas = np.sqrt((vectors**2).sum(axis=0)) + _TINY_AREA
    total = np.bincount(part, areas)
    centroids = _sums(part, corners.mean(axis=1) * areas) / total

    normals = _main_normals(part, vectors, areas)
    facing = (vectors * normals[:, part]).sum(axis=0)
    seen = np.bincount(part, np.maximum(facing, 0))
    radius = np.clip(np.sqrt(seen / math.pi), min(_LEAST_RADIUS, largest_radius), largest_radius) * grid.spacing

    largest = np.lexsort((areas, part))[np.cumsum(np.bincount(part)) - 1]
    materials = np.zeros(len(total), np.int32) if mesh.materials is None else mesh.materials[triangles[largest]]
    count = len(total)
    arrays: SampleTable = {
        "positions": ((centroids.T + 0.5 - grid.middle) * grid.spacing).astype(np.float32),
        "rotations": ellipse_rotations(normals, 2),
        "scales": np.stack([radius, radius], axis=1).astype(np.float32),
        "normals": _shading_normals(mesh, triangles, part, np.where(facing > 0, areas, 0), normals),
        "colors": np.empty((count, 4), np.float32),
        "materials": materials.astype(np.int32),
    }
    arrays |= {name: empty_column(name, count) for name in sampler.optional}
    samples = _samples(mesh, sampler, tangents, triangles[largest], materials)
    sampler.fill(arrays, samples)
    if texture_mapped:
        arrays |= {name: np.zeros((count, 2), np.float32) for name in (*UV_FIELDS, BORDER)}
        fill_uvs(arrays, mesh.surfaces, samples, axis_steps_of(corners[:, :, largest] * grid.spacing, arrays))
    return arrays | {"triangle": triangles[largest].astype(np.int32)}


def axis_steps_of(corners: np.ndarray, arrays: SampleTable) -> np.ndarray:
    """(2, 2, p): the discs' half-axes in units of the two edges from a triangle's first corner, in its plane.

    corners: (3, 3, p), object units. Uses the dual basis of the edges; not finite for a triangle without area.
    """
    first, second = (np.moveaxis(corners[:, k] - corners[:, 0], 0, 1) for k in (1, 2))
    normal = np.cross(first, second)
    square = np.einsum("ij,ij->i", normal, normal)[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        duals = np.cross(second, normal) / square, np.cross(normal, first) / square
    axes = (
        a * size[:, None] for a, size in zip(quaternion_axes(arrays["rotations"], 2), arrays["scales"].T, strict=False)
    )
    return np.stack([[np.einsum("ij,ij->i", axis, dual) for dual in duals] for axis in axes])


def _sums(part: np.ndarray, values: np.ndarray) -> np.ndarray:
    """(c, p) sums over each part of (c, m) values."""
    return np.stack([np.bincount(part, row) for row in values])


def _main_normals(part: np.ndarray, vectors: np.ndarray, areas: np.ndarray) -> np.ndarray:
    """(3, p) unit directions from which most of each part's area is visible, on the side that has more of it.

    This is the principal eigenvector of sum n n^T A; unlike the mean normal, it does not vanish on closed parts.
    """
    outer = (vectors[:, None] * vectors[None] / areas).reshape(9, -1)
    _, axes = np.linalg.eigh(_sums(part, outer).T.reshape(-1, 3, 3))
    normals = np.ascontiguousarray(axes[:, :, 2].T)
    side = (normals * _sums(part, vectors)).sum(axis=0)
    return np.where(side < 0, -normals, normals)


@np.errstate(over="ignore", invalid="ignore", divide="ignore")
def _shading_normals(mesh, triangles, part, weights, normals) -> np.ndarray:
    """(p, 3) float32: the weighted mean of the corners' shading normals; the disc's own normal if that has no
    length."""
    result = normals.T.astype(np.float32)
    if mesh.corner_normals is None:
        return result
    means = np.asarray(mesh.corner_normals[triangles], np.float64).mean(axis=1).T
    vectors = _sums(part, means * weights).T
    lengths = np.linalg.norm(vectors, axis=1)
    usable = np.isfinite(lengths) & (lengths > _TINY_AREA)
    result[usable] = vectors[usable] / lengths[usable, None]
    return result


@np.errstate(over="ignore", invalid="ignore")
def _samples(
    mesh: TriangleMesh, sampler: MaterialSampler, tangents, triangles: np.ndarray, materials: np.ndarray
) -> Samples:
    """The middle of each triangle, with a texture footprint spanned by the triangle's own edges."""
    colors = uvs = uv_steps = None
    if sampler.needs_colors and mesh.corner_colors is not None:
        colors = np.asarray(mesh.corner_colors[triangles], np.float32).mean(axis=1).T
    if sampler.needs_uvs and mesh.corner_uvs is not None:
        a, b, c = np.moveaxis(np.asarray(mesh.corner_uvs[triangles], np.float32), 1, 0)
        uvs, uv_steps = ((a + b + c) / 3).T, np.stack([(b - a).T, (c - a).T])
    if tangents is not None:
        tangents = tangents[triangles].mean(axis=1).T
    return Samples(materials, colors, uvs, uv_steps, tangents)
