# SPDX-License-Identifier: GPL-3.0-or-later
"""Many instances of one kind are drawn by one call: vertices look their values up in a table."""

from __future__ import annotations

from ..detail import steps
from ..plan.batches import INSTANCES_PER_ROW
from ..plan.graph import Part
from ..plan.uniforms import TEXELS_PER_INSTANCE
from .drawing import SPLAT_HOSTS

CONSTANTS = {"INSTANCES_PER_ROW": INSTANCES_PER_ROW, "TEXELS_PER_INSTANCE": TEXELS_PER_INSTANCE}
DRAWN = {"instances": lambda tile, placed: tile.instance_table(placed.items)}


def _most(planning) -> int:
    """The most instances of one kind."""
    return max((kind.count for kind in planning.scene.table.kinds), default=0)


def passes(planning):
    """No passes; records whether there are any."""
    if planning.shown and is_present(planning):
        planning.has("TOGETHER", f"up to {planning.find(_most):,} instances are alike, and drawn together")
    return ()


def is_present(planning) -> bool:
    return planning.find(_most) >= steps.LEAST_TOGETHER


def parts(planning, p):
    if p.host in (*SPLAT_HOSTS, "visibility.frag", "polygons.frag"):
        yield Part("together", inputs=("instances",), choices=(("instances", "table"),), only="together")
