# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines: the share of each sample that lies on a silhouette or a crease, found before shading."""

from __future__ import annotations

import math

from ..plan.graph import Part, Pass, Texture, fill
from ..plan.hosts import LIT_HOSTS, Host, Kind
from ..scene.lines import CREASE_REACH

CONSTANTS = {"CREASE_REACH": CREASE_REACH}
VALUES = {
    "line_width": ("float", lambda tile: tile.settings.lines.width * tile.plan.samples),
    "line_crease": ("float", lambda tile: math.cos(tile.settings.lines.crease_angle)),
    "line_drop": ("float", lambda tile: tile.settings.lines.depth_threshold),
    "line_shallow": ("float", lambda tile: math.sin(tile.settings.lines.shallow_angle)),
    "line_color": ("vec4", lambda tile: (*tile.settings.lines.color, 0.0)),
}
COVERED = Texture("lines", "R32F")


def passes(planning):
    if not planning.shown:
        return
    settings = planning.settings
    if settings.lines is None:
        planning.skip("lines", "none are asked for")
        return
    own = Part(
        "lines",
        ("shallow_lines",) if settings.lines.shallow_angle else (),
        writes=(COVERED,),
        constants=(("SAMPLES", settings.supersampling), ("MEAN_OF", settings.multisampling)),
        choices=(("samples", "mean" if settings.multisampling else "each"),),
    )
    why = "silhouettes and creases are drawn before their samples are mixed"
    yield Pass("lines", why, Host.LINES, fill, (own,))


def is_present(planning) -> bool:
    return planning.settings.lines is not None


def parts(planning, p):
    if p.host in LIT_HOSTS and p.kind == Kind.OPAQUE:
        yield Part("lines", reads=(COVERED,))


def margin(planning) -> int:
    """Pixels that lines read beside their own."""
    return math.ceil(planning.settings.lines.reach) if planning.settings.lines else 0
