# SPDX-License-Identifier: GPL-3.0-or-later
"""Many instances of one kind are drawn by one call: vertices look their values up in a table."""

from __future__ import annotations

from ..detail import steps
from ..plan.batches import INSTANCES_PER_ROW
from ..plan.graph import Part
from ..plan.hosts import SPLAT_HOSTS, Host
from ..plan.uniforms import TEXELS_PER_INSTANCE

CONSTANTS = {"INSTANCES_PER_ROW": INSTANCES_PER_ROW, "TEXELS_PER_INSTANCE": TEXELS_PER_INSTANCE}
DRAWN = {"instances": lambda tile, placed: tile.instance_table(placed.items)}


def _count(planning) -> int:
    """The number of instances of surfels, or of polygons, that may be drawn together."""
    return max(sum(kind.count for kind in kinds) for kinds in (planning.surfels, planning.polygons))


def passes(planning):
    """No passes; records whether there are any."""
    if planning.shown and is_present(planning):
        planning.has("TOGETHER", f"of {planning.find(_count):,} instances, those that are alike or small are one call")
    return ()


def is_present(planning) -> bool:
    return planning.find(_count) >= steps.LEAST_TOGETHER


def parts(planning, p):
    if p.host in (*SPLAT_HOSTS, Host.VISIBILITY, Host.POLYGONS):
        yield Part("together", inputs=("instances",), choices=(("instances", "table"),), only="together")
