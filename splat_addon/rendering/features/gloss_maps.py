# SPDX-License-Identifier: GPL-3.0-or-later
"""Images of the roughness and metallic of polygons; surfels have theirs stored."""

from __future__ import annotations

from ..passes.decisions import model_in
from ..passes.sums import differ
from ..plan.graph import Part
from ..plan.hosts import Host, Kind
from ..plan.planning import count, counted
from .textures import ATLAS, PLANE, pixel_variance

DRAWN = {"polygon_glosses": lambda tile, placed: tile.resources.polygon_glosses(placed.instance.polygons)}

_VARYINGS = (
    ("flat", "float", "gloss_slot"),
    ("smooth", "vec2", "gloss_uv"),
    ("flat", "vec3", "gloss_u"),
    ("flat", "vec3", "gloss_v"),
)

#: Tables of such instances have them in the last of three parts, whatever `normal_maps` says of those with both.
_TABLE = ("TABLE_PARTS", 3)


def _count(planning) -> int:
    return count(lambda instance: instance.is_glossed, planning.polygons)


passes, is_present = counted(
    "GLOSS_MAPS",
    _count,
    "{count} instances of polygons have images of roughness or metallic",
    "images of roughness and metallic",
    "no polygons have any",
)


def parts(planning, p):
    if p.host == Host.VISIBILITY and p.kind != Kind.LAYER:
        yield Part("gloss_maps", constants=(_TABLE,), only="glossed")
    if p.host == Host.POLYGONS:
        looks = differ(planning, model_in(planning, p)).materials
        if not looks:
            yield Part("gloss_maps", constants=(_TABLE,), only="glossed")
            return
        yield Part("polygon_plane", varyings=PLANE, only="glossed")
        constants = (_TABLE, ("GLOSS_VARIANCE", repr(pixel_variance(planning))))
        inputs = "polygon_glosses", *ATLAS
        yield Part(
            "gloss_maps", ("seen_gloss",), inputs=inputs, varyings=_VARYINGS, constants=constants, only="glossed"
        )
