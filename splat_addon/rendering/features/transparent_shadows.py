# SPDX-License-Identifier: GPL-3.0-or-later
"""Shadows of transparent objects: their splats leave gaps in a shadow map in proportion to the light they let
through.

Averaging these gaps takes several times the taps, which every lit sample pays for. Cut-outs, such as cards of leaves,
need none, because they let light through only beside what they show.
"""

from __future__ import annotations

from ..passes.decisions import layers, shadows
from ..plan.graph import Part
from ..plan.hosts import LIGHTING_HOSTS, Host, Kind
from ..plan.planning import any_of, count, counted


def _casting(planning) -> int:
    if not planning.find(shadows).maps or not planning.find(layers).count:
        return 0
    return count(lambda i: i.is_transparent and i.casts_shadow, planning.surfels)


def _averaged(planning) -> bool:
    """Whether any of them lets light through evenly."""
    return any_of(lambda i: i.is_transparent and i.casts_shadow and not i.surfels.is_cut_out, planning.surfels)


passes, is_present = counted(
    "SCREEN_DOOR",
    _casting,
    "shadows of {count} instances are as transparent as those",
    "transparent shadows",
    "nothing transparent casts any",
)


def parts(planning, p):
    if p.host == Host.VISIBILITY and p.kind == Kind.SHADOW:
        yield Part("transparent_shadows", varyings=(("flat", "vec2", "opacity_surface"),), only="splats")
    if p.host in LIGHTING_HOSTS and planning.find(_averaged):
        yield Part("transparent_shadows", choices=(("shadow_taps", "masked"),))
