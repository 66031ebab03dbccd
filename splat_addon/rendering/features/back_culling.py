# SPDX-License-Identifier: GPL-3.0-or-later
"""Skips splats that face away, in the vertex stage (Botsch and Kobbelt 2003, section 4)."""

from __future__ import annotations

from ..plan.graph import Part
from ..plan.hosts import DRAWING_HOSTS, Host, Kind


def passes(planning):
    """No passes; records whether there are such splats, and how many."""
    if planning.shown and planning.settings.culls_backs:
        count = planning.facts["culled_of"] = sum(kind.count * len(kind.placed.surfels) for kind in planning.surfels)
        backs = planning.facts["culled"] = sum(i.backs(planning.camera) for i in planning.scene.surfels)
        planning.has("BACK_CULLING", f"{backs:,} of {count:,} splats show their backs, and are asked to be left out")
    return ()


def is_present(planning) -> bool:
    return planning.settings.culls_backs


def parts(planning, p):
    if p.host in DRAWING_HOSTS and p.kind in (Kind.OPAQUE, Kind.LAYER, Kind.REST):
        yield Part("back_culling", only="splats" if p.host == Host.VISIBILITY else "")
