# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons with holes where their texture is transparent, such as cards of leaves (Wyman & McGuire 2017).

Passes keep each sample with the probability that its alpha is, so the mean of samples is what blending gives, without
layers.
"""

from __future__ import annotations

from ..passes.textures import rows_of
from ..plan.graph import Part
from ..plan.hosts import Host, Kind
from ..plan.planning import count, counted
from .textures import ATLAS, OF_TRIANGLES

_VARYINGS = (("smooth", "vec3", "cut_place"), ("smooth", "vec3", "cut_eye"), *OF_TRIANGLES)


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
        yield Part("cut_outs", only="cut_out")
