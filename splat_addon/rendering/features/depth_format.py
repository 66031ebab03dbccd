# SPDX-License-Identifier: GPL-3.0-or-later
"""The format of the depth buffer: hardware depth, or a linear one that fragments write."""

from __future__ import annotations

from ..passes.decisions import depth_format, extent


def _range(tile) -> tuple[float, float]:
    """The range of depths, in view units."""
    found = tile.plan.find(extent)
    return found.near * tile.view.scale, found.far * tile.view.scale


VALUES = {"depth_range": ("vec2", _range)}


def passes(planning):
    """No passes; records the decision."""
    if planning.shown:
        planning.find(extent)
        if not planning.find(depth_format).is_linear:
            planning.skip("linear depth", planning.find(depth_format).why)
    return ()
