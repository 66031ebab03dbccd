# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds cards: two sheets closer than a cell that face opposite ways, as leaves, feathers and flags are often modelled.

A splat blends with what lies within its blend depth behind it, so both sides would be seen at once. Their surfels are
marked (`Surfels.hidden_back`), and opaque ones are not drawn from behind. Transparent sides are one layer, because most
are leaves with the same image: two layers of its filtered alpha would hide too much at its edges.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from ...quaternions import axes_columns
from ...runs import expand, order_of
from ..attributes.ellipses import MAX_STRETCH
from ..ldc.depth_cube import rows_of
from ..ldc.scan_conversion import Spans, batches
from ..mesh.connectivity import connectivity
from ..mesh.survey import boundary_weights
from ..mesh.triangle_mesh import TriangleMesh, corner_indices, doubled_areas, gather_corners
from ..table import SampleTable

#: Sheets are a card's sides if they are less than this far behind one another, in cells, and the cosine between their
#: normals is below this, as at the edge of a thick card: there, too, the view from behind is blocked by the other side.
_REACH, _OPPOSITE = 1.0, -0.5

#: Sides may be this far before one another, in cells: a bent card's may be divided into different triangles.
_CROSSED = 0.02

#: Samples on one ray are ordered by depth in these parts of a cell.
_PARTS = 64

#: Samples that are ordered at a time.
_BATCH = 1 << 20


def cards_of(
    images: dict[int, tuple[Spans, ...]],
    arrays: dict[int, SampleTable],
    mesh: TriangleMesh,
    spacing: float,
    deforms: bool = False,
) -> dict[int, np.ndarray]:
    """Edge of blocks -> (n,) bool, whether each of their samples is on a card; {} if none is.

    images: by the edge of the blocks that samples cover, 1 for single ones. arrays: their fields of `Surfels`.
    deforms: whether triangles will move relative to each other: then a closed part and what it touches, such as a box
        and the floor it stands on, are no card, because they may move apart.
    """
    runs, ends = ([], [], []), [0]
    for edge, of_edge in images.items():
        for axis, rows in rows_of(of_edge):
            values = {name: arrays[edge][name][rows] for name in ("positions", "rotations")}
            runs[axis].append(_runs_of(of_edge[axis], axis, edge, values, ends[-1] + rows.start, spacing))
        ends.append(ends[-1] + len(arrays[edge]["positions"]))
    are_cards = _have_other_sides(runs, mesh, ends[-1], _closed_parts(mesh) if deforms else None)
    return dict(zip(images, np.split(are_cards, ends[1:-1]), strict=True)) if are_cards.any() else {}


def mostly(are_cards: np.ndarray, images: tuple[Spans, ...], triangles: int) -> np.ndarray:
    """(triangles,) bool: whether most of the samples of a triangle are on a card."""
    numbers = np.concatenate([np.repeat(spans.triangles, spans.counts) for spans in images])
    return np.bincount(numbers, are_cards - 0.5, triangles) > 0


class _Runs(NamedTuple):
    """n runs of samples, each in a row of an image and in one triangle.

    depths: (n,) of the first samples along the image's axis, in cells. slopes: (n,) their change from sample to sample.
    numbers: (n,) of the first samples. strides: (n,) change of the number from sample to sample.
    """

    spans: Spans
    depths: np.ndarray
    slopes: np.ndarray
    numbers: np.ndarray
    strides: np.ndarray

    def take(self, some) -> _Runs:
        return _Runs(*(values[some] for values in self))


