# SPDX-License-Identifier: GPL-3.0-or-later
"""Limits the blend depth of splats to the distance of their own surface from their plane: visibility moves them by
less."""

from __future__ import annotations

from ...large_surfels import LARGE_WEIGHT, STEPS_OF_SAMPLES
from ..plan.graph import Part
from ..plan.hosts import DRAWING_HOSTS, Host, Kind
from ..plan.planning import count, counted

CONSTANTS = {"STEPS_OF_SAMPLES": STEPS_OF_SAMPLES, "LARGE_WEIGHT": LARGE_WEIGHT}


def _count(planning) -> int:
    return count(lambda instance: instance.surfels.blend_depth is not None, planning.surfels)


passes, is_present = counted(
    "BLEND_DEPTH",
    _count,
    "splats of {count} instances blend as deep as their surface asks for",
    "blend depths",
    "all splats blend as deep as epsilon says",
)


def parts(planning, p):
    # A rim belongs to its object, however deep its splats blend.
    if p.host in DRAWING_HOSTS and p.kind != Kind.EDGE_IDS:
        # A shadow map is compared with points that the camera sees; if casters moved by less, surfaces would shadow
        # themselves.
        # As printed, all splats blend alike, and large ones weigh as much as others.
        words = (
            ("limits",) if p.kind == Kind.SHADOW else () if planning.settings.as_printed else ("limits", "moves_less")
        )
        yield Part("blend_depth", words, only="splats" if p.host == Host.VISIBILITY else "")
