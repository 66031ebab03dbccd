# SPDX-License-Identifier: GPL-3.0-or-later
"""Splats that reach the near plane: screen-space methods draw them in space, where the hardware clips them."""

from __future__ import annotations

from ..passes.decisions import extent
from ..plan.graph import Part
from ..plan.hosts import Host


def passes(planning):
    """No passes; records whether there may be any."""
    if planning.shown:
        if planning.find(extent).reaches_near:
            planning.has("NEAR_CLIPPED", "splats that may reach the near plane are drawn in space")
        else:
            planning.skip("near-clipped splats", "none reaches the near plane")
    return ()


def is_present(planning) -> bool:
    return planning.find(extent).reaches_near


def parts(planning, p):
    if p.host == Host.SCREEN_SPACE:
        yield Part("near_clipped", varyings=(("flat", "float", "near_clipped"),))
