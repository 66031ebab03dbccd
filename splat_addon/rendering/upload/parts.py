# SPDX-License-Identifier: GPL-3.0-or-later
"""Sets of more splats than a texture holds are stored in parts, one texture each.

A part has `PART` successive places of the storage order, so that a hierarchy, its cuts and the order know nothing of
parts; only what is written into textures, and what is drawn from one, is divided.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...hierarchy import Hierarchy
from ...surfels import Surfels, concatenate
from ..device.interface import MAX_TEXTURE_EDGE
from .stored_order import SPLATS_PER_ROW

PART = SPLATS_PER_ROW * MAX_TEXTURE_EDGE


def places_in_parts(count: int) -> Iterator[slice]:
    """The places of each part of `count` of them; there is at least one part."""
    return (slice(start, min(start + PART, count)) for start in range(0, max(count, 1), PART))


def place_in_part(place: int, part: int) -> int:
    """A place of the storage, counted from where a part begins."""
    return place - part * PART


def largest_part(count: int) -> int:
    """The number of places in the largest part of `count` of them."""
    return min(count, PART)


def stored_parts(surfels: Surfels, levels: Hierarchy | None, order: np.ndarray) -> Iterator[tuple[Surfels, np.ndarray]]:
    """For each part, surfels and which of them lie at its places, in their order.

    order: of `stored_order`, or its beginning: indices of the surfels and then of the nodes of `levels`.
    """
    if len(order) <= PART:
        yield (concatenate([surfels, levels.nodes]) if levels else surfels), order
        return
    for places in places_in_parts(len(order)):
        # only a part is copied at a time, because all of it would be in memory twice
        own = order[places]
        is_node = own >= len(surfels)
        some = _rows(surfels, own[~is_node])
        if is_node.any():
            some = concatenate([some, _rows(levels.nodes, own[is_node] - len(surfels))])
        yield some, np.arange(len(some), dtype=np.int32)


def _rows(surfels: Surfels, rows: np.ndarray) -> Surfels:
    arrays = {name: array[rows] for name, array in surfels.arrays().items()}
    return Surfels(origin=surfels.origin, is_solid=surfels.is_solid, **arrays)
