# SPDX-License-Identifier: GPL-3.0-or-later
"""Shadows of transparent objects: their splats leave gaps in a shadow map in proportion to the light they let
through.

Averaging these gaps takes several times the taps, which every lit sample pays for. Cut-outs, such as cards of leaves,
need none, because they let light through only beside what they show.
"""

from __future__ import annotations

from ..plan.graph import Part
from ..plan.planning import counted
from . import shadows, transparency
from .drawing import LIGHTING_HOSTS


def _casting(planning) -> int:
    if not planning.shown or not planning.find(shadows.maps) or not planning.find(transparency.layers):
        return 0
    return sum(i.is_transparent and i.casts_shadow for i in planning.scene.surfels)


def _averaged(planning) -> bool:
    """Whether any of them lets light through evenly."""
    casting = (i for i in planning.scene.surfels if i.is_transparent and i.casts_shadow)
    return any(not instance.surfels.is_cut_out for instance in casting)


passes, is_present = counted(
    "SCREEN_DOOR",
    _casting,
    "shadows of {count} instances are as transparent as those",
    "transparent shadows",
    "nothing transparent casts any",
)


def parts(planning, p):
    if p.host == "visibility.frag" and p.kind == "shadow":
        yield Part("transparent_shadows", varyings=(("flat", "vec2", "opacity_surface"),), only="splats")
    if p.host in LIGHTING_HOSTS and planning.find(_averaged):
        yield Part("transparent_shadows", choices=(("shadow_taps", "masked"),))
