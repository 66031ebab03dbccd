# SPDX-License-Identifier: GPL-3.0-or-later
"""Which surfels lie near which border edges, by a hash of cells in space."""

from __future__ import annotations

import numpy as np

from ..ldc.scan_conversion import expand
from .borders import Borders

#: Edges are cut into pieces of at most this, in the largest radius of a surfel.
_PIECE = 1.0

#: Of the hash of a cell (Teschner et al., "Optimized Spatial Hashing", 2003).
_PRIMES = np.array((73856093, 19349663, 83492791), np.int32)


def edge_neighbours(
    positions: np.ndarray, radii: np.ndarray, borders: Borders, origin: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """(m,) surfels, ascending, and (m,) sides of edges that are nearer to them than their radius; each pair once.

    positions: (N, 3) relative to `origin`. radii: (N,).
    """
    largest = float(radii.max(initial=0))
    starts = np.flatnonzero(np.append(True, borders.edges[1:] != borders.edges[:-1]))
    sides = np.diff(np.append(starts, len(borders)))
    start, end = (np.ascontiguousarray((ends[starts] - origin).T, np.float32) for ends in (borders.start, borders.end))
    points, edge_of_piece = _pieces(start, end, _PIECE * largest)
    # In cells of twice the reach of a surfel, all that reach a piece lie in 8 cells at most.
    reach = largest * (1 + _PIECE / 2)
    corner = np.floor((points - np.float32(reach)) * np.float32(0.5 / reach)).astype(np.int32)
    bits = min(max(int(8 * len(edge_of_piece)).bit_length() + 1, 10), 20)
    keys = np.concatenate([_keys(bits, *(corner + np.array(step, np.int32)[:, None])) for step in np.ndindex(2, 2, 2)])
    order = np.argsort(keys, kind="stable")
    keys, piece = keys.take(order), np.tile(np.arange(len(edge_of_piece)), 8).take(order)

    counts = np.bincount(keys, minlength=1 << bits)
    firsts = np.cumsum(counts) - counts
    own = _keys(bits, *(np.floor(column * np.float32(0.5 / reach)).astype(np.int32) for column in positions.T))
    near = np.flatnonzero((counts > 0).take(own))
    own = own.take(near)
    row, number = expand(counts.take(own))
    piece = piece.take(firsts.take(own).take(row) + number)
    x, y, z = (
        column.take(near).take(row) - point.take(piece) for column, point in zip(positions.T, points, strict=True)
    )
    limit = radii.take(near) + np.float32(largest * _PIECE / 2)
    close = np.flatnonzero(x * x + y * y + z * z <= (limit * limit).take(row))
    count = len(starts)
    pairs = np.sort(near.take(row.take(close)) * np.int64(count) + edge_of_piece.take(piece.take(close)))
    pairs = pairs[np.append(True, pairs[1:] != pairs[:-1])] if len(pairs) else pairs
    surfel, edge = np.divmod(pairs, count)
    close = _distances(positions, surfel, start, end, edge) <= radii.take(surfel) * np.float32(1 + 1e-4)
    surfel, edge = surfel.compress(close), edge.compress(close)
    row, number = expand(sides.take(edge))
    return surfel.take(row), starts.take(edge).take(row) + number


def _pieces(start: np.ndarray, end: np.ndarray, longest: float) -> tuple[np.ndarray, np.ndarray]:
    """(3, k) float32 middles of pieces of (3, e) edges, and (k,) the edge of each."""
    along = end - start
    counts = np.maximum(np.ceil(np.sqrt((along * along).sum(axis=0)) / longest), 1).astype(np.int64)
    edge, number = expand(counts)
    place = ((number + 0.5) / counts.take(edge)).astype(np.float32)
    return start.take(edge, axis=1) + along.take(edge, axis=1) * place, edge


def _distances(positions: np.ndarray, surfel: np.ndarray, start: np.ndarray, end: np.ndarray, edge: np.ndarray):
    """(m,) float32 of surfels from segments."""
    along = end - start
    square = np.maximum((along * along).sum(axis=0), np.float32(1e-37))
    offset = [column.take(surfel) - s.take(edge) for column, s in zip(positions.T, start, strict=True)]
    along = along.take(edge, axis=1)
    share = np.clip(sum(o * a for o, a in zip(offset, along, strict=True)) / square.take(edge), 0, 1)
    return np.sqrt(sum((o - a * share) ** 2 for o, a in zip(offset, along, strict=True)))


def _keys(bits: int, x: np.ndarray, y: np.ndarray, z: np.ndarray) -> np.ndarray:
    """(n,) int32 that are equal for equal cells, of so many bits; seldom for others."""
    keys = x * _PRIMES[0]
    keys ^= y * _PRIMES[1]
    keys ^= z * _PRIMES[2]
    keys &= (1 << bits) - 1
    return keys
