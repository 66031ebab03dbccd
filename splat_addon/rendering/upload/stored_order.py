# SPDX-License-Identifier: GPL-3.0-or-later
"""The order in which surfels lie on the device, for every storage format.

Neighbours in space are close together, so that splats drawn in succession are near in memory and in the picture.
Clipped surfels come first, so that they can be drawn by a separate call. Merged surfels come last, again the clipped
ones first, and start in a new row, so that the surfels are stored as they would be without them.
"""

from __future__ import annotations

import numpy as np

from ...hierarchy import Hierarchy
from ...hierarchy.ordering import spatial_order
from ...surfels import Surfels

SPLATS_PER_ROW = 512


def stored_order(surfels: Surfels, levels: Hierarchy | None = None) -> np.ndarray:
    """(stored,) int32 indices of surfels and, from N on, of the merged nodes of `levels`.

    The last surfel is repeated to fill its row, if nodes follow.
    """
    order = _clipped_first(surfels)
    if levels is None:
        return order
    order = np.pad(order, (0, _first_node(surfels) - len(order)), "edge")
    return np.concatenate([order, len(surfels) + _clipped_first(levels.nodes)])


def clipped_places(surfels: Surfels, levels: Hierarchy | None = None) -> tuple[slice, ...]:
    """Where clipped surfels are in that order, and clipped nodes."""
    places = slice(0, surfels.clipped_count)
    if levels is None:
        return (places,)
    first = _first_node(surfels)
    return places, slice(first, first + levels.nodes.clipped_count)


def _clipped_first(surfels: Surfels) -> np.ndarray:
    order = spatial_order(surfels.positions).astype(np.int32)
    if not surfels.clipped_count:
        return order
    # turned round: where one kind ends and the other begins, neighbours in the order stay neighbours
    is_cut = surfels.is_cut()[order]
    return np.concatenate([order[is_cut][::-1], order[~is_cut]])


def _first_node(surfels: Surfels) -> int:
    return -(-len(surfels) // SPLATS_PER_ROW) * SPLATS_PER_ROW


def places_of(order: np.ndarray, count: int) -> np.ndarray:
    """(count,) int32 the first place in the order at which each number is stored."""
    places = np.empty(count, np.int32)
    places[order[::-1]] = np.arange(len(order) - 1, -1, -1, dtype=np.int32)
    return places
