# SPDX-License-Identifier: GPL-3.0-or-later
"""Which instances of a view are drawn by one call: those of one kind, if they are many and small."""

from __future__ import annotations

import numpy as np

from ..view import Items
from .uniforms import TEXELS_PER_INSTANCE, instance_values

#: Fewer instances are drawn one by one, because a vertex that looks its instance up takes longer.
LEAST_TOGETHER = 8

#: Instances with more triangles than this are drawn one by one: a call for each is little beside them.
MOST_TRIANGLES = 1 << 13

#: Instances in a row of the texture that holds their values.
INSTANCES_PER_ROW = 1024


def batches(items: Items, triangles: np.ndarray) -> list[Items]:
    """The items in the order of their first ones, in groups of one kind that are drawn together, or of one item.

    triangles: (n,) that are drawn of each, alike for one kind; 0 for those that are drawn by themselves.
    """
    if len(items) < LEAST_TOGETHER:
        return [items] if len(items) == 1 else [items.taken(np.array([row])) for row in range(len(items))]
    _, first, kind, counts = np.unique(items.table.kind_of, True, True, True)
    each = triangles[first]
    are_together = ((counts >= LEAST_TOGETHER) & (each <= MOST_TRIANGLES) & (each > 0))[kind]
    begins = np.flatnonzero(~are_together | (first[kind] == np.arange(len(items))))
    return [
        items.taken(np.flatnonzero(kind == kind[row]) if are_together[row] else np.array([row]))
        for row in begins.tolist()
    ]


def instance_texels(items: Items) -> np.ndarray:
    """(rows, columns, 4) float32 values of instances, in rows of `INSTANCES_PER_ROW`."""
    values = instance_values(items)
    rows = -(-len(values) // INSTANCES_PER_ROW)
    across = min(len(values), INSTANCES_PER_ROW)
    texels = np.zeros((rows * across, values.shape[1]), np.float32)
    texels[: len(values)] = values
    return texels.reshape(rows, across * TEXELS_PER_INSTANCE, 4)
