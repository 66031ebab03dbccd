# SPDX-License-Identifier: GPL-3.0-or-later
"""Barycentric weights along the spans of a layered depth image, and what is interpolated with them.

Everything that varies is linear along a span. Weights are therefore computed at the two ends of a span, in float64 and
clamped into the triangle. Each sample then costs one multiply and add per component in float32.
"""

from __future__ import annotations

import numpy as np

from ..ldc.scan_conversion import Spans

#: Up to this many spans per triangle, recomputing triangle values for each span is cheaper than indexing shared ones.
_FEW_SPANS = 1.3


class SpanWeights:
    """Barycentric weights of corners 1 and 2 at each span's first sample, and their change per sample.

    first, edges, areas: of t triangles: (3, t) first corners on the grid, (3, 2, t) edges to the other corners, and
        (t,) the component of their normals along the axis. of_span: (n,) index of each span's triangle, from `grouped`.
    Both ends are moved to the nearest point of the triangle: on the snapped outline a sample can lie 0.71 of a sub-cell
    outside the real triangle. Clamping the weights themselves could move it arbitrarily far along a sliver.
    """

    def __init__(
        self,
        first: np.ndarray,
        edges: np.ndarray,
        areas: np.ndarray,
        axis: int,
        of_span: np.ndarray | None,
        spans: Spans,
    ):
        self._of_span = of_span
        (u, v), ((u1, u2), (v1, v2)) = ([rows[(axis + k) % 3] for k in (1, 2)] for rows in (first, edges))
        inverse = 1 / areas
        negative = -inverse
        #: Change of the two weights per column and per row: (2, t) each.
        self._per_column, self._per_row = np.empty_like(edges[0]), np.empty_like(edges[0])
        parts = (*self._per_column, *self._per_row)
        for part, (edge, factor) in zip(
            parts, ((v2, inverse), (v1, negative), (u2, negative), (u1, inverse)), strict=True
        ):
            np.multiply(edge, factor, out=part)
        column, row = spans.columns - _spread(u, of_span), spans.rows - _spread(v, of_span)
        along = _spread(self._per_column, of_span)
        start = _spread(self._per_row, of_span) * row
        start += along * column
        steps = spans.counts - 1.0
        end = along * steps
        end += start
        sides = u1, v1, u2, v2
        self._first = _moved_inside(start, column, row, sides, of_span)
        self._step = _moved_inside(end, column + steps, row, sides, of_span)
        self._step -= self._first
        self._step /= np.maximum(steps, 1)
        self._rounded = self._first.astype(np.float32), self._step.astype(np.float32)

    def interpolate(self, value: np.ndarray, *rises: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(n,) first value and (n,) step along each span, in the values' dtype.

        value: (t,) float32 or float64, at corner 0. rises: two (t,) arrays, the differences to corners 1 and 2.
        """
        firsts, steps = (self._first, self._step) if value.dtype == np.float64 else self._rounded
        value, second, third = (_spread(row, self._of_span) for row in (value, *rises))
        start, step = value + second * firsts[0], second * steps[0]
        start += third * firsts[1]
        step += third * steps[1]
        return start, step

    def at_samples(self, line: Lines) -> np.ndarray:
        """(3, n) float32 weights of the corners."""
        zero, one = (np.full(self._per_column.shape[1], value, np.float32) for value in (0, 1))
        second, third = (line.samples(*self.interpolate(zero, *rises)) for rises in ((one, zero), (zero, one)))
        return np.stack([1 - second - third, second, third])

    def changes(self, steps: np.ndarray, triangle: np.ndarray) -> np.ndarray:
        """(3, 2, n) change of the weights along the half-axes, which are given as (2, 2, n) `steps` in columns and
        rows."""
        per_step = np.stack([self._per_column, self._per_row]).take(triangle, axis=2)
        rest = np.einsum("akn,kwn->wan", steps, per_step)
        return np.concatenate([-rest.sum(axis=0, keepdims=True), rest])

    def gradients(self, corners: np.ndarray) -> np.ndarray:
        """(2, c, t) change of (3, c, t) corner values per column and per row."""
        first, second = corners[1] - corners[0], corners[2] - corners[0]
        return np.stack([first * w[0] + second * w[1] for w in (self._per_column, self._per_row)])


class Lines:
    """The samples of spans: the span each belongs to, and its index along the span."""

    def __init__(self, span: np.ndarray, step: np.ndarray):
        self.count = len(span)
        self._span = span
        self._steps = {np.dtype(kind): step.astype(kind) for kind in (np.float32, np.float64)}

    def samples(self, first: np.ndarray, step: np.ndarray, out: np.ndarray | None = None) -> np.ndarray:
        """(count,) values that start at (n,) `first` and change by (n,) `step`, float32 or float64."""
        values = step.take(self._span, out=out, mode="clip")
        values *= self._steps[step.dtype]
        values += first.take(self._span)
        return values


def grouped(ordered: np.ndarray) -> tuple[np.ndarray, np.ndarray | None]:
    """The distinct values of an ascending array, and the index of each entry among them. If few values repeat, the
    array itself and None, meaning that each entry stands for itself."""
    is_new = np.empty(len(ordered), bool)
    is_new[:1] = True
    np.not_equal(ordered[1:], ordered[:-1], out=is_new[1:])
    if len(ordered) <= _FEW_SPANS * np.count_nonzero(is_new):
        return ordered, None
    place = np.cumsum(is_new)
    place -= 1
    return ordered.take(np.flatnonzero(is_new)), place


def _spread(values: np.ndarray, owner: np.ndarray | None) -> np.ndarray:
    """(..., n) values expanded from (..., t) by the owners of `grouped`; the result must not be modified."""
    return values if owner is None else values.take(owner, axis=-1)


def _moved_inside(
    weights: np.ndarray, column: np.ndarray, row: np.ndarray, sides: tuple[np.ndarray, ...], owner: np.ndarray | None
) -> np.ndarray:
    """Move (2, n) barycentric weights that lie outside to the nearest point of the triangle, in place.

    column, row: (n,) place in the image, relative to corner 0.
    sides: (t,) each, u and v of the edges from corner 0 to the other two corners.
    owner: (n,) each sample's triangle, from `grouped`.
    """
    w1, w2 = weights
    outside = np.flatnonzero((w1 < 0) | (w2 < 0) | (w1 + w2 > 1))
    if not len(outside):
        return weights
    u1, v1, u2, v2 = (_spread(side, owner).take(outside) for side in sides)
    x, y = column.take(outside), row.take(outside)
    along1, off1 = _nearest_on_segment(x, y, u1, v1)
    along2, off2 = _nearest_on_segment(x, y, u2, v2)
    between, off = _nearest_on_segment(x - u1, y - v1, u2 - u1, v2 - v1)
    on1, on2 = (off1 <= off2) & (off1 <= off), off2 <= off
    w1[outside] = np.where(on1, along1, np.where(on2, 0, 1 - between))
    w2[outside] = np.where(on1, 0, np.where(on2, along2, between))
    return weights


def _nearest_on_segment(x: np.ndarray, y: np.ndarray, u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Fraction of the way from (0, 0) to (u, v) at which (x, y) is nearest, and its squared distance from that
    point."""
    share = np.clip((x * u + y * v) / np.maximum(u * u + v * v, np.finfo(np.float64).tiny), 0, 1)
    return share, (x - share * u) ** 2 + (y - share * v) ** 2
