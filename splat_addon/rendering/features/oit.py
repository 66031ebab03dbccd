# SPDX-License-Identifier: GPL-3.0-or-later
"""The last transparent layer: everything left, without sorting, with each splat lit by itself (Guennebaud et al.
2006)."""

from __future__ import annotations

from ..passes.rasterizers import rasterized
from ..passes.sums import depth_sum
from ..passes.textures import SHADED
from ..plan.graph import Part, Pass, Texture, fill, fill_all
from ..plan.hosts import RASTERIZED, Host, Kind
from . import gbuffer, lit_splats

ACCUM = Texture("oit_accum")
WEIGHT = Texture("oit_weight", "RG32F")


def passes_of_rest(planning, peeled: Texture, layers: Texture) -> tuple[Pass, ...]:
    """The passes to run if no layer was empty: from the sum of the layers, and how far they are peeled."""
    samples = (("SAMPLES", planning.settings.supersampling),)
    add = {"blend": "add"}
    rest = Part("oit", ("rest",), (lit_splats.LIT,), writes=(ACCUM, WEIGHT)), *rasterized(planning)
    state = gbuffer.state(planning) | {"depth_test": False}
    host = RASTERIZED[planning.method.rasterizer]
    shade = Part("oit", reads=(ACCUM, WEIGHT, depth_sum(planning)), writes=(SHADED,))
    put = Part("oit", reads=(SHADED, peeled), writes=(layers,), constants=samples)
    peel = Part("oit", reads=(SHADED,), updates=(peeled,))
    run, each = lit_splats.run, lit_splats.light(planning)
    return (
        Pass("rest", "all that is left is added up", host, run, rest, Kind.REST, state, each=each),
        Pass("oit_shading", "its weights tell how much it hides", Host.OIT_SHADING, fill, (shade,), Kind.REST),
        Pass("oit_layer", "nearer layers cover it", Host.OIT_LAYER, fill, (put,), Kind.REST, add, adds=True),
        Pass("peel_oit", "it covers what is opaque", Host.PEEL_OIT, fill_all, (peel,), Kind.REST),
    )
