# SPDX-License-Identifier: GPL-3.0-or-later
"""Skips splats that face away, in the vertex stage (Botsch and Kobbelt 2003, section 4)."""

from __future__ import annotations

from typing import NamedTuple

from ..plan.graph import Part
from ..plan.hosts import DRAWING_HOSTS, Host, Kind


class Backs(NamedTuple):
    """The number of splats that show their backs, and of all that may."""

    count: int
    among: int


def backs(planning) -> Backs:
    """The splats that are asked to be left out."""
    if not planning.settings.culls_backs:
        return Backs(0, 0)
    among = sum(kind.count * len(kind.placed.surfels) for kind in planning.surfels)
    return Backs(sum(instance.backs(planning.camera) for instance in planning.scene.surfels), among)


def passes(planning):
    """No passes; records whether there are such splats, and how many."""
    count, among = planning.find(backs)
    if planning.shown and planning.settings.culls_backs:
        planning.has("BACK_CULLING", f"{count:,} of {among:,} splats show their backs, and are asked to be left out")
    return ()


def is_present(planning) -> bool:
    return planning.settings.culls_backs


def parts(planning, p):
    if p.host in DRAWING_HOSTS and p.kind in (Kind.OPAQUE, Kind.LAYER, Kind.REST):
        yield Part("back_culling", only="splats" if p.host == Host.VISIBILITY else "")
