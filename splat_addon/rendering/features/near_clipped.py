# SPDX-License-Identifier: GPL-3.0-or-later
"""Splats that reach the near plane: methods that work in the picture draw them in space, which the hardware clips."""

from __future__ import annotations

from ..plan.graph import Part
from . import depth_format


def passes(planning):
    """None; it says whether there may be any."""
    if planning.shown:
        if planning.find(depth_format.extent).reaches_near:
            planning.has("NEAR_CLIPPED", "splats that may reach the near plane are drawn in space")
        else:
            planning.skip("near-clipped splats", "none reaches the near plane")
    return ()


def is_present(planning) -> bool:
    return planning.find(depth_format.extent).reaches_near


def parts(planning, p):
    if p.host == "screen_space.frag":
        yield Part("near_clipped", varyings=(("flat", "float", "near_clipped"),))
