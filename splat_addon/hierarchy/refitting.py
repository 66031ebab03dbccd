# SPDX-License-Identifier: GPL-3.0-or-later
"""Fits a hierarchy to its surfels after they have moved, as those of a deforming mesh do in each frame.

The tree stays: the same surfels merge, in the same blocks. Merged surfels and all bounds are computed again from the
moved ones, so that bounds hold whatever has happened; if surfels that merge have moved apart, bounds grow, and finer
levels are drawn. What is saved is the search for surfels that belong together. Surfels are gathered once, in the order
of the blocks, in which the children of each node follow one another on every level.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..surfels import Surfels, concatenate
from .blocks import make_blocks
from .building import Hierarchy, merged_level
from .loose import bare, resized
from .merging import as_surfels
from .nodes import Leaves
from .runs import Runs


def refit_hierarchy(hierarchy: Hierarchy, surfels: Surfels) -> Hierarchy:
    """The hierarchy fitted to as many surfels as it was built for, in the same order.

    Raises ValueError with a sentence for another number of surfels.
    """
    if len(surfels) != hierarchy.surfels:
        raise ValueError(f"A hierarchy of {hierarchy.surfels:,} surfels cannot be refitted to {len(surfels):,}.")
    if not len(hierarchy):
        return hierarchy
    entries, counts = by_level(hierarchy)
    current, rows = Leaves(surfels), entries[0]
    worst = None
    made, errors, places = [], [], [current.geometry]
    for numbers, own_counts, cell in zip(entries[1:], counts, hierarchy.cells, strict=True):
        several = own_counts > 1
        starts = np.cumsum(own_counts) - own_counts
        family, sizes = rows[np.repeat(several, own_counts)], own_counts[several]
        runs = Runs(np.cumsum(sizes) - sizes, sizes)
        parents, drawn, own = merged_level(current, worst, family, runs, cell)
        # nodes are numbered in the order in which the build made them
        created = np.argsort(numbers[several])
        sizes = hierarchy.sizes[numbers[several] - len(surfels)]
        np.maximum(own[:, 1], bare(parents, sizes), out=own[:, 1])
        made.append(as_surfels(resized(drawn, sizes).of_rows(created), surfels))
        errors.append(own[created])
        places.append(parents.of_rows(created).geometry)
        waiting = rows[starts[~several]]
        order = np.empty(len(numbers), np.int64)
        order[np.concatenate([np.flatnonzero(several), np.flatnonzero(~several)])] = np.arange(len(numbers))
        current, rows = current.joined([parents], waiting).of_rows(order), np.arange(len(numbers))
        kept = np.zeros((len(waiting), 3), np.float32) if worst is None else worst[waiting]
        worst = np.concatenate([own, kept])[order]
    every = np.concatenate(errors)
    blocks = make_blocks(entries, counts, np.concatenate(places), every)
    return replace(hierarchy, nodes=concatenate(made), errors=every, blocks=blocks)


def by_level(hierarchy: Hierarchy) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """The entries of each level, the surfels' first, and the numbers of children above it: as `depth_first` does."""
    ends = np.cumsum(hierarchy.counts)
    entries, counts, size, done = [hierarchy.entries[: hierarchy.surfels]], [], hierarchy.surfels, 0
    for _ in hierarchy.cells:
        below = ends[done - 1] if done else 0
        last = int(np.searchsorted(ends, below + size)) + 1
        counts.append(hierarchy.counts[done:last])
        entries.append(hierarchy.entries[hierarchy.surfels + done : hierarchy.surfels + last])
        size, done = last - done, last
    return entries, counts
