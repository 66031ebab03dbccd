# SPDX-License-Identifier: GPL-3.0-or-later
"""Which side of each point is seen from outside of the cloud, from many directions: where signs that neighbours hand on
to each other are wrong, whole regions are, and those are seen."""

from __future__ import annotations

import numpy as np

from ...workers import in_portions, run_all
from .normals import CHUNK

#: Directions from which the cloud is seen.
_DIRECTIONS = 26

#: Edge of a cell of the pictures, in spacings, and the most cells along an edge of a picture. A point is hidden if
#: another one in its own cell or the eight around it is nearer by this many edges.
_CELL, _MOST_CELLS, _BEHIND = 4.0, 2048, 3.0

#: Radians by which normals differ that are counted together with a weight of 0.6.
_ALIKE = 0.25


def seen_sides(
    positions: np.ndarray, normals: np.ndarray, neighbours: np.ndarray, spacing: float
) -> tuple[np.ndarray, np.ndarray]:
    """(N,) float32 how much more is seen, from all around, of the sides of points that normals face than of the others;
    and (N,) how much is seen of both.

    positions, normals: (N, 3), normals unit. neighbours: (N, k) indices. spacing: between points.
    """
    places, columns = np.float32(positions - positions.mean(axis=0)), np.ascontiguousarray(normals.T, np.float32)
    cell = max(_CELL * spacing, float(np.ptp(places, axis=0).max()) / _MOST_CELLS)
    found = np.empty((_DIRECTIONS, len(places)), np.float32)

    def look(row: np.ndarray, direction: np.ndarray):
        cosine = direction @ columns
        np.multiply(cosine, np.abs(cosine), out=row)
        row *= _seen_from(direction, places, cell)

    run_all(lambda pair=pair: look(*pair) for pair in zip(found, _directions(), strict=True))
    votes, seen = found.sum(axis=0), np.abs(found).sum(axis=0)
    sides, both = np.empty(len(places), np.float32), np.empty(len(places), np.float32)

    def count(some: slice):
        at = np.ascontiguousarray(neighbours[some].T)
        cosine = sum(column[at] * column[some] for column in columns)
        weight = np.exp((np.abs(cosine) - 1) / np.float32(_ALIKE**2))
        both[some] = seen[some] + np.einsum("kn,kn->n", weight, seen[at])
        sides[some] = votes[some] + np.einsum("kn,kn->n", weight * np.sign(cosine), votes[at])

    in_portions(len(places), CHUNK, count)
    return sides, both


def _directions() -> np.ndarray:
    """(D, 3) float32 unit vectors, spread evenly: a spiral whose turns are golden angles."""
    steps = np.arange(_DIRECTIONS) + 0.5
    height, angle = 1 - 2 * steps / _DIRECTIONS, np.pi * (1 + np.sqrt(5)) * steps
    across = np.sqrt(1 - height * height)
    return np.stack([np.cos(angle) * across, np.sin(angle) * across, height], axis=1).astype(np.float32)


def _seen_from(direction: np.ndarray, places: np.ndarray, cell: float) -> np.ndarray:
    """(N,) bool: whether nothing hides (N, 3) places from far away in a direction."""
    aside = np.cross(direction, np.eye(3, dtype=np.float32)[np.abs(direction).argmin()])
    aside /= np.linalg.norm(aside)
    u, v, height = np.stack([aside, np.cross(direction, aside), direction]) @ places.T
    # a border of empty cells
    row, column = (((along - along.min()) / cell).astype(np.int64) + 1 for along in (u, v))
    nearest = np.full((row.max() + 2, column.max() + 2), -np.inf, np.float32)
    cells = row * nearest.shape[1] + column
    np.maximum.at(nearest.reshape(-1), cells, height)
    for _ in range(2):
        around = nearest.copy()
        np.maximum(around[1:], nearest[:-1], out=around[1:])
        np.maximum(around[:-1], nearest[1:], out=around[:-1])
        nearest = np.ascontiguousarray(around.T)
    return height > nearest.reshape(-1)[cells] - np.float32(_BEHIND * cell)
