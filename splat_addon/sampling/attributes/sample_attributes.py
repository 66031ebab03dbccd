# SPDX-License-Identifier: GPL-3.0-or-later
"""Gives the samples of one layered depth image their position, ellipse, normal and material values.

Heights are computed in float64 and rounded once; what else varies is interpolated along spans (`span_weights`).
"""

from __future__ import annotations

import numpy as np

from ...normal_fields import NORMAL_FIELDS, fields_of
from ...quaternions import axes_columns
from ...runs import expand
from ..ldc.grid import Grid
from ..ldc.scan_conversion import Spans
from ..materials.material_sampler import MaterialSampler, Samples
from ..materials.texture_mapping import BORDER, axis_steps, fill_uvs
from ..mesh.triangle_mesh import TriangleMesh, corner_indices, corners_at, crossed, doubled_areas
from ..table import SampleTable
from .blend_depths import blend_depths
from .ellipses import MAX_STRETCH, ellipse_rotations, ellipse_scales
from .lifts import lifts
from .span_weights import Lines, SpanWeights, grouped
from .texture_seams import border_lines

#: A projected triangle that is smaller than its snapped twin by this factor, or flipped, has no usable barycentrics of
#: its own.
_LEAST_AREA_RATIO = 1e-6
#: Squared lengths in this range are safe divisors in float32.
_USABLE_SQUARES = (1e-30, 1e30)
#: Corner values of a mesh may be infinite or NaN; the result is checked, so intermediate warnings are suppressed.
_quietly = np.errstate(over="ignore", invalid="ignore")


