# SPDX-License-Identifier: GPL-3.0-or-later
"""The last transparent layer: all that is left, without an order, each splat lit by itself (Guennebaud et al. 2006)."""

from __future__ import annotations

from ..plan.graph import Part, Pass, Texture, fill
from ..upload.packing import SPLATS_PER_ROW, row_count
from . import gbuffer, lighting
from .drawing import RASTERIZERS, draw_block, draw_splats, drawn_by, splat_textures, storage_samplers
from .rasterizers import rasterized


def _of_splats(plan, pixels: tuple[int, int]) -> tuple[int, int]:
    return SPLATS_PER_ROW, plan.facts["lit_rows"]


LIT = Texture("lit_splats", per=_of_splats)
ACCUM = Texture("oit_accum")
WEIGHT = Texture("oit_weight", "RG32F")


def lit_rows(scene) -> int:
    """Of a texture of one texel a splat, for the largest of the transparent instances."""
    return max(row_count(i.surfels) for i in scene.surfels if i.is_transparent)


def passes_of_rest(planning, peeled: Texture, layers: Texture) -> tuple[Pass, ...]:
    """What is done where no layer was empty: with what layers add up to, and how far they are peeled."""
    planning.facts["lit_rows"] = lit_rows(planning.scene)
    samples = (("SAMPLES", planning.settings.supersampling),)
    add = {"blend": "add"}
    light = Part("oit", inputs=storage_samplers(planning.settings.storage), writes=(LIT,))
    rest = Part("oit", ("rest",), (LIT,), writes=(ACCUM, WEIGHT)), *rasterized(planning)
    state = gbuffer.state(planning) | {"depth_test": False}
    host = f"{RASTERIZERS[planning.method.works_in]}.frag"
    shade = Part("oit", reads=(ACCUM, WEIGHT, gbuffer.depth_sum(planning)), writes=(lighting.SHADED,))
    put = Part("oit", reads=(lighting.SHADED, peeled), writes=(layers,), constants=samples)
    peel = Part("oit", reads=(lighting.SHADED,), updates=(peeled,))
    each = Pass("light_splats", "each splat is lit by itself", "lit_splats.frag", run, (light,), "rest")
    return (
        Pass("rest", "all that is left is added up", host, run, rest, "rest", state, each=each),
        Pass("oit_shading", "its weights tell how much it hides", "oit_shading.frag", fill, (shade,), "rest"),
        Pass("oit_layer", "nearer layers cover it", "oit_layer.frag", fill, (put,), "rest", add, adds=True),
        Pass("peel_oit", "it covers what is opaque", "peel_oit.frag", fill, (peel,), "rest"),
    )


def run(tile, p: Pass):
    """Fill the sums, one instance after the other, whose splats are lit first: one fragment each, at the texel of its
    number.
    """
    target, lit, light = tile.target(p), tile.target(p.each), None
    target.clear(color=0.0)
    for placed in drawn_by(p, tile):
        light = light or tile.program(p.each)
        textures = tile.textures(p.each, light, splat_textures(tile, placed.instance))
        blocks = tile.blocks(light, draw_block(tile, placed, tile.settings.epsilon))
        viewport = 0, 0, SPLATS_PER_ROW, row_count(placed.instance.surfels)
        tile.resources.device.draw_triangles(light, lit, 1, blocks, textures, viewport)
        draw_splats(tile, p, target, [placed], p.host.replace(".frag", ".vert"))
    return target
