# SPDX-License-Identifier: GPL-3.0-or-later
"""Adds surfels along borders that clipped surfels leave bare: at corners with more than two lines, in holes of a few
cells, and on faces so narrow that no ray hit them and only neighbouring splats covered them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...runs import expand
from ...surfels import LAYOUT
from ..attributes.ellipses import ellipse_rotations, ellipse_scales
from ..ldc.grid import Grid
from ..materials.material_sampler import MaterialSampler, Samples
from ..mesh.barycentric import barycentric
from ..mesh.triangle_mesh import TriangleMesh
from ..table import SampleTable, empty_column
from .borders import Borders
from .clipping import Clipping, clip_fields, clippings
from .meetings import by_facing
from .overhang import SMALLER, TIMES

#: Distance of the places along a border that are looked at, and how far inside of it they lie, in spacings.
_STEP, _INSIDE = 0.5, 0.08

#: How far the first and the last of them are from the ends of an edge, at most: a share of it, and in spacings.
_ENDS, _TO_END = 0.02, 0.25

#: Edge of a cell of which one place is enough, in spacings.
_CELL = 0.6

#: Numbers the cells of a grid: more of them along an edge than a grid has.
_CELL_NUMBER = np.array((1, 1 << 20, 1 << 40))

#: Inside of a triangle, no farther on the way to its opposite corner than this.
_TO_CORNER = 0.3

#: A place is covered this far into an ellipse, squared.
_COVERED = 0.8

#: Bare places are looked for twice. The surfels that fill them first may become smaller this often (`overhang`),
#: which may leave some bare again; those that fill these are as small from the start.
_ROUNDS = TIMES, 0

#: How many places in a row one surfel covers, about, and its size as a share of the others': where these fail, the
#: surface is small.
_PLACES, _SIZE = 2, 0.6


def gap_surfels(
    mesh: TriangleMesh,
    borders: Borders,
    places: BorderPlaces,
    grid: Grid,
    splat_size: float,
    sampler: MaterialSampler,
    tangents: np.ndarray | None,
) -> tuple[SampleTable, np.ndarray]:
    """The arrays of `Surfels` for bare places beside the borders, clipped like the others ({} if there are none), and
    their (k,) triangles.

    places: that all other surfels have been asked about. sampler, tangents: as in `SampleFiller`.
    """
    made, parts, triangles = [], [], [np.empty(0, np.intp)]
    for times in _ROUNDS:
        side, at = places.bare()
        if not len(side):
            break
        before = sum(map(len, triangles))
        triangles.append(borders.triangles[side])
        size = splat_size * float(SMALLER) ** (TIMES - times)
        made.append(_surfels(mesh, triangles[-1], at, borders.normals[side], grid, size, sampler, tangents))
        for part in clippings(made[-1], by_facing(made[-1]), borders, grid, at_centres=False, times=times):
            places.cover(part)
            parts.append(replace(part, surfels=part.surfels + before))
    triangles = np.concatenate(triangles)
    if not made:
        return {}, triangles
    arrays = {name: np.concatenate([each[name] for each in made]) for name in made[0]}
    return arrays | clip_fields(parts, len(triangles)), triangles


class BorderPlaces:
    """Places in a straight row along each side of a border, and which of them surfels cover."""

    def __init__(self, borders: Borders, grid: Grid):
        self._borders, self._grid = borders, grid
        along = borders.end - borders.start
        length = np.linalg.norm(along, axis=1)
        self._counts = np.ceil(length / (_STEP * grid.spacing)).astype(np.int64) + 1
        self._offsets = np.cumsum(self._counts) - self._counts
        # All are moved by the same share towards the opposite corner, so that a row stays as long as its triangle is.
        height = np.einsum("ij,ij->i", borders.opposite - borders.start, borders.inward)
        part = np.minimum(_INSIDE * grid.spacing / np.maximum(height, 1e-300), _TO_CORNER)[:, None]
        share = np.minimum(_ENDS, _TO_END * grid.spacing / np.maximum(length, 1e-300))[:, None]
        ends = borders.start + along * share, borders.end - along * share
        self._ends = [place + (borders.opposite - place) * part for place in ends]
        seen = (np.stack(self._ends) - grid.surfel_origin) / grid.spacing
        # by coordinate, both ends of each row
        self._seen = np.ascontiguousarray(np.moveaxis(seen, 2, 0), np.float32)
        self._changes = np.zeros(int(self._counts.sum()) + 1, np.int64)

    def cover(self, clipping: Clipping):
        """Each surfel covers the stretch of the row that lies in its ellipse and on the kept side of its lines; at a
        reflex corner, one stretch for each line."""
        met = clipping.met
        across, up = ((met.seen.axis + k) % 3 for k in (1, 2))
        start, end = met.seen.in_circles(met.number, *(self._seen[k].take(met.side, axis=1) for k in (across, up)))
        way = end - start
        a, b, c = (way * way).sum(axis=0), (start * way).sum(axis=0), (start * start).sum(axis=0) - np.float32(_COVERED)
        root = b * b - a * c
        a = np.maximum(a, np.float32(1e-20))
        root = np.sqrt(np.maximum(root, 0, out=root), where=root > 0, out=np.full_like(root, np.nan))
        low, high = np.maximum((-b - root) / a, 0), np.minimum((-b + root) / a, 1)
        ends = [_kept_stretch(line, start, way) for line in clipping.lines]
        reflex = clipping.reflex
        both = np.maximum(ends[0][0], ends[1][0]), np.minimum(ends[0][1], ends[1][1])
        lows = np.maximum(low, np.where(reflex, ends[0][0], both[0])), np.maximum(low, ends[1][0])
        highs = np.minimum(high, np.where(reflex, ends[0][1], both[1])), np.minimum(high, ends[1][1])
        for low, high, rows in zip(lows, highs, (slice(None), np.flatnonzero(reflex)), strict=True):
            steps = (self._counts - 1).take(met.side[rows])
            with np.errstate(invalid="ignore"):
                there = np.flatnonzero(low[rows] <= high[rows])
            steps, offset = steps.take(there), self._offsets.take(met.side[rows].take(there))
            covered = np.ceil(low[rows].take(there) * steps - 1e-3), np.floor(high[rows].take(there) * steps + 1e-3)
            begin, end = (offset + place.astype(np.int64) for place in covered)
            some = begin <= end
            np.add.at(self._changes, begin.compress(some), 1)
            np.subtract.at(self._changes, end.compress(some) + 1, 1)

    def bare(self) -> tuple[np.ndarray, np.ndarray]:
        """(k,) sides of borders and (k, 3) points beside them, in their triangles, that no surfel covers."""
        bare = np.flatnonzero(np.cumsum(self._changes)[:-1] <= 0)
        side = np.searchsorted(self._offsets, bare, side="right") - 1
        share = (bare - self._offsets[side]) / np.maximum(self._counts[side] - 1, 1)
        first, last = self._ends
        places = first[side] + (last - first)[side] * share[:, None]
        # In a run of bare points use the second, the fourth, ...; if there is only one, use it.
        starts = np.append(True, (bare[1:] != bare[:-1] + 1) | (side[1:] != side[:-1])) if len(bare) else bare
        runs = np.flatnonzero(starts)
        sizes = np.diff(np.append(runs, len(bare)))
        run, number = expand(sizes)
        chosen = np.flatnonzero(number % _PLACES == np.minimum(1, sizes[run] - 1))
        # Edges far shorter than a spacing share one point: one per cell and direction.
        cells = np.floor((places[chosen] - self._grid.surfel_origin) / (_CELL * self._grid.spacing)).astype(np.int64)
        facing = np.rint(self._borders.normals[side[chosen]]).astype(np.int64) + 1
        key = (cells @ _CELL_NUMBER) * 27 + facing @ (1, 3, 9)
        _, kept = np.unique(key, return_index=True)
        chosen = chosen[np.sort(kept)]
        return side[chosen], places[chosen]


def _kept_stretch(line: np.ndarray, start: np.ndarray, way: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(m,) lowest and (m,) highest fraction of the way at which a place is on the kept side of its line."""
    value = line[0] * start[0] + line[1] * start[1] + line[2]
    rise = line[0] * way[0] + line[1] * way[1]
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = -value / rise
    low = np.where(rise > 0, crossing, np.where((rise < 0) | (value >= 0), -np.inf, np.inf))
    return low, np.where(rise < 0, crossing, np.inf)


def _surfels(mesh, triangles, places, normals, grid: Grid, splat_size, sampler: MaterialSampler, tangents):
    """The arrays of `Surfels` at (k, 3) places in k triangles with (k, 3) unit normals."""
    count = len(triangles)
    shares = barycentric(mesh, triangles, places)
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
    arrays |= {name: empty_column(name, count) for name in sampler.optional}
    sampler.fill(arrays, _samples(mesh, sampler, tangents, triangles, shares, materials, grid.spacing))
    return {name: arrays[name] for name in (*LAYOUT, *sampler.optional)}


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
