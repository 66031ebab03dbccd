# SPDX-License-Identifier: GPL-3.0-or-later
"""Normal maps of polygons; surfels have them in their shading normals."""

from __future__ import annotations

from ..plan.graph import Part
from ..plan.hosts import Host, Kind
from ..plan.planning import count, counted
from .textures import ATLAS, PLANE, pixel_variance

DRAWN = {"polygon_bumps": lambda tile, placed: tile.resources.polygon_bumps(placed.instance.polygons)}

_VARYINGS = (
    ("flat", "float", "bump_slot"),
    ("smooth", "vec2", "bump_uv"),
    ("flat", "vec2", "bump_signs"),
    ("smooth", "vec3", "bump_tangent"),
    ("smooth", "vec3", "bump_normal"),
    ("flat", "vec3", "bump_u"),
    ("flat", "vec3", "bump_v"),
)


def _count(planning) -> int:
    return count(lambda instance: instance.is_bumped, planning.polygons)


passes, is_present = counted(
    "NORMAL_MAPS", _count, "{count} instances of polygons have normal maps", "normal maps", "no polygons have any"
)


def parts(planning, p):
    table = ("TABLE_PARTS", 2)
    if p.host == Host.VISIBILITY and p.kind != Kind.LAYER:
        yield Part("normal_maps", constants=(table,), only="bumped")
    if p.host == Host.POLYGONS:
        yield Part("polygon_plane", varyings=PLANE, only="bumped")
        constants = (table, ("BUMP_VARIANCE", repr(pixel_variance(planning))))
        inputs = "polygon_bumps", *ATLAS
        yield Part("normal_maps", inputs=inputs, varyings=_VARYINGS, constants=constants, only="bumped")
