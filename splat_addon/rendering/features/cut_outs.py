# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons with holes where their texture is transparent, such as cards of leaves (Wyman & McGuire 2017).

Passes keep each sample with the probability that its alpha is, by thresholds of each triangle, so the mean of samples
is what blending gives, without layers, also of many behind one another.
"""

from __future__ import annotations

import math

from ..passes.textures import rows_of
from ..plan.graph import Part
from ..plan.hosts import Host, Kind
from ..plan.planning import count, counted
from .textures import ATLAS, OF_TRIANGLES

_SURFACE = (("flat", "float", "cut_surface"),)
_VARYINGS = (("smooth", "vec3", "cut_place"), ("smooth", "vec3", "cut_eye"), *OF_TRIANGLES, *_SURFACE)

#: Where numbers of samples in the picture are taken from 0 again.
_PERIOD = 1 << 16


def _corner(tile) -> tuple[int, int]:
    """The number, in the picture that all its tiles and samples are of, of a tile's first sample."""
    left, bottom, across, up = tile.window
    return tuple(math.floor(start / step + 0.5) % _PERIOD for start, step in ((left, across), (bottom, up)))


def _turned(tile) -> int:
    """The last 16 bits of the sample's number, from last to first."""
    return int(f"{tile.camera.sample % _PERIOD:016b}"[::-1], 2)


SAMPLE_VALUES = {"cut_corner": ("vec2", _corner), "cut_turned": ("float", _turned)}


def _count(planning) -> int:
    return count(lambda instance: instance.is_cut_out, planning.polygons)


passes, is_present = counted(
    "CUT_OUTS",
    _count,
    "textures cut holes into {count} instances of polygons",
    "cut-outs",
    "no texture cuts holes into polygons",
)


def parts(planning, p):
    if p.host == Host.VISIBILITY and p.kind != Kind.LAYER:
        words = () if p.kind == Kind.SHADOW else ("in_view",)
        rows = (("ROWS", rows_of(p.depth)),)
        inputs = "polygon_uvs", *ATLAS
        yield Part("cut_outs", words, inputs=inputs, varyings=_VARYINGS, constants=rows, only="cut_out")
    if p.host == Host.POLYGONS:
        yield Part("cut_outs", varyings=_SURFACE, only="cut_out")
