# SPDX-License-Identifier: GPL-3.0-or-later
"""Fades samples whose splats' weights sum to less than a threshold (the view-independent paper, section 4.5)."""

from __future__ import annotations

from ..plan.graph import Part
from ..plan.hosts import LIT_HOSTS

VALUES = {"edge_threshold": ("float", lambda tile: tile.settings.edge_threshold)}


def passes(planning):
    """No passes; records whether there is a threshold."""
    if planning.shown:
        threshold = planning.settings.edge_threshold
        if threshold == 0:
            planning.skip("edge threshold", "it is 0: whatever a splat reaches is covered")
        elif planning.method.rasterizer == "point_sprite":
            planning.skip("edge threshold", f"of {planning.method.name} one splat is seen, whose weight is 1")
        elif planning.method.filters_silhouettes:
            planning.skip("edge threshold", f"{planning.method.name} filters silhouettes, by what is visible")
        else:
            planning.has("EDGE_THRESHOLD", f"pixels whose weights sum to less than {threshold:g} fade")
    return ()


def is_present(planning) -> bool:
    method = planning.method
    return (
        planning.settings.edge_threshold > 0 and method.rasterizer != "point_sprite" and not method.filters_silhouettes
    )


def parts(planning, p):
    if p.host in LIT_HOSTS:
        yield Part("edge_threshold", ("printed_sums",) if planning.settings.as_printed else ("fades",))
