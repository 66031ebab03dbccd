# SPDX-License-Identifier: GPL-3.0-or-later
"""Leaves within a crown keep the world's light from one another, also where the crown has few pixels."""

from __future__ import annotations

from ..bounced.crowns import is_crown
from ..plan.graph import Part
from ..plan.hosts import LIT_HOSTS
from ..plan.planning import any_of
from . import ambient_occlusion


def crowns(planning) -> bool:
    """Whether the frame looks up how much of the world's light reaches leaves."""
    has_any = planning.shown and any_of(is_crown, planning.scene.table.seen.kinds)
    return bool(has_any) and not planning.find(ambient_occlusion.missing)


def passes(planning):
    """None of its own: it is computed before the frame, and only when the scene has changed."""
    if planning.find(crowns):
        planning.has("CROWNS", "leaves keep the world's light from one another")
    return ()


def is_present(planning) -> bool:
    return planning.find(crowns)


def parts(planning, p):
    if p.host in LIT_HOSTS:
        yield Part("crowns", inputs=("cells",))
