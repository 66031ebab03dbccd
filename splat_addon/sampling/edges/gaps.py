# SPDX-License-Identifier: GPL-3.0-or-later
"""More surfels along borders that the others, once they end there, leave bare: corners with more lines than two, holes
of a few cells, and faces so narrow that no ray met them and only splats from beside them hid it.
"""

from __future__ import annotations

import numpy as np

from ...clip_lines import kept
from ...surfels import LAYOUT, OPTIONAL_LAYOUT, quaternion_axes
from ..attributes.ellipses import ellipse_rotations, ellipse_scales
from ..attributes.material_sampler import MaterialSampler, Samples
from ..ldc.grid import Grid
from ..ldc.scan_conversion import expand
from ..mesh.triangle_mesh import TriangleMesh
from .borders import Borders
from .clipping import Clipping, clip

#: Distance of the places along a border that are looked at, and how far inside of it they lie, in spacings.
_STEP, _INSIDE = 0.5, 0.08

#: The first and the last of them on an edge, as a share of it.
_ENDS = 0.02

#: Edge of a cell of which one place is enough, in spacings.
_CELL = 0.6

#: Inside of a triangle, no farther on the way to its middle than this.
_TO_MIDDLE = 0.3

#: A place is covered this far into an ellipse, squared.
_COVERED = 0.95

#: One surfel covers about so many places in a row, and is of this share of the others' size: where these fail, the
#: surface is small.
_PLACES, _SIZE = 2, 0.6


def gap_surfels(
    mesh: TriangleMesh,
    borders: Borders,
    arrays: dict[str, np.ndarray],
    clipping: Clipping,
    grid: Grid,
    splat_size: float,
    sampler: MaterialSampler,
    tangents: np.ndarray | None,
) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """The arrays of `Surfels` on what is bare beside the borders, clipped like the others, {} where nothing is; and
    their (k,) triangles.

    arrays, clipping: of all other surfels. sampler, tangents: as a `SampleFiller` has them.
    """
    if not len(borders):
        return {}, np.empty(0, np.intp)
    side, places = _bare(mesh, borders, arrays, clipping, grid)
    if not len(side):
        return {}, np.empty(0, np.intp)
    triangles = borders.triangles[side]
    made = _surfels(mesh, triangles, places, borders.normals[side], grid, splat_size, sampler, tangents)
    return made | clip(made, borders, grid.surfel_origin).fields, triangles


def _bare(mesh: TriangleMesh, borders: Borders, arrays, clipping: Clipping, grid: Grid):
    """(k,) sides of borders and (k, 3) places beside them, in their triangles, that no surfel covers."""
    length = np.linalg.norm(borders.end - borders.start, axis=1)
    counts = np.ceil(length / (_STEP * grid.spacing)).astype(np.int64) + 1
    side, number = expand(counts)
    # From one end of the edge to the other: corners are what is left bare most easily.
    share = (_ENDS + (1 - 2 * _ENDS) * number / np.maximum(counts[side] - 1, 1))[:, None]
    on_edge = borders.start[side] + (borders.end - borders.start)[side] * share
    to_middle = mesh.positions[mesh.triangles[borders.triangles]].mean(axis=1)[side] - on_edge
    depth = np.einsum("ij,ij->i", to_middle, borders.inward[side])
    part = np.minimum(_INSIDE * grid.spacing / np.maximum(depth, 1e-300), _TO_MIDDLE)
    places = on_edge + to_middle * part[:, None]
    is_covered = np.zeros(len(side), bool)
    is_covered[_covered(borders, arrays, clipping, grid, counts, places)] = True
    bare = np.flatnonzero(~is_covered)
    # Of a run of bare places the second, the fourth, ...; of a single one that.
    starts = np.append(True, (bare[1:] != bare[:-1] + 1) | (side[bare[1:]] != side[bare[:-1]])) if len(bare) else bare
    first = np.flatnonzero(starts)
    sizes = np.diff(np.append(first, len(bare)))
    run, place = expand(sizes)
    chosen = bare[place % _PLACES == np.minimum(1, sizes[run] - 1)]
    # Of edges far shorter than a spacing one place for many: those of a cell that face alike.
    cells = np.floor((places[chosen] - grid.surfel_origin) / (_CELL * grid.spacing))
    _, first = np.unique(np.column_stack([cells, np.rint(borders.normals[side[chosen]])]), axis=0, return_index=True)
    chosen = chosen[np.sort(first)]
    return side[chosen], places[chosen]


