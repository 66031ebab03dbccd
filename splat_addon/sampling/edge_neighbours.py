# SPDX-License-Identifier: GPL-3.0-or-later
"""Which surfels lie near which border edges, by a hash of cells in space."""

from __future__ import annotations

import numpy as np

from .borders import Borders

#: Edges are cut into pieces of at most this, in the largest radius of a surfel.
_PIECE = 0.5

_PRIMES = np.array((73856093, 19349663, 83492791), np.int64)


def edge_neighbours(
    positions: np.ndarray, radii: np.ndarray, borders: Borders, origin: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """(m,) surfels and (m,) sides of edges that may be nearer to them than their radius; all such pairs, each once.

    positions: (N, 3) relative to `origin`. radii: (N,).
    """
    largest = float(radii.max(initial=0))
    reach = largest * (1 + _PIECE / 2)
    points, edge = _pieces(borders, origin, _PIECE * largest)
    cell = 2 * reach
    corner = np.floor((points - reach) / cell).astype(np.int64)
    keys, piece = [], np.tile(np.arange(len(points)), 8)
    for dx, dy, dz in np.ndindex(2, 2, 2):
        keys.append(_key(corner + (dx, dy, dz)))
    keys = np.concatenate(keys)
    order = np.argsort(keys, kind="stable")
    keys, piece = keys[order], piece[order]
    own = _key(np.floor(positions / np.float32(cell)).astype(np.int64))
    near = _sieved(own, keys)
    first, last = (np.searchsorted(keys, own[near], side) for side in ("left", "right"))
    counts = last - first
    surfel = np.repeat(near, counts)
    within = np.arange(len(surfel)) - np.repeat(np.cumsum(counts) - counts, counts)
    piece = piece[np.repeat(first, counts) + within]
    offset = positions[surfel] - points[piece]
    limit = radii + largest * (_PIECE / 2)
    close = np.flatnonzero(np.einsum("ij,ij->i", offset, offset) <= limit[surfel] ** 2)
    pairs = np.unique(surfel[close] * np.int64(edge.max(initial=0) + 1) + edge[piece[close]])
    surfel, edge = np.divmod(pairs, np.int64(edge.max(initial=0) + 1))
    starts = np.searchsorted(borders.edges, np.arange(borders.edges[-1] + 2))
    sides = np.diff(starts)[edge]
    within = np.arange(sides.sum()) - np.repeat(np.cumsum(sides) - sides, sides)
    return np.repeat(surfel, sides), np.repeat(starts[edge], sides) + within


def _pieces(borders: Borders, origin: np.ndarray, longest: float) -> tuple[np.ndarray, np.ndarray]:
    """(k, 3) float32 middles of pieces of the edges, relative to `origin`, and (k,) the edge of each."""
    first = np.flatnonzero(np.append(True, borders.edges[1:] != borders.edges[:-1]))
    start, end = borders.start[first] - origin, borders.end[first] - origin
    counts = np.maximum(np.ceil(np.linalg.norm(end - start, axis=1) / longest), 1).astype(np.int64)
    edge = np.repeat(np.arange(len(first)), counts)
    place = (np.arange(len(edge)) - np.repeat(np.cumsum(counts) - counts, counts) + 0.5) / counts[edge]
    return (start[edge] + (end - start)[edge] * place[:, None]).astype(np.float32), edge


def _key(cells: np.ndarray) -> np.ndarray:
    """(n,) int64 that are equal for equal (n, 3) cells, and rarely for others."""
    x, y, z = (cells * _PRIMES).T
    return x ^ y ^ z


def _sieved(own: np.ndarray, keys: np.ndarray) -> np.ndarray:
    """Where in `own` a key is that may be among `keys`."""
    size = 1 << max(int(len(keys) * 8).bit_length(), 10)
    there = np.zeros(size, bool)
    there[keys & (size - 1)] = True
    return np.flatnonzero(there[own & (size - 1)])
