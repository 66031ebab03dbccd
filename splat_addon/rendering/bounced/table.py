# SPDX-License-Identifier: GPL-3.0-or-later
"""Bounced light as texels: a hash table of cells, and what the six sides of each receive.

Source: Teschner et al., "Optimized Spatial Hashing for Collision Detection of Deformable Objects", 2003 (the hash).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..scene.light import MAX_IRRADIANCE
from .surfaces import SIDES

#: Texels in a row of the texture.
PER_ROW = 1024
#: What the sides have that no surface has: a negative share of the world.
ABSENT = -1.0
#: Slots per cell, at least.
_ROOM = 2
_FACTORS = np.array([73856093, 19349663, 83492791], np.uint32)


class Table(NamedTuple):
    """texels: (rows, 1024, 4) float32: for each slot the cell's numbers and 1 + its row, or 0; then for each row the
    six sides' irradiance over pi and the world's share. slots: a power of two. probes: the most slots that a look-up
    reads."""

    texels: np.ndarray
    slots: int
    probes: int


def make_table(cells: np.ndarray, sides: np.ndarray, irradiance: np.ndarray, is_open: np.ndarray) -> Table:
    """Of merged surfels: cells: (m, 3) whole numbers. sides: (m,). irradiance: (m, 3). is_open: (m,)."""
    every, row = np.unique(cells, axis=0, return_inverse=True)
    slots = 1 << int(np.ceil(np.log2(max(_ROOM * len(every), 2))))
    place, probes = _placed(every, slots)
    texels = np.zeros((slots + len(every) * SIDES, 4), np.float32)
    texels[place, :3], texels[place, 3] = every, 1 + np.arange(len(every))
    values = texels[slots:].reshape(-1, SIDES, 4)
    values[..., 3] = ABSENT
    bounded = np.minimum(irradiance, MAX_IRRADIANCE)  # as lamps have it
    values[row.ravel(), sides] = np.concatenate([bounded, is_open[:, None]], axis=1)
    rows = -(-len(texels) // PER_ROW)
    padded = np.zeros((rows * PER_ROW, 4), np.float32)
    padded[: len(texels)] = texels
    return Table(padded.reshape(rows, PER_ROW, 4), slots, probes)


def hashes(cells: np.ndarray) -> np.ndarray:
    """(n,) uint32 of (n, 3) cells."""
    x, y, z = (cells.astype(np.int64).astype(np.uint32) * _FACTORS).T
    return x ^ y ^ z


def _placed(cells: np.ndarray, slots: int) -> tuple[np.ndarray, int]:
    """(n,) the slot of each cell, the first that is free from its hash on; and the most slots that one goes on."""
    wanted = (hashes(cells) & np.uint32(slots - 1)).astype(np.int64)
    owner, place, left, tried = np.full(slots, -1), np.full(len(cells), -1), np.arange(len(cells)), 0
    while len(left):
        at = (wanted[left] + tried) % slots
        is_free = owner[at] < 0
        owner[at[is_free]] = left[is_free]  # of several, one remains
        is_placed = owner[at] == left
        place[left[is_placed]] = at[is_placed]
        left, tried = left[~is_placed], tried + 1
    return place, max(tried, 1)