def _covered(borders: Borders, arrays, clipping: Clipping, grid: Grid, counts: np.ndarray, places: np.ndarray):
    """The places, by number, that a surfel which meets their side covers. counts: (B,) how many each side has."""
    surfel, side = clipping.surfel, clipping.side
    x, y, _ = quaternion_axes(arrays["rotations"][surfel], 2)
    sizes = arrays["scales"][surfel].astype(np.float64)
    center = arrays["positions"][surfel] + grid.surfel_origin
    # Only the places that the surfel's own size reaches.
    along = (borders.end - borders.start)[side]
    length = np.maximum(np.linalg.norm(along, axis=1), 1e-300)
    foot = np.einsum("ij,ij->i", center - borders.start[side], along) / length**2
    reach = sizes.max(axis=1) / length
    last = counts[side] - 1
    low, high = (np.clip((foot + sign * reach) * last, 0, last) for sign in (-1, 1))
    low, high = np.floor(low).astype(np.int64), np.ceil(high).astype(np.int64) + 1
    meeting, number = expand(high - low)
    number += low.take(meeting)
    place = (np.cumsum(counts) - counts)[side[meeting]] + number
    offset = places[place] - center[meeting]
    q = np.stack([np.einsum("ij,ij->i", offset, axis[meeting]) for axis in (x, y)], axis=1) / sizes[meeting]
    inside = np.einsum("ij,ij->i", q, q) <= _COVERED
    return place[inside & kept(q, clipping.lines[meeting], clipping.reflex[meeting])]


def _surfels(mesh, triangles, places, normals, grid: Grid, splat_size, sampler: MaterialSampler, tangents):
    """The arrays of `Surfels` at (k, 3) places in k triangles with (k, 3) unit normals."""
    count = len(triangles)
    shares = _shares(mesh.positions[mesh.triangles[triangles]], places)
    axes = np.abs(normals).argmax(axis=1)
    rotations, scales = np.empty((count, 4), np.float32), np.empty((count, 2), np.float32)
    for axis in range(3):
        at = np.flatnonzero(axes == axis)
        rotations[at] = ellipse_rotations(np.ascontiguousarray(normals[at].T), axis)
        scales[at] = ellipse_scales(normals[at, axis], _SIZE * splat_size * grid.spacing)
    materials = np.zeros(count, np.int32) if mesh.materials is None else mesh.materials[triangles].astype(np.int32)
    arrays = {
        "positions": (places - grid.surfel_origin).astype(np.float32),
        "rotations": rotations,
        "scales": scales,
        "normals": _shading(mesh, triangles, shares, normals),
        "colors": np.empty((count, 4), np.float32),
        "materials": materials,
    }
    for name in sampler.optional:
        columns, dtype, _ = OPTIONAL_LAYOUT[name]
        arrays[name] = np.empty((count, columns) if columns > 1 else count, dtype)
    sampler.fill(arrays, _samples(mesh, sampler, tangents, triangles, shares, materials, grid.spacing))
    return {name: arrays[name] for name in (*LAYOUT, *sampler.optional)}


def _shares(corners: np.ndarray, places: np.ndarray) -> np.ndarray:
    """(k, 3) barycentric coordinates of (k, 3) places in the planes of (k, 3, 3) corners, clamped to the triangles."""
    first, second, offset = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], places - corners[:, 0]
    normal = np.cross(first, second)
    square = np.maximum(np.einsum("ij,ij->i", normal, normal), 1e-300)
    u = np.einsum("ij,ij->i", np.cross(offset, second), normal) / square
    v = np.einsum("ij,ij->i", np.cross(first, offset), normal) / square
    shares = np.clip(np.stack([1 - u - v, u, v], axis=1), 0, 1)
    return shares / shares.sum(axis=1, keepdims=True)


def _shading(mesh: TriangleMesh, triangles, shares: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """(k, 3) float32 unit shading normals; the triangle's own where the corners' have no length."""
    if mesh.corner_normals is None:
        return normals.astype(np.float32)
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        mean = _mean(mesh.corner_normals[triangles], shares)
        length = np.linalg.norm(mean, axis=1, keepdims=True)
        return np.where(np.isfinite(length) & (length > 1e-15), mean / length, normals).astype(np.float32)


def _samples(
    mesh: TriangleMesh, sampler: MaterialSampler, tangents, triangles, shares, materials, spacing: float
) -> Samples:
    colors = uvs = uv_steps = None
    if sampler.needs_colors and mesh.corner_colors is not None:
        colors = _mean(mesh.corner_colors[triangles], shares).T
    if sampler.needs_uvs and mesh.corner_uvs is not None:
        uvs = _mean(mesh.corner_uvs[triangles], shares).T
        corners, at = mesh.positions[mesh.triangles[triangles]], mesh.corner_uvs[triangles]
        lengths = (np.linalg.norm(corners[:, k] - corners[:, 0], axis=1)[:, None] for k in (1, 2))
        steps = (spacing / np.maximum(length, spacing) for length in lengths)
        uv_steps = np.stack([((at[:, k] - at[:, 0]) * step).T for k, step in zip((1, 2), steps, strict=True)])
    if tangents is not None:
        tangents = _mean(tangents[triangles], shares).T
    return Samples(materials, colors, uvs, uv_steps, tangents)


def _mean(corners: np.ndarray, shares: np.ndarray) -> np.ndarray:
    return np.einsum("nkc,nk->nc", np.asarray(corners, np.float64), shares).astype(np.float32)
