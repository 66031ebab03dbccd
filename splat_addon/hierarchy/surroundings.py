# SPDX-License-Identifier: GPL-3.0-or-later
"""What the surroundings of merged surfels change in how they are drawn, and when.

Sharper: a merged surfel has the mean of what it stands for, and its kernel overlaps those of its neighbours, so that a
picture shows a weighted mean of means. The difference between its own value and that weighted mean is what the picture
loses there, and adding it once restores most of it (one step of van Cittert's iteration, "Zum Einfluss der Spaltbreite
auf die Intensitaetsverteilung in Spektrallinien II", 1931). Large differences are limited: they come from patterns as
fine as the cells, of which sharpening would make stripes.

Later: what extends over neighbours is hardly seen, but beyond a border or a crease it pokes out, into light or shadow
of others. There overhang counts several times.
"""

from __future__ import annotations

import numpy as np

from ..runs import ranges, sorted_with_order
from .families import dot
from .merged_lines import as_planes
from .nodes import Nodes, Table
from .runs import Runs

#: Minimum cosine between the normals of surfels that mix in a picture, and of those without a crease between them.
_SAME_SIDE = 0.3
_NO_CREASE = 0.7

#: Half-axes from a surfel's centre up to which neighbours show whether it lies at a border: those are more on one side,
#: their weighted mean farther than this from the centre; or there are few, of less than this weight.
_AROUND = np.float32(2)
_ONE_SIDED = 0.25
_FEW = 2.3

#: How many times overhang counts at a border or crease, up to the surfel's radius: what pokes out by over a quarter of
#: the tolerance is seen as dark specks where it gets into shadow.
AT_BORDERS = np.float32(4)

#: Weight of a kernel at a squared distance in radii: exp(-2 e^2), that of the methods, until shortly beyond its rim.
_SHARPNESS = np.float32(-2)
_END = np.float32(1.2**2)

#: Length of a change of normal or colour at which it is halved.
_MOST_CHANGE = np.float32(0.1)

#: Bits of a voxel's number along an axis; surfels beyond count to the last.
_BITS = 20

#: Maximum number of candidates in three voxels in a row, so that surfels crowded on one point stay cheap.
_MOST = 32

#: Surfels per batch, few enough for temporaries to stay in the processor's cache.
_PORTION = 1 << 11


def as_drawn(nodes: Table, cell: float) -> Table:
    """Merged surfels of one level with sharpened normals and colours, spreads that include the change, and overhangs as
    they count.

    cell: of the level. Where surfels have moved apart since they were built, neighbours are searched farther away.
    """
    keys, order = voxels(nodes.column("positions"), max(cell, float(np.median(nodes.column("radii")))))
    some, near = nodes.take(order), Near(keys)
    values = np.concatenate([some["shading"], some["colors"][:3]])
    columns = some["positions"], some["normals"], some["materials"], some["radii"], values
    candidates = np.ascontiguousarray(np.vstack(columns).T)
    change, is_border = np.empty_like(values), np.empty(len(order), bool)
    for start in range(0, len(order), _PORTION):
        part = slice(start, start + _PORTION)
        pairs = _Pairs(some, part, candidates, *near.rows(part))
        change[:, part] = values[:, part] - pairs.blurred(values[:, part])
        is_border[part] = pairs.are_at_borders()
    shading, colors = (
        kind + _limited(more) for kind, more in zip((values[:3], values[3:]), (change[:3], change[3:]), strict=True)
    )
    shading /= _lengths(shading)
    colors = np.maximum(colors, 0)
    spread = np.maximum(_lengths(shading - values[:3]) / 2, np.abs(colors - values[3:]).max(axis=0))
    result = Table(nodes.widths, nodes.rows.copy())
    result.put("shading", shading, order)
    result.put("colors", np.concatenate([colors, some["colors"][3:]]), order)
    result.put("spread", some["spread"] + spread, order)
    most = np.maximum(some["overhang"], np.minimum(AT_BORDERS * some["overhang"], some["radii"]))
    if "lines" in some:
        # they end there
        is_border &= ~some["lines"].any(axis=0)
    result.put("overhang", np.where(is_border, most, some["overhang"]), order)
    return result


def _limited(changes: np.ndarray) -> np.ndarray:
    return changes * (_MOST_CHANGE / (_MOST_CHANGE + _lengths(changes)))


def _lengths(vectors: np.ndarray) -> np.ndarray:
    return np.sqrt(dot(vectors, vectors))


