# SPDX-License-Identifier: GPL-3.0-or-later
"""Which instances of a view are drawn by one call: those of one kind, if they are many and small."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..detail import steps as detail
from ..view import Items
from .uniforms import TEXELS_PER_INSTANCE, instance_values

#: More levels than any hierarchy has.
_MOST_STEPS = 64

#: Objects that are drawn together differ by less than this part of a doubling in their triangles: the missing ones are
#: drawn as nothing.
_STEPS_OF_SIZES = 2

#: Instances in a row of the texture that holds their values.
INSTANCES_PER_ROW = 1024


def batches(items: Items, triangles: np.ndarray, steps: np.ndarray, nearest: np.ndarray) -> list[Items]:
    """The items in the order of their first ones, in groups of one kind that are drawn together, or of one item.

    triangles: (n,) that are drawn of each, alike for one kind; 0 for those that are drawn by themselves. steps: (n,)
    levels of detail at which they are drawn whole, which only those at one level are together; -1 for none. nearest:
    (n,) bool, as of `Items.show_nearest`, of which all of a group have one value.
    """
    if len(items) < detail.LEAST_TOGETHER and (steps < 0).all():
        return [items] if len(items) == 1 else [items.taken(np.array([row])) for row in range(len(items))]
    keys = (items.table.kind_of * _MOST_STEPS + steps) * 2 + nearest
    _, first, group, counts = np.unique(keys, True, True, True)
    each = triangles[first]
    is_one = (counts >= detail.LEAST_TOGETHER) & (each <= detail.MOST_TRIANGLES) & (each > 0) | (steps[first] >= 0)
    are_together = is_one[group]
    begins = np.flatnonzero(~are_together | (first[group] == np.arange(len(items))))
    made = []
    for row in begins.tolist():
        own = items.taken(np.flatnonzero(group == group[row]) if are_together[row] else np.array([row]))
        is_whole = steps[row] >= 0
        made.append(replace(own, step=int(steps[row]), show_nearest=bool(nearest[row])) if is_whole else own)
    return made


def pooled_batches(items: Items, first: np.ndarray, counts: np.ndarray) -> list[tuple[Items, int]]:
    """Items of a pool in groups that are drawn together, and the most triangles that any of a group has. first, counts:
    (n,) the first triangle of each, and their number; those without are left out."""
    made, steps = [], np.ceil(_STEPS_OF_SIZES * np.log2(np.maximum(counts, 1))).astype(int)
    for step in np.unique(steps[counts > 0]).tolist():
        rows = np.flatnonzero((steps == step) & (counts > 0))
        places = np.stack([first[rows], counts[rows]], axis=1).astype(np.float64)
        made.append((replace(items.taken(rows), places=places), int(counts[rows].max())))
    return made


def instance_texels(items: Items) -> np.ndarray:
    """(rows, columns, 4) float32 values of instances, in rows of `INSTANCES_PER_ROW`."""
    values = instance_values(items)
    rows = -(-len(values) // INSTANCES_PER_ROW)
    across = min(len(values), INSTANCES_PER_ROW)
    texels = np.zeros((rows * across, values.shape[1]), np.float32)
    texels[: len(values)] = values
    return texels.reshape(rows, across * TEXELS_PER_INSTANCE, 4)
