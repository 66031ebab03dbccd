# SPDX-License-Identifier: GPL-3.0-or-later
"""Inside flat triangles, one large surfel replaces 9 or 81 samples.

Model only what a scene requires: a floor of two triangles needs small surfels at its border, not inside. Blocks of an
image's grid whose samples, and those in a ring around them, all lie in one triangle become one sample at their middle,
which is a sample of the grid as well. They show and bend exactly as the triangle does, whatever it is deformed to.
`adaptive` also merges across triangles, within a tolerance.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ...large_surfels import LARGE_SIZE, STEPS_OF_LARGE
from ..attributes.lifts import LEAST_LIFT, MOST_LIFT
from ..attributes.surfaces import Surface, Texture, VertexColors
from ..ldc.scan_conversion import Spans, steps
from ..mesh.triangle_mesh import TriangleMesh
from .image_samples import eroded, in_next_row

#: Edge of a block in cells, an odd number -> cells around it that must lie in the same triangle, because its splat
#: reaches over them. `fitted_planes` tilts only samples that are nearer to the triangle's edges.
BLOCKS = {edge: math.ceil((LARGE_SIZE - 0.5) * edge) for edge in STEPS_OF_LARGE}
#: Edge of the largest block, and how many rows around it decide whether there is one.
LARGEST, RING = max(BLOCKS), max(BLOCKS.values())

#: Normals, and colours, that differ by less than this are alike.
_ALIKE = 1e-3

#: The spans of each image's large samples, by the edge of their blocks.
Large = dict[int, tuple[Spans, ...]]


def divided(images: tuple[Spans, ...], are_even: Callable[[np.ndarray], np.ndarray]) -> tuple[tuple[Spans, ...], Large]:
    """The samples that stay small, and the large ones that replace the others.

    images: spans, one in each row of a triangle. are_even: (t,) triangles -> (t,) bool, whether each looks the same
    everywhere.
    """
    parts = [_divided(spans, are_even) for spans in images]
    large = {edge: tuple(of_edge[edge] for _, of_edge in parts) for edge in BLOCKS}
    return tuple(small for small, _ in parts), large


def evenness(
    mesh: TriangleMesh, is_mapped: bool, bulges: np.ndarray | None, spacing: float
) -> Callable[[np.ndarray], np.ndarray]:
    """The function `are_even` of `divided`.

    is_mapped: whether images are looked up at render time. bulges: of `lifts`, or None.
    """
    are_plain = np.array([_is_plain(surface, is_mapped) for surface in mesh.surfaces])
    reads_colors = any(
        isinstance(factor, VertexColors)
        for surface in mesh.surfaces
        for channel in surface.channels().values()
        for factor in channel.factors
    )

    def are_even(triangles: np.ndarray) -> np.ndarray:
        materials = 0 if mesh.materials is None else mesh.materials.take(triangles)
        result = np.broadcast_to(are_plain[np.minimum(materials, len(are_plain) - 1)], len(triangles)).copy()
        if bulges is not None:
            result &= MOST_LIFT * bulges.take(triangles, axis=1).max(axis=0) <= LEAST_LIFT * spacing
        if mesh.corner_normals is not None:
            normals = mesh.corner_normals.take(triangles, axis=0).astype(np.float64)
            with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
                normals /= np.linalg.norm(normals, axis=2, keepdims=True)
            # Vectors without length stand for the triangle's own normal, if they all do.
            result &= _are_alike(np.where(np.isfinite(normals).all(axis=2, keepdims=True), normals, 0))
        if reads_colors and mesh.corner_colors is not None:
            result &= _are_alike(mesh.corner_colors.take(triangles, axis=0))
        return result

    return are_even


def _is_plain(surface: Surface, is_mapped: bool) -> bool:
    """Whether a surface looks the same everywhere in a triangle whose corners look alike, or has an image that is
    looked up there. Coordinates that are wrapped or mirrored for it do not change evenly."""
    textures = [f for channel in surface.channels().values() for f in channel.factors if isinstance(f, Texture)]
    return not textures or (is_mapped and textures == [surface.color_texture] and textures[0].wraps is None)


def _are_alike(corners: np.ndarray) -> np.ndarray:
    """(t,) bool: whether (t, 3, k) values at three corners are the same; NaN is not."""
    with np.errstate(invalid="ignore"):
        return (np.abs(corners[:, 1:] - corners[:, :1]) <= _ALIKE).all(axis=(1, 2))


class _Rows(NamedTuple):
    """g rows of blocks of this edge, in cells: the triangle and row of each, and its columns first..stop, in blocks.
    spans: (g,) the first span of each. of_span: (n,) the row of each span."""

    edge: int
    triangles: np.ndarray
    rows: np.ndarray
    first: np.ndarray
    stop: np.ndarray
    spans: np.ndarray
    of_span: np.ndarray


def _divided(spans: Spans, are_even: Callable[[np.ndarray], np.ndarray]) -> tuple[Spans, dict[int, Spans]]:
    least = min(edge + 2 * ring for edge, ring in BLOCKS.items())
    wide = np.unique(spans.triangles.compress(spans.counts >= least))
    wide = wide.compress(are_even(wide)) if len(wide) else wide
    if not len(wide):
        return spans, {edge: Spans.joined([]) for edge in BLOCKS}
    place = np.minimum(np.searchsorted(wide, spans.triangles), len(wide) - 1)
    is_wide = wide.take(place) == spans.triangles
    some = spans[np.flatnonzero(is_wide)]
    first, stop, inner = some.columns, some.columns + some.counts, []
    for ring in range(1, RING + 1):
        first, stop = eroded(first, stop, in_next_row(some))
        inner += [_blocks(some, first, stop, edge) for edge, needed in BLOCKS.items() if needed == ring]
    made, wider = {}, None
    for rows in (*reversed(inner), _cells(some)):
        made[rows.edge], wider = _spans(rows, wider), rows
    small = Spans.joined([spans[np.flatnonzero(~is_wide)], made.pop(1)])
    return small[np.argsort(small.triangles, kind="stable")], made


def _cells(spans: Spans) -> _Rows:
    """Each span as a row of blocks of one cell."""
    number = np.arange(len(spans))
    return _Rows(1, spans.triangles, spans.rows, spans.columns, spans.columns + spans.counts, number, number)


def _blocks(spans: Spans, first: np.ndarray, stop: np.ndarray, edge: int) -> _Rows:
    """The blocks all of whose cells lie in the columns first..stop, (n,) each, of the spans."""
    rows = spans.rows // edge
    is_new = np.ones(len(spans), bool)
    is_new[1:] = (spans.triangles[1:] != spans.triangles[:-1]) | (rows[1:] != rows[:-1])
    starts = np.flatnonzero(is_new)
    left = np.maximum.reduceat(-(-first // edge), starts)
    right = np.minimum.reduceat(stop // edge, starts)
    right[np.diff(np.append(starts, len(spans))) < edge] = 0
    number = np.cumsum(is_new) - 1
    return _Rows(edge, spans.triangles[starts], rows[starts], left, np.maximum(left, right), starts, number)


def _spans(rows: _Rows, wider: _Rows | None) -> Spans:
    """The samples at the middles of rows of blocks, without those that wider blocks cover; one span each, or all of a
    run where blocks are single cells."""
    taken = rows.stop, rows.stop
    if wider is not None:
        above, ratio = wider.of_span.take(rows.spans), wider.edge // rows.edge
        first, stop = ratio * wider.first.take(above), ratio * wider.stop.take(above)
        taken = (np.where(stop > first, ends, rows.stop) for ends in (first, stop))
    until, after = taken
    start = np.stack([rows.first, after], axis=1).ravel()
    counts = np.stack([until - rows.first, rows.stop - after], axis=1).ravel()
    some = np.flatnonzero(counts > 0)
    start, counts = start.take(some), counts.take(some)
    triangles, at = rows.triangles.take(some // 2), rows.rows.take(some // 2)
    if rows.edge > 1:
        triangles, at, start = (np.repeat(values, counts) for values in (triangles, at, start))
        start += steps(counts).astype(start.dtype)
        counts = np.ones(len(start))
    middle = rows.edge // 2
    places = (rows.edge * at + middle, rows.edge * start + middle)
    return Spans(*(values.astype(np.int32) for values in (triangles, *places, counts)))
