# SPDX-License-Identifier: GPL-3.0-or-later
"""Builds a hierarchy: levels from the bottom, each with cells twice as large, then the order and the blocks from the
top."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..large_surfels import SAMPLE_SIZE
from ..surfels import Surfels, concatenate, empty_surfels
from .blocks import Blocks, Level, depth_first, make_blocks
from .clusters import clustered
from .extremes import extreme
from .families import families
from .loose import Loose, bare, resized
from .merging import as_surfels, merged
from .nodes import PORTION, Leaves, Table
from .pieces import apart
from .runs import Runs
from .surroundings import as_drawn

#: Cells of the first level, in spacings of the surfels: nine surfels become one, so all levels together add a sixth. At
#: twice the spacing they would add a third.
FIRST_CELL = 3.0

#: A level in which less than this share merges is skipped; a larger cell merges them.
_LEAST_MERGED = 0.1

#: A surfel waits for larger cells if its larger half-axis exceeds this many edges of the cell.
_LARGEST = 1.25 * np.sqrt(3)

#: Shares of the progress. _MERGING: how far building is when all levels are merged. _LEAVES: how far merging is when
#: the surfels are nodes. _OF_THE_REST: what a level takes of the time that is left for it and those above it.
#: _ORDERED, _MERGED: how far a level is when its rows are in order, and when they are merged.
_MERGING, _LEAVES, _OF_THE_REST, _ORDERED, _MERGED = 0.9, 0.05, 0.85, 0.25, 0.7

#: Maximum doublings between the smallest and the largest cell.
_MOST_LEVELS = 48

#: Called with a finished share, 0 to 1.
Told = Callable[[float], None]


@dataclass(frozen=True, eq=False)
class Hierarchy:
    """A hierarchy over N surfels, with M merged nodes.

    nodes: the merged surfels, in the order of their creation. errors: (M, 3) float32 bounds, object units, never below
    a child's: distance off the plane; uncovered or protruding width, the latter several times at borders; error of what
    it shows (its size times the change of colour or normal). entries: (E,) int32 indices of surfels and, from N on, of
    nodes, level by level, starting with the surfels; blocks are runs of it. counts: (E - N,) int32, how many entries of
    the level below each entry above the surfels' level stands for; those of successive entries follow one another.
    cells: cell size of each level above the surfels. sizes: (M,) float32 factors of the nodes' axes, as
    `Loose.sizes`. built_looseness: its `looseness` when it was built.
    """

    surfels: int
    nodes: Surfels
    errors: np.ndarray
    entries: np.ndarray
    counts: np.ndarray
    cells: tuple[float, ...]
    blocks: Blocks
    sizes: np.ndarray
    built_looseness: float = 0.0

    def looseness(self, surfels: Surfels) -> float:
        """The median error of its nodes in median radii of its surfels; 0 without nodes."""
        return float(np.median(self.errors.max(axis=1)) / np.median(surfels.radius)) if len(self) else 0.0

    def __len__(self) -> int:
        return len(self.nodes)

    @cached_property
    def nbytes(self) -> int:
        """Memory in bytes beside the surfels."""
        own = self.errors, self.entries, self.counts, self.sizes
        return sum(array.nbytes for array in (*self.nodes.arrays().values(), *own, *vars(self.blocks).values()))


def build_hierarchy(surfels: Surfels, told: Told | None = None, is_portion: bool = False) -> Hierarchy:
    """The hierarchy of any set of surfels; it has a single level if there are none, or too few to merge.

    told: called between steps with the finished share, 0 to 1; it may raise, which ends the building. is_portion: other
    sets may go on where this one ends, so that nothing in it is known to stand apart.
    """
    told = told or _untold
    nodes, errors, levels, geometry = build_levels(surfels, lambda share: told(_MERGING * share), is_portion)
    entries, counts = depth_first(levels, len(surfels))
    blocks = make_blocks(entries, counts, geometry, errors)
    every = np.concatenate([np.zeros(0, np.int32), *counts])
    cells = tuple(level.cell for level in levels)
    sizes = np.concatenate([np.zeros(0, np.float32), *(level.sizes for level in levels)])
    told(1.0)
    made = Hierarchy(len(surfels), nodes, errors, np.concatenate(entries), every, cells, blocks, sizes)
    return replace(made, built_looseness=made.looseness(surfels))


def _untold(share: float) -> None:
    """Nobody asked for progress."""


def build_levels(
    surfels: Surfels, told: Told = _untold, is_portion: bool = False
) -> tuple[Surfels, np.ndarray, list[Level], np.ndarray]:
    """Merged nodes, their (M, 3) errors, the levels from the bottom up, and the (N + M, 7) geometry of all.

    told, is_portion: as in `build_hierarchy`.
    """
    current, loose = Leaves(surfels), Loose(surfels, may_be_apart=not is_portion)
    numbers, worst = np.arange(len(surfels), dtype=np.int32), None
    made, errors = [empty_surfels(surfels.origin)], [np.zeros((0, 3), np.float32)]
    levels, places = [], [current.geometry]
    total, left, last = len(surfels), 1 - _LEAVES, None
    told(_LEAVES)

    def make_last() -> None:
        """Make the merged surfels of the last level, once it is known whether anything continues them."""
        parents, drawn = last
        levels[-1] = replace(levels[-1], sizes=loose.sizes(parents))
        made.append(as_surfels(resized(drawn, levels[-1].sizes), surfels))
        np.maximum(errors[-1][:, 1], bare(parents, levels[-1].sizes), out=errors[-1][:, 1])
        worst[: len(parents)] = errors[-1]

    for cell in _cells(surfels):

        def told_of_level(share: float, left=left) -> None:
            told(1 - left * (1 - _OF_THE_REST * share))

        families = _families(current, cell, loose)
        told_of_level(_ORDERED)
        if families is None:
            continue
        left *= 1 - _OF_THE_REST
        if last:
            make_last()
        rows, runs, waiting, whole = families
        parents, drawn, own = merged_level(current, worst, rows, runs, cell, told_of_level)
        loose.go_on(rows, runs, waiting, whole, parents)
        if whole:
            below = 0 if worst is None else runs.largest(worst[rows, 1])[:whole]
            own[:whole, 1] = np.minimum(own[:whole, 1], np.maximum(loose.extents(parents, whole), below))
        fresh = np.arange(total, total + len(parents), dtype=np.int32)
        total += len(parents)
        numbers = np.concatenate([fresh, numbers[waiting]])
        worst = np.concatenate([own, np.zeros((len(waiting), 3), np.float32) if worst is None else worst[waiting]])
        counts = np.concatenate([runs.counts, np.ones(len(waiting), runs.counts.dtype)]).astype(np.int32)
        levels.append(Level(numbers, np.concatenate([rows, waiting]).astype(np.int32), counts, cell))
        last = parents, drawn
        errors.append(own)
        places.append(parents.geometry)
        current = current.joined([parents], waiting)
    if last:
        make_last()
    return concatenate(made[1:]) if levels else made[0], np.concatenate(errors), levels, np.concatenate(places)


def merged_level(
    current: Table | Leaves, worst: np.ndarray | None, rows: np.ndarray, runs: Runs, cell: float, told: Told = _untold
) -> tuple[Table, Table, np.ndarray]:
    """The parents of runs of rows of a level, the same as they are drawn, and their (m, 3) errors.

    worst: (n, 3) errors of the level's rows; None for surfels, which have none. told: as in `build_hierarchy`, of this
        level.
    """
    parents, below, done = None, np.zeros((len(runs.starts), 3), np.float32), 0
    for some in families(runs, PORTION):
        told(_ORDERED + (_MERGED - _ORDERED) * done / len(below))
        children = rows[some.children]
        made = merged(current.take(children.ravel()).in_families(some), cell)
        parents = Table.like(made, len(below)) if parents is None else parents
        parents.fill(made, some.parents)
        if worst is not None:
            below[some.parents] = worst[children].max(axis=0)
        done += len(some.parents)
    told(_MERGED)
    drawn = as_drawn(parents, cell)
    return parents, drawn, np.maximum(_errors(drawn), below)


def _cells(surfels: Surfels) -> Iterator[float]:
    """The cell sizes of the levels, up to one cell that contains everything."""
    never = extreme(Leaves(surfels))
    surfels = surfels if never is None else surfels.take(~never)
    if not len(surfels):
        return
    low, high = surfels.local_bounds
    shorter = np.minimum(*surfels.scales.T)
    cell = FIRST_CELL * float(np.median(shorter)) / SAMPLE_SIZE
    for _ in range(_MOST_LEVELS):
        yield cell
        if cell > 2 * float((high - low).max()):
            return
        cell *= 2


def _families(current: Table | Leaves, cell: float, loose: Loose) -> tuple[np.ndarray, Runs, np.ndarray, int] | None:
    """The rows that merge, in runs with one parent each, the rows that wait for larger cells, and how many of the runs,
    the first, are whole pieces; None if too few merge."""
    is_large, never = current.column("radii") > _LARGEST * cell, extreme(current)
    if never is not None:
        is_large |= never
    rows = np.flatnonzero(~is_large)
    if len(rows) < 2:
        return None
    found = loose.found(current, rows, cell)
    if found:
        rows = np.setdiff1d(rows, found.families, assume_unique=True)
    order, counts = clustered(current, rows, cell, has_extremes=never is not None) if len(rows) else (rows, rows)
    if found:
        parts, counts = apart(found.larger[rows[order]], counts)
        order = order[parts]
    several = counts > 1
    is_merged = np.repeat(several, counts)
    merging, waiting = rows[order[is_merged]], np.concatenate([rows[order[~is_merged]], np.flatnonzero(is_large)])
    counts = counts[several]
    if found:
        merging, counts = np.concatenate([found.families, merging]), np.concatenate([found.counts, counts])
    if len(merging) < _LEAST_MERGED * len(current):
        return None
    return merging, Runs(np.cumsum(counts) - counts, counts), waiting, len(found.counts) if found else 0


def _errors(nodes: Table) -> np.ndarray:
    """(m, 3) float32 errors, in the form of `Hierarchy.errors`."""
    extent = np.maximum(nodes.column("uncovered"), nodes.column("overhang"))
    shown = nodes.column("radii") * np.minimum(nodes.column("spread"), 1)
    return np.stack([nodes.column("off"), extent, shown], axis=1)
