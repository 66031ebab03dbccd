# SPDX-License-Identifier: GPL-3.0-or-later
"""Splats that end at lines before their ellipse does, where their surface has a crease or a border.

They are a separate draw call, with the variant "clipped" of every program that draws splats; other splats cost no more.
"""

from __future__ import annotations

from ...large_surfels import SAMPLE_SIZE
from ..passes.decisions import have_clip_lines
from ..passes.drawing import pooled
from ..plan.graph import Part
from ..plan.hosts import BLENDED, DRAWING_HOSTS, Host
from ..plan.planning import counted

CONSTANTS = {"SAMPLE_SIZE": SAMPLE_SIZE}

_VARYINGS = (("flat", "vec3", "clip_first"), ("flat", "vec3", "clip_second"), ("flat", "float", "clip_is_reflex"))

#: word -> what else vertices hand on: whether lines refer to positions in the ellipse or in the picture; where a method
#: blurs lines, distances from them in the picture and the strip between both.
_MORE_VARYINGS = {
    "cuts_at_lines": (("flat", "float", "clip_in_space"),),
    "blurs_lines": (("flat", "vec3", "from_first"), ("flat", "vec3", "from_second"), ("flat", "vec3", "clip_strip")),
}


def _drawn(tile, placed):
    surfels, levels = placed.instance.surfels, tile.levels(placed.instance)
    return pooled(tile, placed, "clip_lines") or tile.resources.clip_lines(surfels, levels, placed.part)


DRAWN = {"clip_lines": _drawn}
ARRIVES = {"clip_lines": lambda instance: instance.surfels.clipped_count > 0}


passes, is_present = counted(
    "CLIP_LINES",
    have_clip_lines,
    "splats of {count} instances end at creases and borders, drawn by themselves",
    "clip lines",
    "all splats are whole",
)


def parts(planning, p):
    if p.host in DRAWING_HOSTS:
        words = _words(planning, p)
        varyings = (*_VARYINGS, *(v for word in words for v in _MORE_VARYINGS.get(word, ())))
        yield Part("clip_lines", words, inputs=("clip_lines",), varyings=varyings, only="clipped")


def _words(planning, p) -> tuple[str, ...]:
    """How lines act: on positions in the ellipse or in the picture, and blurred if the method blurs rims."""
    if p.host == Host.POINT_SPRITE:
        return ("of_sprites",)
    if p.host == Host.VISIBILITY:
        is_of_sprites = planning.method.hides_within == "sprite" and p.kind in BLENDED
        return ("of_sprites",) if is_of_sprites else ("of_ellipses",)
    if p.host == Host.SCREEN_SPACE:
        return ("blurs_lines",) if planning.method.blurs_rims else ("cuts_at_lines",)
    return ()
