# SPDX-License-Identifier: GPL-3.0-or-later
"""Blocks: runs of neighbours in one level that a view draws completely or not at all.

A level's entries are ordered by their parents, so that the children of any run of parents are a run too. A block's
children are therefore whole blocks of the level below, and one comparison decides between it and them (equal blocks:
Goswami et al. 2012). Boxes, cones and errors of a block enclose those of all blocks below it, so tests of a parent
never contradict those of its children.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..runs import expand, ranges
from .runs import Runs

#: Maximum number of entries in a block above the surfels' level, and of surfels in one. A block is as coarse as the
#: worst of its entries, so that among few a rough place makes few others finer. Surfels have no error, and most blocks
#: are theirs.
BLOCK, BLOCK_OF_SURFELS = 8, 32

_MOST = np.finfo(np.float32).max
#: Entries per batch, few enough for temporaries to stay in the processor's cache.
_PORTION = 1 << 14


@dataclass(frozen=True, eq=False)
class Level:
    """One level above the surfels, with m entries: first the parents, then entries that wait for larger cells.

    numbers: (m,) index of the surfel or node; nodes come after the surfels. children: (n,) entries of the level below,
    ordered by parent. counts: (m,) number of children of each entry, 1 for those that wait. cell: size of the cells.
    sizes: of the parents alone, as `Hierarchy.sizes`.
    """

    numbers: np.ndarray
    children: np.ndarray
    counts: np.ndarray
    cell: float
    sizes: np.ndarray = field(default_factory=lambda: np.zeros(0, np.float32))


@dataclass(frozen=True, eq=False)
class Blocks:
    """B blocks, those of the coarsest level first.

    first, last: (B,) each block's run in `Hierarchy.entries`. first_child, last_child: (B,) its run of child blocks,
    empty for blocks of surfels. low, high: (B, 3) float32, a box around the ellipses of the block and of all blocks
    below it, relative to the surfels' origin. axes, angles: (B, 3), (B,) float32, a cone around the normals of their
    planes, radians. errors: (B, 3) float32, their largest errors; 0 for surfels. roots: number of blocks without a
    parent.
    """

    first: np.ndarray
    last: np.ndarray
    first_child: np.ndarray
    last_child: np.ndarray
    low: np.ndarray
    high: np.ndarray
    axes: np.ndarray
    angles: np.ndarray
    errors: np.ndarray
    roots: np.ndarray

    def __len__(self) -> int:
        return len(self.first)


def depth_first(levels: list[Level], surfels: int) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """The entries of each level, the surfels' level first, in the order of their parents; and each parent's
    number of children.
    """
    entries, counts = [], []
    rows = np.arange(len(levels[-1].numbers) if levels else surfels, dtype=np.int32)
    for level in reversed(levels):
        entries.append(level.numbers[rows])
        counts.append(level.counts[rows])
        rows = level.children[ranges((np.cumsum(level.counts) - level.counts)[rows], counts[-1])]
    return [*entries, rows][::-1], counts[::-1]


def make_blocks(
    entries: list[np.ndarray], counts: list[np.ndarray], geometry: np.ndarray, errors: np.ndarray
) -> Blocks:
    """entries, counts: of `depth_first`. geometry: (N + M, 7) of all surfels and nodes, as of a `Table`. errors: (M, 3)
    of the nodes.
    """
    offsets = np.cumsum([0, *map(len, entries)])
    most = [BLOCK_OF_SURFELS] + [BLOCK] * len(counts)
    runs = [_between(np.array([0]), np.array([len(entries[-1])]), most[-1])]
    families = []
    for own, size in zip(counts[::-1], most[-2::-1], strict=True):
        first, last, _ = runs[-1]
        ends = np.concatenate([[0], np.cumsum(own)])
        runs.append(_between(ends[first], ends[last], size))
        families.append(runs[-1][2])
    families.append(np.zeros(len(runs[-1][0]), int))  # the surfels are the last
    numbers = np.cumsum([0, *(len(first) for first, _, _ in runs)])
    below, parts = None, []
    for k in range(len(runs) - 1, -1, -1):
        depth = len(runs) - 1 - k
        first, last, _ = runs[k]
        has = families[k]
        child = numbers[k + 1] + np.cumsum(has) - has
        below = _bounds(entries[depth], first, geometry, errors, below, np.cumsum(has) - has if below else None)
        parts.append((first + offsets[depth], last + offsets[depth], child, child + has, *below))
    columns = (np.concatenate(column[::-1]) for column in zip(*parts, strict=True))
    types = [np.int32] * 4 + [np.float32] * 5
    arrays = (np.ascontiguousarray(column, kind) for column, kind in zip(columns, types, strict=True))
    return Blocks(*arrays, roots=np.array(len(runs[0][0])))


def _between(first: np.ndarray, last: np.ndarray, most: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Runs cut into equal pieces of at most `most`: starts, ends, and the number of pieces of each run."""
    size = last - first
    parts = -(-size // most)
    owner, number = expand(parts)
    cuts = [first[owner] + size[owner] * (number + k) // parts[owner] for k in (0, 1)]
    return cuts[0], cuts[1], parts


def _bounds(entries, starts, geometry: np.ndarray, errors, below, children):
    """low, high, axes, angles and errors of a level's blocks. below: these values for the level below.
    children: the first child of each block.
    """
    if not len(entries):
        return np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 3)), np.zeros(0), np.zeros((0, 3))
    runs = Runs(starts, np.diff(np.append(starts, len(entries))))
    parts = [_own(entries[some], part, geometry, errors) for some, part in runs.portions(_PORTION)]
    low, high, axes, angles, largest = (np.concatenate(column) for column in zip(*parts, strict=True))
    if below is None:
        return low, high, axes, angles, largest
    owner = np.repeat(np.arange(len(starts)), np.diff(np.append(children, len(below[0]))))
    apart = np.arccos(np.clip(np.einsum("nk,nk->n", axes[owner], below[2]), -1, 1)) + below[3]
    return (
        np.minimum(low, np.minimum.reduceat(below[0], children, axis=0)),
        np.maximum(high, np.maximum.reduceat(below[1], children, axis=0)),
        axes,
        np.maximum(angles, np.maximum.reduceat(apart, children)),
        np.maximum(largest, np.maximum.reduceat(below[4], children, axis=0)),
    )


def _own(entries: np.ndarray, runs: Runs, geometry: np.ndarray, errors: np.ndarray) -> tuple:
    """The same for runs of entries, each a block, without what is below them."""
    columns = np.ascontiguousarray(np.take(geometry, entries, axis=0).T)
    positions, normals, radii = columns[:3], columns[3:6], columns[6]
    sums = runs.sum(normals)
    axes = sums / np.maximum(np.linalg.norm(sums, axis=0), 1e-12)
    dots = np.einsum("kn,kn->n", normals, runs.spread(axes))
    angles = np.arccos(np.clip(runs.least(dots), -1, 1)) + 1e-3
    nodes, own = entries - (len(geometry) - len(errors)), np.zeros((len(entries), 3), np.float32)
    if nodes.max() >= 0:
        own = np.where(nodes[:, None] >= 0, errors[np.maximum(nodes, 0)], own)
    largest = np.maximum.reduceat(own, runs.starts, axis=0)
    # what is beyond float32 is at its end
    with np.errstate(over="ignore"):
        low, high = np.maximum(positions - radii, -_MOST), np.minimum(positions + radii, _MOST)
    return runs.least(low).T, runs.largest(high).T, axes.T, angles, largest
