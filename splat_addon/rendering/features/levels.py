# SPDX-License-Identifier: GPL-3.0-or-later
"""Levels of detail: if an instance has more surfels than its picture can show, a view draws a cut through its
hierarchy.

The indices of drawn splats are in a texture, and nothing else of the object depends on the view: several views may draw
the same instance with different cuts.
"""

from __future__ import annotations

from ..detail import hierarchies
from ..passes.decisions import merging, splat_lighting
from ..plan.graph import Part
from ..plan.hosts import SPLAT_HOSTS, Host
from ..plan.planning import count
from ..upload.cuts import NUMBERS_PER_ROW

CONSTANTS = {"NUMBERS_PER_ROW": NUMBERS_PER_ROW}


def _drawn(tile, placed):
    is_whole_level = placed.items.step is not None
    return tile.step_numbers(placed.instance) if is_whole_level else tile.cuts(placed)[placed.part].numbers


DRAWN = {"drawn_splats": _drawn}


def passes(planning):
    """No passes; records whether there are any."""
    if planning.shown:
        if not planning.settings.detail_tolerance:
            planning.skip("levels of detail", "every surfel is drawn, as the tolerance is 0")
        elif planning.find(splat_lighting).is_wanted:
            planning.skip("levels of detail", "every surfel is lit by itself")
        elif found := planning.find(merging):
            instances = count(lambda instance: instance.surfels in found, planning.surfels)
            planning.has("LEVELS", f"{instances} instances may have surfels too small to be seen one by one")
        else:
            planning.skip(
                "levels of detail", f"no instance of {hierarchies.LEAST_SURFELS:,} surfels or more is worth it"
            )
    return ()


def is_present(planning) -> bool:
    return bool(planning.find(merging))


def parts(planning, p):
    """The part that draws a cut, or lights it splat by splat."""
    if p.host in (*SPLAT_HOSTS, Host.VISIBILITY, Host.LIT_SPLATS):
        yield Part("levels", inputs=("drawn_splats",), only="cut")
