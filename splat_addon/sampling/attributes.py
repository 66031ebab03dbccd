# SPDX-License-Identifier: GPL-3.0-or-later
"""Gives the samples of one layered depth image their position, ellipse, normal, material and what it is made of.

Everything that varies is linear along a span. So the barycentric weights are worked out at a span's two ends, in
float64 and clamped into the triangle, and a sample costs one multiply and add a component, in float32.
"""

from __future__ import annotations

import numpy as np

from .ellipses import ellipse_rotations, ellipse_scales
from .grid import Grid
from .mesh import TriangleMesh, doubled_areas, gather_corners
from .palette import Palette, Samples
from .scan_conversion import Spans, expand

#: A projected triangle this much smaller than its snapped twin, or turned over, has no usable barycentrics of its own.
_LEAST_AREA_RATIO = 1e-6

#: Squared lengths between these are safe to divide by in float32.
_USABLE_SQUARES = (1e-30, 1e30)


#: What a mesh stores at its corners may be infinite or NaN; the result is looked at, so the way there need not warn.
_quietly = np.errstate(over="ignore", invalid="ignore")


class SampleFiller:
    """Fills the rows of preallocated arrays, span after span.

    mesh: usable. coordinates: (3, V) float64, of its vertices on the grid. half_size: of a splat, object units.
    palette: of the mesh. tangents: (T, 3, 4 layers) at its corners, as `Samples` has them, or None.
    arrays: field of `Surfels` -> array to fill.
    """

    def __init__(
        self,
        mesh: TriangleMesh,
        coordinates: np.ndarray,
        grid: Grid,
        half_size: float,
        palette: Palette,
        tangents: np.ndarray | None,
        arrays: dict[str, np.ndarray],
    ):
        self._mesh, self._coordinates, self._grid = mesh, coordinates, grid
        self._half_size, self._palette, self._tangents, self._arrays = half_size, palette, tangents, arrays
        self._centres = grid.centres()

    def fill(self, spans: Spans, axis: int, rows: slice):
        """Writes the samples of these spans of the image along `axis` to `rows` of the arrays."""
        out = {name: array[rows] for name, array in self._arrays.items()}
        triangles, of_span = _distinct(spans.triangles)
        corners, normals = self._sound_corners(triangles, axis)
        u, v, depth = (corners[(axis + k) % 3] for k in (1, 2, 0))
        weights = _SpanWeights(u, v, of_span, spans)
        span, step = expand(spans.counts)
        line = _Lines(span, step)
        triangle = of_span.take(span)

        out["positions"][:, (axis + 1) % 3] = self._centres.take(spans.columns.take(span) + step)
        out["positions"][:, (axis + 2) % 3] = self._centres.take(spans.rows).take(span)
        heights = (depth + 0.5) * self._grid.spacing
        out["positions"][:, axis] = line.samples(*weights.interpolate(heights))

        _spread(ellipse_rotations(normals, axis), triangle, out["rotations"])
        _spread(ellipse_scales(normals[axis], self._half_size), triangle, out["scales"])

        face_normals = np.ascontiguousarray(normals.T, np.float32)
        if self._mesh.corner_normals is None:
            _spread(face_normals, triangle, out["normals"])
        else:
            vectors = self._samples(self._mesh.corner_normals[triangles], weights, line)
            _write_unit(vectors, face_normals, triangle, out["normals"])
        self._paint(out, triangles, triangle, weights, line)

    @_quietly
    def _paint(self, out: dict, triangles: np.ndarray, triangle: np.ndarray, weights: _SpanWeights, line: _Lines):
        mesh, palette = self._mesh, self._palette
        if mesh.materials is None:
            out["materials"][...] = 0
        else:
            out["materials"][...] = mesh.materials[triangles].take(triangle)
        colors = uvs = uv_steps = tangents = None
        if palette.needs_colors and mesh.corner_colors is not None:
            colors = self._samples(mesh.corner_colors[triangles], weights, line)
        if palette.needs_uvs and mesh.corner_uvs is not None:
            corner_uvs = mesh.corner_uvs[triangles]
            uvs = self._samples(corner_uvs, weights, line)
            uv_steps = weights.gradients(np.moveaxis(corner_uvs, 0, 2)).take(triangle, axis=2)
        if self._tangents is not None:
            tangents = self._samples(self._tangents[triangles], weights, line)
        palette.fill(out, Samples(out["materials"], colors, uvs, uv_steps, tangents))

    @_quietly
    def _samples(self, corner_values: np.ndarray, weights: _SpanWeights, line: _Lines) -> np.ndarray:
        """(c, n) float32 interpolated values of (t, 3, c) ones at the corners."""
        values = np.ascontiguousarray(np.moveaxis(corner_values, 0, 2), np.float32)
        result = np.empty((values.shape[1], line.count), np.float32)
        for component, row in enumerate(result):
            row[...] = line.samples(*weights.interpolate(values[:, component]))
        return result

    def _sound_corners(self, triangles: np.ndarray, axis: int) -> tuple[np.ndarray, np.ndarray]:
        """(3, 3, t) corners on the grid and (3, t) unit normals: the real ones, or snapped ones where those are flat.

        A triangle that projects to (nearly) nothing can open up once its corners are snapped; its own barycentrics
        would be infinite (facts/sampling.md section 1, the trap).
        """
        corners = gather_corners(self._coordinates, self._mesh.triangles[triangles])
        normals = doubled_areas(corners)
        u, v = (self._grid.snapped(corners[(axis + k) % 3]) for k in (1, 2))
        snapped_area = (u[1] - u[0]) * (v[2] - v[0]) - (v[1] - v[0]) * (u[2] - u[0])
        least = snapped_area * (_LEAST_AREA_RATIO / self._grid.subcells**2)
        poor = np.flatnonzero(~(normals[axis] * np.sign(snapped_area) > np.abs(least)))
        if len(poor):
            corners[:, :, poor] = self._grid.snapped(corners[:, :, poor]) / self._grid.subcells
            normals[:, poor] = doubled_areas(corners[:, :, poor])
        x, y, z = normals
        normals /= np.sqrt(x * x + y * y + z * z)
        return corners, normals


