# SPDX-License-Identifier: GPL-3.0-or-later
"""Lines: the share of each sample that lies on a silhouette or a crease, found before shading."""

from __future__ import annotations

import math

from ..passes.sums import drawn_lines, styles
from ..plan.graph import Part, Pass, Texture, fill
from ..plan.hosts import LIT_HOSTS, Host, Kind
from ..scene.lines import CREASE_REACH

CONSTANTS = {"CREASE_REACH": CREASE_REACH}
VALUES = {
    "line_width": ("float", lambda tile: tile.plan.find(drawn_lines).width * tile.plan.samples),
    "line_crease": ("float", lambda tile: math.cos(tile.plan.find(drawn_lines).crease_angle)),
    "line_drop": ("float", lambda tile: tile.plan.find(drawn_lines).depth_threshold),
    "line_shallow": ("float", lambda tile: math.sin(tile.plan.find(drawn_lines).shallow_angle)),
    "line_color": ("vec4", lambda tile: (*tile.plan.find(drawn_lines).color, 0.0)),
}
COVERED = Texture("lines", "R32F")


def passes(planning):
    if not planning.shown:
        return
    settings, lines = planning.settings, planning.find(drawn_lines)
    if lines is None:
        planning.skip("lines", "none are asked for")
        return
    own = Part(
        "lines",
        ("shallow_lines",) if lines.shallow_angle else (),
        writes=(COVERED,),
        constants=(("SAMPLES", settings.supersampling), ("MEAN_OF", settings.multisampling)),
        choices=(("samples", "mean" if settings.multisampling else "each"),),
    )
    why = "silhouettes and creases are drawn before their samples are mixed"
    yield Pass("lines", why, Host.LINES, fill, (own,))


def is_present(planning) -> bool:
    return planning.find(drawn_lines) is not None


def parts(planning, p):
    if p.host in LIT_HOSTS and p.kind == Kind.OPAQUE:
        yield Part("lines", () if planning.find(styles) else ("one_color",), reads=(COVERED,))


def margin(planning) -> int:
    """Pixels that lines read beside their own."""
    lines = planning.find(drawn_lines)
    return math.ceil(lines.reach) if lines else 0
