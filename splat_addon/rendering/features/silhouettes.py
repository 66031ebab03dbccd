# SPDX-License-Identifier: GPL-3.0-or-later
"""Silhouettes, filtered as colours are: what the other passes do for it. The filter itself is the resolve pass's."""

from __future__ import annotations

from ..plan.frame_plan import FILTER_MARGIN
from ..plan.graph import Part

CONSTANTS = {"FILTER_REACH": FILTER_MARGIN}


def have_rows(planning) -> bool:
    """Whether visibility has more rows than samples have: what transparent layers hide is known at samples alone."""
    from . import transparency

    return planning.method.filters_silhouettes and not planning.find(transparency.layers)


def parts(planning, p):
    if planning.method.filters_silhouettes:
        if p.host == "screen_space.frag" and p.kind in ("opaque", "layer"):
            yield Part("silhouettes")
        if p.host in ("depth_bounds.frag", "oit_layer.frag"):
            yield Part("silhouettes")
