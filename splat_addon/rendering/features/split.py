# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects drawn as polygons near the camera and as surfels beyond (Guennebaud et al. 2006, section 5)."""

from __future__ import annotations

from ..plan.graph import Part
from ..plan.hosts import SPLAT_HOSTS, Host, Kind
from ..plan.planning import count, counted


def _count(planning) -> int:
    return count(lambda placed: placed.is_split, planning.scene.table.kinds)


passes, is_present = counted(
    "SPLIT",
    _count,
    "{count} instances are polygons near the camera, or surfels beyond that",
    "split objects",
    "all are drawn whole",
)


def parts(planning, p):
    """The parts that end splats or polygons at the split distance.

    Transparent instances are surfels at every distance, and in shadow maps both forms cast shadows, so their passes
    have no such part.
    """
    if p.kind in (Kind.LAYER, Kind.REST, Kind.SHADOW):
        return
    varyings = (("smooth", "vec3", "split_place"),)
    if p.host in SPLAT_HOSTS:
        yield Part("split")
    if p.host == Host.VISIBILITY:
        yield Part("split")
        yield Part("split", varyings=varyings, only="polygons")
    if p.host == Host.POLYGONS:
        yield Part("split", varyings=varyings)
