# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels of surfaces with holes, such as leaves on cards, are drawn whole or not at all, as often as they are opaque
(Cook et al., "Stochastic Simplification of Aggregate Detail", 2007).

They need no layers, however many are behind one another, and occlusion and reflections treat them like all that is
opaque. A merged surfel stands for a part of a crown.
"""

from __future__ import annotations

import math

from ...hierarchy.nodes import MERGED_OVERLAP
from ...large_surfels import SAMPLE_SIZE
from ..plan.graph import Part
from ..plan.hosts import DRAWING_HOSTS, Kind
from ..plan.planning import count, counted


def _count(planning) -> int:
    return count(lambda instance: instance.has_holes, planning.surfels)


passes, is_present = counted(
    "SPLAT_HOLES",
    _count,
    "images cut holes into {count} instances of surfels",
    "holes in surfels",
    "no image cuts holes into surfels",
)

#: Factors of the half-axes of samples' splats and of merged ones, which leave no gaps.
SIZE, MERGED_SIZE = 0.6, 0.8

#: How many splats of a surface overlap at a point: the area of one over that of its cell. The same of merged ones.
CONSTANTS = {
    "HOLE_SIZE": SIZE,
    "MERGED_HOLE_SIZE": MERGED_SIZE,
    "OVERLAPS": math.pi * (SIZE * SAMPLE_SIZE) ** 2,
    "MERGED_OVERLAPS": math.pi * (MERGED_SIZE * MERGED_OVERLAP) ** 2,
}


def parts(planning, p):
    if p.host in DRAWING_HOSTS and p.kind not in (Kind.LAYER, Kind.REST):
        yield Part("splat_holes", only="with_holes")
