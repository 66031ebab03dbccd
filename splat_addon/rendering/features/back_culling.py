# SPDX-License-Identifier: GPL-3.0-or-later
"""Skips splats that face away, in the vertex stage (Botsch and Kobbelt 2003, section 4)."""

from __future__ import annotations

from ..plan.graph import Part
from .drawing import SPLAT_HOSTS


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
    hosts = (*SPLAT_HOSTS, "visibility.frag")
    if p.host in hosts and p.kind in ("opaque", "layer", "rest"):
        yield Part("back_culling", only="splats" if p.host == "visibility.frag" else "")