def _runs_of(spans: Spans, axis: int, edge: int, arrays: SampleTable, first: int, spacing: float) -> _Runs:
    """The samples of an image; of blocks with this edge, all cells, each with the number of its block.

    arrays: field of `Surfels` -> values at the spans' samples. first: number of the first sample.
    """
    depths = arrays["positions"][:, axis] / np.float64(spacing)
    starts = np.cumsum(spans.counts, dtype=np.int64) - spans.counts
    if edge == 1:
        slopes = (depths[starts + spans.counts - 1] - depths[starts]) / np.maximum(spans.counts - 1, 1)
        return _Runs(spans, depths[starts], slopes, first + starts, np.ones(len(spans), np.int64))
    (normals,) = axes_columns(arrays["rotations"], 2)
    across, up = (-normals[(axis + k) % 3] / normals[axis] for k in (1, 2))
    step = np.arange(edge) - edge // 2
    triangles, columns, counts, slopes, numbers = (
        np.repeat(values, edge)
        for values in (spans.triangles, spans.columns - edge // 2, edge * spans.counts, across, first + starts)
    )
    rows = (spans.rows[:, None] + step).ravel()
    depths = (depths[:, None] + up[:, None] * step - (edge // 2) * across[:, None]).ravel()
    return _Runs(Spans(triangles, rows, columns, counts), depths, slopes, numbers, np.zeros(len(rows), np.int64))


def _have_other_sides(
    images: list[list[_Runs]], mesh: TriangleMesh, count: int, of_part: np.ndarray | None
) -> np.ndarray:
    """(count,) bool: whether the samples with these numbers are on a card.

    images: for each axis, the runs of all samples. Samples that follow each other on a ray are compared.
    of_part: (T,); only triangles with the same number may be sides of a card. None: all may.
    """
    are_cards, components = np.zeros(count, bool), np.ascontiguousarray(mesh.positions.T)
    for axis, parts in enumerate(images):
        spans, *others = zip(*parts, strict=True)
        runs = _Runs(Spans.joined(list(spans)), *map(np.concatenate, others))
        runs = runs.take(order_of(runs.spans.rows - runs.spans.rows.min(initial=0)))
        for band in _bands(runs.spans):
            numbers, triangles, distances = _neighbours(runs.take(band))
            corners = (gather_corners(components, mesh.triangles[of]) for of in triangles)
            below, above = (_unit_columns(doubled_areas(of)) for of in corners)
            behind = -distances * below[axis]
            are_close = (behind > -_CROSSED) & (behind < _REACH) & ((below * above).sum(axis=0) < _OPPOSITE)
            if of_part is not None:
                are_close &= of_part.take(triangles[0]) == of_part.take(triangles[1])
            are_cards[numbers[:, are_close]] = True
    return are_cards


def _closed_parts(mesh: TriangleMesh) -> np.ndarray:
    """(T,) the number of the connected part that a triangle belongs to if that is closed, -1 otherwise."""
    parts = connectivity(mesh).parts
    boundaries = np.zeros(len(mesh.positions), np.uint64)
    np.add.at(boundaries, parts, boundary_weights(*mesh.places.take(corner_indices(mesh.triangles))))
    return np.where(boundaries.take(parts) == 0, parts, -1)


def _unit_columns(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.sqrt((vectors * vectors).sum(axis=0))


def _bands(spans: Spans) -> Iterator[slice]:
    """Slices of spans that are ordered by row; none cuts a row."""
    if not len(spans):
        return
    rows = spans.rows - spans.rows[0]
    ends = np.cumsum(np.bincount(rows))
    for part in batches(np.bincount(rows, spans.counts).astype(np.int64), _BATCH):
        yield slice(int(ends[part.start - 1]) if part.start else 0, int(ends[part.stop - 1]))


def _neighbours(runs: _Runs) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of p pairs of samples that follow each other on a ray and are close: their numbers and triangles, (2, p) each,
    and their (p,) distances along the axis."""
    spans = runs.spans
    owner, step = expand(spans.counts)
    depths = runs.depths.take(owner) + runs.slopes.take(owner) * step
    columns = spans.columns.astype(np.int64) - spans.columns.min(initial=0)
    width = int((columns + spans.counts).max(initial=0))
    rays = ((spans.rows - spans.rows.min(initial=0)).astype(np.int64) * width + columns).take(owner) + step
    parts = ((depths - depths.min(initial=0)) * _PARTS).astype(np.int64)
    bits = int(parts.max(initial=0)).bit_length()
    parts += rays << bits
    order = order_of(parts)
    rays, depths = rays.take(order), depths.take(order)
    distances = np.diff(depths)
    first = np.flatnonzero((rays[1:] == rays[:-1]) & (np.abs(distances) < _REACH * MAX_STRETCH))
    pairs = order.take(np.stack([first, first + 1]))
    of = owner.take(pairs)
    return runs.numbers.take(of) + runs.strides.take(of) * step.take(pairs), spans.triangles.take(of), distances[first]
