# SPDX-License-Identifier: GPL-3.0-or-later
"""Skips opaque splats from behind where the other side of their card hides them. Transparent cards show both sides."""

from __future__ import annotations

from ..plan.graph import Part
from ..plan.hosts import DRAWING_HOSTS, Host, Kind
from ..plan.planning import count, counted


def _count(planning) -> int:
    return count(lambda i: i.surfels.hidden_back is not None and not i.is_transparent, planning.surfels)


passes, is_present = counted(
    "HIDDEN_BACKS", _count, "{count} instances have cards with two sides", "backs of cards", "none"
)


def parts(planning, p):
    if p.host in DRAWING_HOSTS and p.kind == Kind.OPAQUE:
        yield Part("hidden_backs", only="splats" if p.host == Host.VISIBILITY else "")
