# SPDX-License-Identifier: GPL-3.0-or-later
"""Fades samples whose splats' weights sum to less than a threshold (the view-independent paper, section 4.5)."""

from __future__ import annotations

from ..plan.graph import Part
from .drawing import LIT_HOSTS

VALUES = {"edge_threshold": ("float", lambda tile: tile.settings.edge_threshold)}


def passes(planning):
    """No passes; records whether there is a threshold."""
    if planning.shown:
        threshold = planning.settings.edge_threshold
        if threshold == 0:
            planning.skip("edge threshold", "it is 0: whatever a splat reaches is covered")
        elif planning.method.rasterizer != "object_space":
            planning.skip("edge threshold", f"the weights of {planning.method.name} are smaller where it filters")
        else:
            planning.has("EDGE_THRESHOLD", f"pixels whose weights sum to less than {threshold:g} fade")
    return ()


def is_present(planning) -> bool:
    return planning.settings.edge_threshold > 0 and planning.method.rasterizer == "object_space"


def parts(planning, p):
    if p.host in LIT_HOSTS:
        yield Part("edge_threshold")