def voxels(positions: np.ndarray, cell: float) -> tuple[np.ndarray, np.ndarray]:
    """(n,) voxels of the positions in ascending order, and the order that sorts them."""
    places = (positions - positions.min(axis=1)[:, None]) / np.float32(cell)
    x, y, z = np.minimum(places, (1 << _BITS) - 3).astype(np.int64) + 1
    order, voxels = sorted_with_order(x << 2 * _BITS | y << _BITS | z, 1 << 3 * _BITS)
    return voxels, order


class _Pairs:
    """m surfels of a level, a part of all in the order of their voxels, and n candidates for their neighbours.

    candidates: (N, 14) of all surfels: position, normal, material, radius and the values that mix in a picture.
    rows: (n,) candidates, one surfel's after the other's. counts: (m,) number of each one's.
    """

    def __init__(self, nodes: Nodes, part: slice, candidates: np.ndarray, rows: np.ndarray, counts: np.ndarray):
        self.nodes, self.part = nodes, part
        self.runs = Runs(np.cumsum(counts) - counts, counts)
        columns = np.ascontiguousarray(np.take(candidates, rows, axis=0).T)
        self.offsets, self.radii, self.values = columns[:3], columns[7], columns[8:]
        self.offsets -= self._own("positions")
        self.cosines = dot(columns[3:6], self._own("normals"))
        self.cosines[columns[6] != self._own("materials")] = -1

    def blurred(self, own: np.ndarray) -> np.ndarray:
        """(6, m) the values that a picture shows at the centres; their own if too many are crowded there to count."""
        distance = dot(self.offsets, self.offsets) / self.radii**2
        weights = np.exp(_SHARPNESS * distance) * ((distance < _END) & (self.cosines > _SAME_SIDE))
        if "lines" in self.nodes:
            weights[self._beyond_lines()] = 0
        total = self.runs.sum(weights)
        means = self.runs.sum(self.values * weights) / np.maximum(total, np.float32(1e-30))
        return np.where(total > 0, means, own)

    def are_at_borders(self) -> np.ndarray:
        """(m,) whether neighbours are on one side only, or few."""
        u, v = (axis[:, self.part] for axis in self.nodes.axes)
        x, y = (dot(self.offsets, self.runs.spread(axis / dot(axis, axis))) for axis in (u, v))
        weights = np.maximum(1 - (x * x + y * y) / _AROUND**2, 0) ** 2 * (self.cosines > _NO_CREASE)
        x, y, total = self.runs.sum(np.stack([x * weights, y * weights, weights]))
        return (np.hypot(x, y) > _ONE_SIDED * total) | (total < _FEW)

    def _beyond_lines(self) -> np.ndarray:
        """Numbers of the candidates that are beyond lines of their surfels."""
        lines = as_planes(self.nodes["lines"][:, self.part])
        owners = np.flatnonzero(lines.any(axis=(0, 1)))
        counts = self.runs.counts[owners]
        pairs = ranges(self.runs.starts[owners], counts)
        lines, place = np.repeat(lines[..., owners], counts, axis=2), np.take(self.offsets, pairs, axis=1)
        return pairs[(np.einsum("kan,an->kn", lines[:, :3], place) + lines[:, 3] < 0).any(axis=0)]

    def _own(self, name: str) -> np.ndarray:
        return self.runs.spread(self.nodes[name][..., self.part])


class Near:
    """Finds what lies in the 27 voxels around a surfel's, in N surfels in the order of their (N,) voxels."""

    def __init__(self, keys: np.ndarray):
        self.keys = keys
        self.ends = np.concatenate([np.searchsorted(keys, keys + k) for k in (1, 2, 3)])

    def rows(self, part: slice) -> tuple[np.ndarray, np.ndarray]:
        """(n,) rows around those of m surfels, one's after the other's, and the (m,) number of each."""
        beside = np.array([(a << 2 * _BITS) + (b << _BITS) for a in (-1, 0, 1) for b in (-1, 0, 1)])
        columns = self.keys[part] + beside[:, None]
        first = np.minimum(np.searchsorted(self.keys, columns - 1), len(self.keys) - 1)
        # how many of three voxels in a row follow the first one that is not empty
        left = columns + 1 - self.keys[first]
        has_any = (left >= 0) & (left <= 2)
        ends = self.ends[np.clip(left, 0, 2) * len(self.keys) + first]
        counts = np.minimum(ends - first, _MOST) * has_any
        return ranges(first.T.ravel(), counts.T.ravel()), counts.sum(axis=0)
