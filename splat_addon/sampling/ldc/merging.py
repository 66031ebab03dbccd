# SPDX-License-Identifier: GPL-3.0-or-later
"""The 3-to-1 reduction: surfels of all three images are snapped to a common lattice, and one stays at each node.

After Pfister et al. 2000, who resample the three images of a cube into one with the nearest surfel's attributes. The
lattice nodes are the cell centres, where the rays of all three images cross. Two sheets less than a cell apart share
nodes and become one, a known failure of this reduction (docs/evidence/conversion.md).
"""

from __future__ import annotations

import numpy as np

from ...quaternions import quaternion_axes
from ..materials.texture_mapping import moved
from ..table import SampleTable, taken


def nearest_to_lattice(arrays: SampleTable, axes: np.ndarray, spacing: float) -> SampleTable:
    """The nearest of the surfels around each lattice node, moved onto the node, in the original order.

    arrays: by field of `Surfels`, positions relative to a corner of a cell. axes: of their images, all alike here.
    spacing: of the grid, object units.
    """
    cells = np.floor(arrays["positions"].T / np.float32(spacing)).astype(np.int64)
    centres = (cells + 0.5) * spacing
    distances = np.abs(arrays["positions"].T - centres).max(axis=0)
    nodes = _numbered(cells)
    # The first of each run of equal nodes is the nearest; the stable sort resolves ties by index.
    order = np.lexsort((distances, nodes))
    nodes = nodes[order]
    is_first = np.ones(len(order), bool)
    is_first[1:] = nodes[1:] != nodes[:-1]
    stay = np.sort(order[is_first])
    kept = taken(arrays, stay)
    positions = np.ascontiguousarray(centres.T[stay], np.float32)
    if "uvs" in kept:
        x, y, _ = quaternion_axes(kept["rotations"], 2)
        half_axes = x * kept["scales"][:, :1], y * kept["scales"][:, 1:]
        kept |= moved(kept, half_axes, positions - kept["positions"])
    kept["positions"] = positions
    return kept


def _numbered(cells: np.ndarray) -> np.ndarray:
    """(n,) int64 keys that are equal exactly where (3, n) cells are equal; 2^20 cells per edge fit, twice a grid's
    maximum."""
    x, y, z = cells - cells.min(axis=1, keepdims=True) if cells.shape[1] else cells
    return (x << 42) | (y << 21) | z
