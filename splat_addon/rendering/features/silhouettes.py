# SPDX-License-Identifier: GPL-3.0-or-later
"""Filtered silhouettes: the preparations in other passes. The resolve pass contains the filter."""

from __future__ import annotations

from ..plan.frame_plan import FILTER_MARGIN
from ..plan.graph import Part
from ..plan.hosts import BLENDED, Host

CONSTANTS = {"FILTER_REACH": FILTER_MARGIN}


def is_present(planning) -> bool:
    return planning.method.filters_silhouettes


def margin(planning) -> int:
    """Pixels that the filter reads on each side."""
    return FILTER_MARGIN if is_present(planning) and planning.shown else 0


def parts(planning, p):
    if p.host == Host.SCREEN_SPACE and p.kind in BLENDED:
        yield Part("silhouettes")
    if p.host in (Host.DEPTH_BOUNDS, Host.OIT_LAYER):
        yield Part("silhouettes")