class _SpanWeights:
    """Barycentric weights of corners 1 and 2 at each span's first sample, and their change from one sample to the next.

    u, v: (3, t) corners on the image's grid. of_span: (n,) each span's triangle among the t.
    Both ends are clamped into the triangle: on the snapped outline a sample can lie 1 / subcells outside the real one.
    """

    def __init__(self, u: np.ndarray, v: np.ndarray, of_span: np.ndarray, spans: Spans):
        self._of_span = of_span
        u1, u2, v1, v2 = u[1] - u[0], u[2] - u[0], v[1] - v[0], v[2] - v[0]
        area = u1 * v2 - v1 * u2
        #: Change of the two weights per column and per row: (2, t) each.
        self._per_column = np.stack([v2, -v1]) / area
        self._per_row = np.stack([-u2, u1]) / area
        du = spans.columns - u[0].take(of_span)
        dv = spans.rows - v[0].take(of_span)
        along = self._per_column.take(of_span, axis=1)
        start = du * along + dv * self._per_row.take(of_span, axis=1)
        steps = spans.counts - 1
        stop = _clamped(start + steps * along)
        self._first = _clamped(start)
        self._step = (stop - self._first) / np.maximum(steps, 1)

    def interpolate(self, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(n,) float32 first value and (n,) float32 step of a (3, t) quantity along each span."""
        first, second = ((corners[k] - corners[0]).take(self._of_span) for k in (1, 2))
        start = corners[0].take(self._of_span) + first * self._first[0] + second * self._first[1]
        return start.astype(np.float32), (first * self._step[0] + second * self._step[1]).astype(np.float32)

    def gradients(self, corners: np.ndarray) -> np.ndarray:
        """(2, c, t) change of (3, c, t) corner values from one column, and from one row, to the next."""
        first, second = corners[1] - corners[0], corners[2] - corners[0]
        return np.stack([first * w[0] + second * w[1] for w in (self._per_column, self._per_row)])


class _Lines:
    """The samples of spans: which span each belongs to, and its place along it."""

    def __init__(self, span: np.ndarray, step: np.ndarray):
        self.count = len(span)
        self._span, self._step = span, step.astype(np.float32)

    def samples(self, first: np.ndarray, step: np.ndarray) -> np.ndarray:
        """(count,) float32 values that start at (n,) `first` and change by (n,) `step`."""
        values = step.take(self._span)
        values *= self._step
        values += first.take(self._span)
        return values


def _distinct(ordered: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The distinct values of an ascending array, and which of them each entry is."""
    is_new = np.concatenate([[True], ordered[1:] != ordered[:-1]])
    return ordered[is_new], np.cumsum(is_new) - 1


def _clamped(weights: np.ndarray) -> np.ndarray:
    weights = np.clip(weights, 0, 1)
    weights /= np.maximum(weights[0] + weights[1], 1)
    return weights


def _spread(rows: np.ndarray, owner: np.ndarray, out: np.ndarray):
    np.take(rows, owner, axis=0, out=out, mode="clip")


def _write_unit(vectors: np.ndarray, fallbacks: np.ndarray, owner: np.ndarray, out: np.ndarray):
    """Normalises (3, n) vectors into (n, 3) `out`; one of no usable length becomes its owner's fallback."""
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        squares = vectors[0] * vectors[0] + vectors[1] * vectors[1] + vectors[2] * vectors[2]
        inverse = 1 / np.sqrt(squares)
        for column, component in enumerate(vectors):
            out[:, column] = component * inverse
    low, high = _USABLE_SQUARES
    poor = np.flatnonzero(~((squares > low) & (squares < high)))
    out[poor] = fallbacks[owner[poor]]
