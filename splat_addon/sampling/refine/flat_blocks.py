# SPDX-License-Identifier: GPL-3.0-or-later
"""Inside flat faces, one large surfel replaces 9 or 81 samples.

Model only what a scene requires: a floor needs small surfels at its border, not inside. Blocks of an image's grid whose
samples, and those in a ring around them, all lie in one flat face (`flat_faces`) become one sample at their middle,
which is a sample of the grid as well. `adaptive` also merges what is not flat, within a tolerance.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ...large_surfels import LARGE_SIZE, STEPS_OF_LARGE
from ...runs import expand, order_of, steps
from ..ldc.scan_conversion import Spans

#: Edge of a block in cells, an odd number -> cells around it that must lie in the same face, because its splat reaches
#: over them. `fitted_planes` tilts only samples that are nearer to the face's edges.
BLOCKS = {edge: math.ceil((LARGE_SIZE - 0.5) * edge) for edge in STEPS_OF_LARGE}
#: Edge of the largest block, and how many rows around it decide whether there is one.
LARGEST, RING = max(BLOCKS), max(BLOCKS.values())
#: Cells that a face with a block has at least.
LEAST_AREA = min(edge + 2 * ring for edge, ring in BLOCKS.items()) ** 2

#: The spans of each image's large samples, by the edge of their blocks.
Large = dict[int, tuple[Spans, ...]]


def divided(
    images: tuple[Spans, ...], faces: np.ndarray, crossed: list[np.ndarray] | None = None
) -> tuple[tuple[Spans, ...], Large]:
    """The samples that stay small, and the large ones that replace the others.

    images: spans, ordered by triangle. faces: (T,) from `flat_faces`. crossed: for each image, (3, c) triangles, rows
    and columns of cells at which faces end, too.
    """
    crossed = [np.empty((3, 0), np.int64)] * len(images) if crossed is None else crossed
    parts = [_divided(spans, faces, cells) for spans, cells in zip(images, crossed, strict=True)]
    large = {edge: tuple(of_edge[edge] for _, of_edge in parts) for edge in BLOCKS}
    return tuple(small for small, _ in parts), large


class _Runs(NamedTuple):
    """n runs, each in columns first..stop of a row of a face. In a row, none overlap."""

    faces: np.ndarray
    rows: np.ndarray
    first: np.ndarray
    stop: np.ndarray

    def take(self, some: np.ndarray) -> _Runs:
        return _Runs(*(values[some] for values in self))


def _divided(spans: Spans, faces: np.ndarray, crossed: np.ndarray) -> tuple[Spans, dict[int, Spans]]:
    cells = _Cells(spans, faces.take(spans.triangles))
    joined = _without(cells.joined(), np.stack([faces.take(crossed[0]), *crossed[1:]]))
    blocks = {edge: _blocks(joined, edge, ring) for edge, ring in sorted(BLOCKS.items())}
    if not any(len(runs.rows) for runs in blocks.values()):
        return spans, {edge: Spans.joined([]) for edge in BLOCKS}
    levels = {1: cells.runs, **blocks}
    for edge, wider in pairwise(levels):
        levels[edge] = _outside(levels[edge], levels[wider], wider // edge)
    made = {edge: cells.spans(runs, edge) for edge, runs in levels.items()}
    small = Spans.joined([spans[cells.others], made.pop(1)])
    return small[np.argsort(small.triangles, kind="stable")], made


class _Cells:
    """The cells of flat faces in one image, and which triangle each is in.

    runs: spans of flat faces, ordered by face, row and column. others: indices of all other spans, which include those
    in rows in which a face lies over itself. faces: (n,) of each span, or -1.
    """

    def __init__(self, spans: Spans, faces: np.ndarray):
        self._low, self._bottom = (int(values.min(initial=0)) for values in (spans.columns, spans.rows))
        self._width = int((spans.columns + spans.counts).max(initial=0)) - self._low + 1
        self._height = int(spans.rows.max(initial=0)) - self._bottom + 1
        some = np.flatnonzero(faces >= 0)
        order = some.take(order_of(self._keys(faces.take(some), spans.rows.take(some), spans.columns.take(some))))
        lines = self._lines(faces.take(order), spans.rows.take(order))
        first = spans.columns.take(order).astype(np.int64)
        is_folded = (lines[1:] == lines[:-1]) & (first[1:] < (first + spans.counts.take(order))[:-1])
        if is_folded.any():
            order = order[~np.isin(lines, lines[1:][is_folded])]
            first = spans.columns.take(order).astype(np.int64)
        self.runs = _Runs(faces.take(order), spans.rows.take(order), first, first + spans.counts.take(order))
        self.others = np.setdiff1d(np.arange(len(spans)), order, assume_unique=True)
        self._triangles, self._starts = spans.triangles.take(order), self._keys(*self.runs[:3])

    def joined(self) -> _Runs:
        """The runs, as one where they touch."""
        faces, rows, first, stop = self.runs
        touch = (faces[1:] == faces[:-1]) & (rows[1:] == rows[:-1]) & (first[1:] == stop[:-1])
        is_first, is_last = np.ones((2, len(first)), bool)
        is_first[1:] = is_last[:-1] = ~touch
        return _Runs(faces[is_first], rows[is_first], first[is_first], stop[is_last])

    def spans(self, runs: _Runs, edge: int) -> Spans:
        """The cells in runs of single cells, as spans in the order of their triangles; or those at the middles of runs
        of blocks, a span each."""
        rows, columns, counts, faces = runs.rows, runs.first, runs.stop - runs.first, runs.faces
        if edge > 1:
            faces, rows, columns = (np.repeat(values, counts) for values in (faces, rows, columns))
            columns = columns + steps(counts)
            rows, columns = edge * rows + edge // 2, edge * columns + edge // 2
            counts = np.ones(len(columns), np.int64)
        triangles = self._triangles.take(np.searchsorted(self._starts, self._keys(faces, rows, columns), "right") - 1)
        order = np.lexsort((columns, rows, triangles))
        return Spans(*(values.take(order).astype(np.int32) for values in (triangles, rows, columns, counts)))

    def _lines(self, faces: np.ndarray, rows: np.ndarray) -> np.ndarray:
        return faces.astype(np.int64) * self._height + (rows - self._bottom)

    def _keys(self, faces: np.ndarray, rows: np.ndarray, columns: np.ndarray) -> np.ndarray:
        return self._lines(faces, rows) * self._width + (columns - self._low)


def _blocks(runs: _Runs, edge: int, ring: int) -> _Runs:
    """Runs of blocks all of whose cells, and those of the ring, are in one face; rows and columns in blocks."""
    runs = runs.take(runs.stop - runs.first >= edge + 2 * ring)
    first, stop = -(-(runs.first + ring) // edge), (runs.stop - ring) // edge
    # The rows of blocks that each row is in or beside.
    lowest, highest = -(-(runs.rows - ring - edge + 1) // edge), (runs.rows + ring) // edge
    owner, step = expand((highest - lowest + 1) * (stop > first))
    of_rows = _Runs(runs.faces[owner], lowest[owner] + step, first[owner], stop[owner])
    return _where(of_rows, np.ones(len(owner), np.int64), edge + 2 * ring)


def _outside(runs: _Runs, blocks: _Runs, edge: int) -> _Runs:
    """The parts of runs outside of blocks with this edge, all of which lie in them."""
    rows = (edge * blocks.rows[:, None] + np.arange(edge)).ravel()
    faces, first, stop = (np.repeat(values, edge) for values in (blocks.faces, edge * blocks.first, edge * blocks.stop))
    both = _Runs(*map(np.concatenate, zip(runs, (faces, rows, first, stop), strict=True)))
    return _where(both, np.repeat([1, -1], [len(runs.rows), len(rows)]), 1)


def _without(runs: _Runs, cells: np.ndarray) -> _Runs:
    """The parts of runs outside of cells. cells: (3, c) of face, row and column."""
    faces, rows, columns = np.unique(cells[:, cells[0] >= 0], axis=1)
    if not len(faces):
        return runs
    both = _Runs(*map(np.concatenate, zip(runs, (faces, rows, columns, columns + 1), strict=True)))
    return _where(both, np.repeat([1, -1], [len(runs.rows), len(rows)]), 1)


def _where(runs: _Runs, values: np.ndarray, total: int) -> _Runs:
    """The runs between ends of runs, in the same row, where (n,) values of the runs there add up to this total."""
    faces, rows = (np.concatenate([each, each]) for each in (runs.faces, runs.rows))
    columns, changes = np.concatenate([runs.first, runs.stop]), np.concatenate([values, -values])
    order = np.lexsort((columns, rows, faces))
    faces, rows, columns = faces.take(order), rows.take(order), columns.take(order)
    at = np.flatnonzero((np.cumsum(changes.take(order))[:-1] == total) & (columns[1:] > columns[:-1]))
    return _Runs(faces.take(at), rows.take(at), columns.take(at), columns.take(at + 1))
