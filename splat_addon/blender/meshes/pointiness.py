# SPDX-License-Identifier: GPL-3.0-or-later
"""Pointiness, the curvature by which materials find edges, as Cycles has it."""

from __future__ import annotations

import numpy as np


def pointiness(positions: np.ndarray, edges: np.ndarray, normals: np.ndarray) -> np.ndarray:
    """(V,) float32: 0.5 where flat, more on what stands out, less in what is hollow.

    It is the angle between a vertex's normal and the mean direction of its edges, over pi, averaged with those of its
    neighbours. Vertices in one place count as one.

    positions, normals: (V, 3). edges: (E, 2) vertices.
    """
    places, of_vertex = np.unique(positions + 0.0, axis=0, return_inverse=True)  # adding 0 makes -0 a 0
    of_vertex, count = of_vertex.ravel(), len(places)
    ends = np.unique(np.sort(of_vertex[edges], axis=1), axis=0)
    ends = ends[ends[:, 0] != ends[:, 1]]
    ends = np.concatenate([ends, ends[:, ::-1]])
    along = _unit(places[ends[:, 1]].astype(np.float64) - places[ends[:, 0]])
    edges_of = np.bincount(ends[:, 0], minlength=count)
    mean = _summed(ends[:, 0], along, count) / np.maximum(edges_of, 1)[:, None]
    facing = _unit(_summed(of_vertex, normals, count))
    angles = np.arccos(np.clip(np.einsum("ij,ij->i", facing, mean), -1, 1)) / np.pi
    angles[edges_of == 0] = 0
    blurred = (angles + np.bincount(ends[:, 0], angles[ends[:, 1]], minlength=count)) / (edges_of + 1)
    return blurred[of_vertex].astype(np.float32)


def _summed(rows: np.ndarray, vectors: np.ndarray, count: int) -> np.ndarray:
    """(count, 3) sums of the (n, 3) vectors of each row."""
    return np.stack([np.bincount(rows, weights, minlength=count) for weights in vectors.T], axis=1)


def _unit(vectors: np.ndarray) -> np.ndarray:
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    return vectors / np.where(length > 0, length, 1)
