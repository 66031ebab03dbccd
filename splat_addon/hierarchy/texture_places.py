# SPDX-License-Identifier: GPL-3.0-or-later
"""Texture coordinates of merged surfels: the mean, and the mean change per object unit along the plane.

If children deviate from that by more than a fraction of their cell, as across the border of a chart, or have no
texture, the merged surfel has no texture and shows its colour, the mean of its children's.
"""

from __future__ import annotations

import numpy as np

from .runs import Runs

#: Maximum deviation, in cells.
MOST_SLIP = 0.5


def gradients(surfels: dict[str, np.ndarray], x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """(6, N) gradient of u, then of v, along the three axes of the object.

    surfels: fields of N surfels. x, y: (N, 3) unit axes of the ellipses.
    """
    along = surfels["uv_along_x"] / surfels["scales"][:, :1], surfels["uv_along_y"] / surfels["scales"][:, 1:]
    rows = [x * along[0][:, k : k + 1] + y * along[1][:, k : k + 1] for k in (0, 1)]
    return np.concatenate(rows, axis=1).T


def merged_places(children, shares: np.ndarray, offsets: np.ndarray, runs: Runs, cell: float) -> np.ndarray:
    """(8, m) texture coordinates and gradients of m merged surfels from (8, n) of their children.

    shares: (n,) each child's share of its parent's area. offsets: (3, n) positions of the children relative to their
    parent.
    """
    mean = runs.sum(children * shares)
    of_child = runs.spread(mean)
    size = np.sqrt(np.einsum("kn,kn->n", mean[2:], mean[2:]) / 2)
    off = [children[k] - of_child[k] - np.einsum("an,an->n", of_child[2 + 3 * k : 5 + 3 * k], offsets) for k in (0, 1)]
    slip = runs.largest(np.hypot(*off))
    has_texture = runs.least((children[2:] != 0).any(axis=0).astype(np.float32)) > 0
    mean[2:, ~(has_texture & (slip <= MOST_SLIP * cell * size))] = 0
    return mean


def along_axes(places: np.ndarray, axes: np.ndarray) -> dict[str, np.ndarray]:
    """Fields of `Surfels` from (8, m) places and (2, 3, m) half-axis vectors."""
    moved = np.einsum("kan,ban->bkn", places[2:].reshape(2, 3, -1), axes)
    return {"uvs": places[:2].T, "uv_along_x": moved[0].T, "uv_along_y": moved[1].T}