class SampleFiller:
    """Fills rows of preallocated arrays, span by span.

    mesh: usable triangles. coordinates: (3, V) float64 grid coordinates of its vertices. half_size: of a splat, object
        units.
    sampler: evaluates the mesh's materials. bends: two (T,) arrays for `blend_depths`, or None. bulges: of `lifts`, or
        None.
    tangents: (T, 3, 4 layers) at its corners, in the layout of `Samples`, or None. seams: of `seam_edges`, or None.
    arrays: the table to fill.
    """

    def __init__(
        self,
        mesh: TriangleMesh,
        coordinates: np.ndarray,
        grid: Grid,
        half_size: float,
        sampler: MaterialSampler,
        tangents: np.ndarray | None,
        seams: np.ndarray | None,
        bends: tuple[np.ndarray, np.ndarray] | None,
        bulges: np.ndarray | None,
        arrays: SampleTable,
    ):
        self._mesh, self._coordinates, self._grid = mesh, coordinates, grid
        self._half_size, self._sampler, self._tangents, self._arrays = half_size, sampler, tangents, arrays
        self._seams, self._bends, self._bulges = seams, bends, bulges
        self._centres = [grid.centres(axis) for axis in range(3)]

    def order(self, spans: Spans) -> np.ndarray | None:
        """The order in which spans are filled fastest: graphs of nodes take less time for many samples of one material
        than for a few of many. None: as they are."""
        materials = self._mesh.materials
        if materials is None or not self._sampler.has_graphs:
            return None
        of_spans = materials.take(spans.triangles)
        return None if (of_spans[1:] >= of_spans[:-1]).all() else of_spans.argsort(kind="stable")

    def fill(self, spans: Spans, axis: int, rows: slice | np.ndarray):
        """Write the samples of these spans of the image along `axis` to `rows` of the arrays."""
        out = {name: array[rows] for name, array in self._arrays.items()}
        self._fill(out, spans, axis)
        if not isinstance(rows, slice):
            for name, array in self._arrays.items():
                array[rows] = out[name]

    def _fill(self, out: SampleTable, spans: Spans, axis: int):
        triangles, of_span = grouped(spans.triangles)
        first, edges, normals = self._sound_triangles(triangles, axis)
        weights = SpanWeights(first, edges, normals[axis], axis, of_span, spans)
        span, step = expand(spans.counts)
        line = Lines(span, step)
        triangle = span if of_span is None else of_span.take(span)

        column = spans.columns.take(span)
        column += step
        u, v = (axis + 1) % 3, (axis + 2) % 3
        out["positions"][:, u] = self._centres[u].take(column)
        out["positions"][:, v] = self._centres[v].take(spans.rows).take(span)
        spacing = self._grid.spacing
        ends = weights.interpolate(self._grid.places(first[axis], axis), *(edges[axis] * spacing))
        out["positions"][:, axis] = line.samples(*ends)

        normals *= 1 / np.sqrt(_squares(normals))
        _write_rows(ellipse_rotations(normals, axis), triangle, out["rotations"])
        _write_rows(ellipse_scales(normals[axis], self._half_size), triangle, out["scales"])
        if self._bends is not None:
            longest = self._half_size / np.abs(normals[axis]).clip(1 / MAX_STRETCH)
            _write_rows(
                blend_depths(*(of.take(triangles) for of in self._bends), longest), triangle, out["blend_depth"]
            )
        if self._mesh.corner_normals is None:
            _write_rows(np.ascontiguousarray(normals.T, np.float32), triangle, out["normals"])
        else:
            vectors = self._samples(self._mesh.corner_normals, triangles, weights, line)
            _write_unit(vectors, normals, triangle, out["normals"])
            if NORMAL_FIELDS[0] in out:
                steps = axis_steps(out, axis, spacing)
                self._fill_normal_fields(out, vectors, triangles, triangle, weights, steps)
        if self._bulges is not None:
            of_triangles = self._bulges.take(triangles, axis=1).take(triangle, axis=1)
            out["rise"][...] = lifts(weights.at_samples(line), of_triangles)
        samples = self._paint(out, triangles, triangle, weights, line)
        if "uvs" in out:
            steps = axis_steps(out, axis, spacing)
            fill_uvs(out, self._mesh.surfaces, samples, steps)
            out[BORDER][...] = 0
            if self._seams is not None:
                at_samples = weights.at_samples(line), weights.changes(steps, triangle)
                out[BORDER][...] = border_lines(self._seams.take(triangles, axis=0).take(triangle, axis=0), *at_samples)

    @_quietly
    def _fill_normal_fields(self, out, vectors, triangles, triangle, weights: SpanWeights, steps: np.ndarray):
        """Write how normals change along the half-axes. vectors: (3, n) normals as interpolated. steps: of
        `axis_steps`."""
        corners = _at_corners(self._mesh.corner_normals, triangles)
        per_step = weights.gradients(corners.swapaxes(0, 1)).take(triangle, axis=2)
        size = 1 / np.sqrt(_squares(vectors))
        axes = axes_columns(out["rotations"], 0, 1, 2)
        along = tuple((per_step[0] * columns + per_step[1] * rows) * size for columns, rows in steps)
        for name, values in fields_of(out["normals"].T, along, axes).items():
            out[name][...] = values

    @_quietly
    def _paint(
        self, out: dict, triangles: np.ndarray, triangle: np.ndarray, weights: SpanWeights, line: Lines
    ) -> Samples:
        mesh, sampler = self._mesh, self._sampler
        if mesh.materials is None:
            out["materials"][...] = 0
        else:
            out["materials"][...] = mesh.materials.take(triangles).take(triangle)
        colors = color_steps = uvs = uv_steps = tangents = None
        if sampler.needs_colors and mesh.corner_colors is not None:
            colors = self._samples(mesh.corner_colors, triangles, weights, line)
            if sampler.needs_color_steps:
                color_steps = self._steps(mesh.corner_colors, triangles, weights, triangle)
        if sampler.needs_uvs and mesh.corner_uvs is not None:
            uvs = self._samples(mesh.corner_uvs, triangles, weights, line)
            uv_steps = self._steps(mesh.corner_uvs, triangles, weights, triangle)
        if self._tangents is not None:
            tangents = self._samples(self._tangents, triangles, weights, line)
        samples = Samples(out["materials"], colors, uvs, uv_steps, tangents, color_steps)
        sampler.fill(out, samples)
        return samples

    @staticmethod
    def _steps(corner_values: np.ndarray, triangles: np.ndarray, weights: SpanWeights, triangle) -> np.ndarray:
        """(2, c, n) change of (T, 3, c) corner values per column and per row."""
        return weights.gradients(_at_corners(corner_values, triangles).swapaxes(0, 1)).take(triangle, axis=2)

    @_quietly
    def _samples(
        self, corner_values: np.ndarray, triangles: np.ndarray, weights: SpanWeights, line: Lines
    ) -> np.ndarray:
        """(c, n) float32 values interpolated from (T, 3, c) corner values."""
        components = _at_corners(corner_values, triangles)
        result = np.empty((len(components), line.count), np.float32)
        for (a, b, c), row in zip(components, result, strict=True):
            line.samples(*weights.interpolate(a, b - a, c - a), out=row)
        return result

    def _sound_triangles(self, triangles: np.ndarray, axis: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Per triangle: (3, t) first corners on the grid, (3, 2, t) edges to the other corners and (3, t) normals of
        any length.

        A triangle that projects to (nearly) nothing can gain area once its corners are snapped, and its own
        barycentrics would be infinite. For such triangles everything is
        computed from the snapped corners.
        """
        corners = corners_at(self._coordinates, corner_indices(self._mesh.triangles.take(triangles, axis=0)))
        edges = corners[:, 1:] - corners[:, :1]
        normals = crossed(edges)
        poor = self._poor(corners, edges, normals[axis], axis)
        if len(poor):
            corners[:, :, poor] = self._grid.snapped(corners[:, :, poor]) / self._grid.subcells
            edges[:, :, poor] = corners[:, 1:, poor] - corners[:, :1, poor]
            normals[:, poor] = crossed(edges[:, :, poor])
        return corners[:, 0], edges, normals

    def _poor(self, corners: np.ndarray, edges: np.ndarray, areas: np.ndarray, axis: int) -> np.ndarray:
        """The triangles whose (t,) projected area is dwarfed by the error of snapping, or flipped by it."""
        # Snapping changes no component of an edge by more than 1 / subcells, so most triangles pass this cheap test.
        longest = max(np.abs(edges[(axis + k) % 3]).max(initial=0) for k in (1, 2))
        poor = np.flatnonzero(~(np.abs(areas) * (self._grid.subcells / 2) > 4 * longest + 1))
        if not len(poor):
            return poor
        snapped = self._grid.snapped(corners.take(poor, axis=2))
        snapped_areas = doubled_areas(snapped)[axis]
        least = np.abs(snapped_areas) * (_LEAST_AREA_RATIO / self._grid.subcells**2)
        return poor[~(areas.take(poor) * np.sign(snapped_areas) > least)]


def _at_corners(values: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """(c, 3, t) float32: corner values of t triangles from (T, 3, c), each component contiguous."""
    rows = values.reshape(len(values), -1).take(triangles, axis=0)
    return np.ascontiguousarray(rows.T.reshape(3, -1, len(triangles)).swapaxes(0, 1), np.float32)


def _squares(vectors: np.ndarray) -> np.ndarray:
    """(n,) squared lengths of (3, n) vectors."""
    squares = vectors[0] * vectors[0]
    squares += vectors[1] * vectors[1]
    squares += vectors[2] * vectors[2]
    return squares


def _write_rows(rows: np.ndarray, owner: np.ndarray, out: np.ndarray):
    np.take(rows, owner, axis=0, out=out, mode="clip")


def _write_unit(vectors: np.ndarray, fallbacks: np.ndarray, owner: np.ndarray, out: np.ndarray):
    """Normalise (3, n) vectors into (n, 3) `out`; vectors without usable length become their owner's of (3, t)
    fallbacks."""
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        squares = _squares(vectors)
        inverse = 1 / np.sqrt(squares)
        for column, component in zip(out.T, vectors, strict=True):
            np.multiply(component, inverse, out=column)
    low, high = _USABLE_SQUARES
    if not (squares.min() > low and squares.max() < high):
        poor = np.flatnonzero(~((squares > low) & (squares < high)))
        out[poor] = fallbacks.T[owner[poor]]
