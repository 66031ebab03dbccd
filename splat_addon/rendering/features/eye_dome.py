# SPDX-License-Identifier: GPL-3.0-or-later
"""Eye-dome lighting: a surface is the darker the more its surroundings rise towards the viewer (Boucheny 2009)."""

from __future__ import annotations

import math

from ..passes.textures import SAMPLE_DEPTHS
from ..plan.graph import Part
from ..plan.hosts import LIT_HOSTS, Kind
from ..plan.planning import any_of
from ..scene.eye_dome import steps_of


def missing(planning) -> str:
    """The reason why the frame has no eye-dome lighting, or ""."""
    if planning.settings.eye_dome is None:
        return "none is asked for"
    if planning.model.is_diagnostic:
        return f"{planning.model.name} shading shows how the picture is made"
    if not planning.scene.polygons and not any_of(lambda instance: not instance.is_transparent, planning.surfels):
        return "transparent layers have none, and nothing is opaque"
    return ""


def passes(planning):
    """None of its own: what it reads is a pass of `sample_depths`."""
    if planning.shown:
        if why := planning.find(missing):
            planning.skip("eye-dome lighting", why)
        else:
            planning.has("eye-dome lighting", "surfaces are darker where their surroundings rise towards the viewer")
    return ()


def is_present(planning) -> bool:
    return not planning.find(missing)


VALUES = {
    "eye_dome_gain": ("float", lambda tile: tile.settings.eye_dome.gain),
    "eye_dome_steps": ("vec2", lambda tile: steps_of(tile.settings.eye_dome.radius * tile.plan.samples)),
}


def margin(planning) -> int:
    """Pixels read beside a tile."""
    return math.ceil(planning.settings.eye_dome.radius) if is_present(planning) else 0


def parts(planning, p):
    if p.kind == Kind.OPAQUE and p.host in LIT_HOSTS:
        yield Part("eye_dome", reads=(SAMPLE_DEPTHS,))
