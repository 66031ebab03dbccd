# SPDX-License-Identifier: GPL-3.0-or-later
"""Bounced light as texels: a hash table of cells, and what the six sides of each receive.

Source: Teschner et al., "Optimized Spatial Hashing for Collision Detection of Deformable Objects", 2003 (the hash).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..scene.light import MAX_IRRADIANCE
from .sides import SIDES

#: Texels in a row of the texture.
PER_ROW = 1024
#: What the sides have that no surface has: a negative share of the world.
ABSENT = -1.0
#: Texels of a cell: its sides, and the bits of two sides each. How many of these are in the first number.
PER_CELL, _HALF = SIDES + SIDES // 2, 13
#: Slots per cell, at least.
_ROOM = 2
_FACTORS = np.array([73856093, 19349663, 83492791], np.uint32)


class Table(NamedTuple):
    """texels: (rows, 1024, 4) float32: for each slot the cell's numbers and 1 + its row, or 0; then for each row the
    six sides' irradiance over pi and the world's share, and for two sides in each of three texels the bits of 27 cells
    around it, as of `link_bit`, that the side is linked with: the first 13, and the rest. slots: a power of two.
    probes: the most slots that a look-up reads."""

    texels: np.ndarray
    slots: int
    probes: int


def make_table(
    cells: np.ndarray, sides: np.ndarray, irradiance: np.ndarray, is_open: np.ndarray, linked: tuple | None = None
) -> Table:
    """Of merged surfels: cells: (m, 3) whole numbers. sides: (m,). irradiance: (m, 3). is_open: (m,). linked: pairs of
    them, as of `BouncedLight`."""
    every, row = np.unique(cells, axis=0, return_inverse=True)
    slots = 1 << int(np.ceil(np.log2(max(_ROOM * len(every), 2))))
    place, probes = _placed(every, slots)
    texels = np.zeros((slots + len(every) * PER_CELL, 4), np.float32)
    texels[place, :3], texels[place, 3] = every, 1 + np.arange(len(every))
    of_cells = texels[slots:].reshape(-1, PER_CELL, 4)
    values = of_cells[:, :SIDES]
    values[..., 3] = ABSENT
    of_cells[:, SIDES:] = _links(cells, sides, linked, row.ravel(), len(every)).reshape(len(every), SIDES // 2, 4)
    bounded = np.minimum(irradiance, MAX_IRRADIANCE)  # as lamps have it
    values[row.ravel(), sides] = np.concatenate([bounded, is_open[:, None]], axis=1)
    rows = -(-len(texels) // PER_ROW)
    padded = np.zeros((rows * PER_ROW, 4), np.float32)
    padded[: len(texels)] = texels
    return Table(padded.reshape(rows, PER_ROW, 4), slots, probes)


def link_bit(steps: np.ndarray) -> np.ndarray:
    """(n,) numbers of the cells (n, 3) steps of -1, 0 or 1 away; 13 is the same one."""
    return (steps + 1) @ np.array([9, 3, 1])


def _links(cells: np.ndarray, sides: np.ndarray, linked: tuple | None, row: np.ndarray, count: int) -> np.ndarray:
    """(count, 6, 2) float32 bits of each cell and side, those of 0 to 12 and of 13 to 26."""
    if linked is None:
        return np.broadcast_to(np.array([(1 << _HALF) - 1, (1 << (27 - _HALF)) - 1], np.float32), (count, SIDES, 2))
    bits = np.zeros((count, SIDES, 27), bool)
    bits[..., _HALF] = True
    for first, second in (linked, linked[::-1]):
        bits[row[first], sides[first], link_bit(cells[second] - cells[first])] = True
    powers = 2.0 ** np.concatenate([np.arange(_HALF), np.arange(27 - _HALF)])
    return np.stack([bits[..., :_HALF] @ powers[:_HALF], bits[..., _HALF:] @ powers[_HALF:]], axis=-1)


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
