# SPDX-License-Identifier: GPL-3.0-or-later
"""Large pictures are drawn in tiles, so that memory stays below about 1 GB."""

from __future__ import annotations

import math

from .planning import Planning

#: A target's edge in samples.
MAX_TARGET_EDGE = 4096


def tile_edge(planning: Planning) -> int:
    """Edge of a tile in pixels, from the samples per pixel along it and the square root of the hardware samples.
    Filtering silhouettes takes half as much texture memory again."""
    settings = planning.settings
    room = 2 if planning.method.filters_silhouettes else 1
    across = settings.supersampling * room * math.ceil(math.sqrt(max(settings.multisampling, 1)))
    return max(MAX_TARGET_EDGE // across, 1)


def tiles(part: tuple[int, int, int, int], edge: int) -> tuple[tuple[int, int, int, int], ...]:
    """(x, y, width, height) in pixels of the tiles that cover a part of a picture, row by row."""
    left, bottom, width, height = part
    return tuple(
        (left + x, bottom + y, min(edge, width - x), min(edge, height - y))
        for y in range(0, height, edge)
        for x in range(0, width, edge)
    )
