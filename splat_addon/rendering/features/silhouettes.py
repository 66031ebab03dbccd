# SPDX-License-Identifier: GPL-3.0-or-later
"""Filtered silhouettes: the preparations in other passes. The resolve pass contains the filter."""

from __future__ import annotations

from ..plan.frame_plan import FILTER_MARGIN, VISIBILITY_ROWS, FramePlan
from ..plan.graph import Part, Texture, of_samples
from ..plan.hosts import BLENDED, Host

CONSTANTS = {"FILTER_REACH": FILTER_MARGIN}


def of_rows(plan: FramePlan, pixels: tuple[int, int]) -> tuple[int, int]:
    """A texture size with this many rows per row of samples."""
    columns, rows = of_samples(plan, pixels)
    return columns, rows * VISIBILITY_ROWS


def rows_of(texture: Texture) -> int:
    """Number of the texture's rows per row of samples."""
    return VISIBILITY_ROWS if texture.per is of_rows else 1


def passes(planning):
    """No passes; records whether silhouettes are filtered."""
    planning.facts["filters_silhouettes"] = is_present(planning) and bool(planning.shown)
    return ()


def is_present(planning) -> bool:
    return planning.method.filters_silhouettes


def margin(planning) -> int:
    """Pixels that the filter reads on each side."""
    return FILTER_MARGIN if planning.facts["filters_silhouettes"] else 0


def have_rows(planning) -> bool:
    """Whether visibility has more rows than samples: transparent layers only know what they hide at samples."""
    from . import transparency

    return planning.method.filters_silhouettes and not planning.find(transparency.layers)


def parts(planning, p):
    if p.host == Host.SCREEN_SPACE and p.kind in BLENDED:
        yield Part("silhouettes")
    if p.host in (Host.DEPTH_BOUNDS, Host.OIT_LAYER):
        yield Part("silhouettes")
