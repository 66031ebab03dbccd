# SPDX-License-Identifier: GPL-3.0-or-later
"""Texture coordinates of merged surfels: the mean, and the mean change per object unit along the plane.

If children deviate from that by more than a fraction of their cell, as across the border of a chart, or have no
texture, the merged surfel has no texture and shows its colour, the mean of its children's.
"""

from __future__ import annotations

import numpy as np

from .families import dot, for_children, largest, total

#: Maximum deviation, in cells.
MOST_SLIP = 0.5


def gradients(surfels: dict[str, np.ndarray], x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """(6, N) gradient of u, then of v, along the three axes of the object.

    surfels: fields of N surfels. x, y: (3, N) unit axes of the ellipses.
    """
    along = surfels["uv_along_x"].T / surfels["scales"][:, 0], surfels["uv_along_y"].T / surfels["scales"][:, 1]
    return np.concatenate([x * along[0][k] + y * along[1][k] for k in (0, 1)])


def merged_places(children, shares: np.ndarray, offsets: np.ndarray, cell: float) -> np.ndarray:
    """(8, m) texture coordinates and gradients of m merged surfels from (8, c, m) of their children.

    shares: (c, m) each child's share of its parent's area. offsets: (3, c, m) positions of the children relative to
        their parent.
    """
    mean = total(children * shares)
    of_child = for_children(mean)
    size = np.sqrt(np.einsum("kn,kn->n", mean[2:], mean[2:]) / 2)
    off = [children[k] - of_child[k] - dot(of_child[2 + 3 * k : 5 + 3 * k], offsets) for k in (0, 1)]
    slip = largest(np.hypot(*off))
    has_texture = (children[2:] != 0).any(axis=0).all(axis=0)
    mean[2:, ~(has_texture & (slip <= MOST_SLIP * cell * size))] = 0
    return mean


def along_axes(places: np.ndarray, axes: np.ndarray) -> dict[str, np.ndarray]:
    """Fields of `Surfels` from (8, m) places and (2, 3, m) half-axis vectors."""
    moved = np.einsum("kan,ban->bkn", places[2:].reshape(2, 3, -1), axes)
    return {"uvs": places[:2].T, "uv_along_x": moved[0].T, "uv_along_y": moved[1].T}
