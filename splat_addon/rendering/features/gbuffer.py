# SPDX-License-Identifier: GPL-3.0-or-later
"""The attribute pass: visible splats add their weighted attributes to the sums (Botsch et al. 2005, section 4)."""

from __future__ import annotations

from ..passes.decisions import depth_format
from ..passes.drawing import draw_splats
from ..passes.rasterizers import rasterized
from ..passes.sums import depth_parts
from ..passes.textures import COLOR_SUM, DEPTH_SUM, NORMAL_SUM, VISIBILITY_DEPTH
from ..plan.graph import Part, Pass, Texture
from ..plan.hosts import LIT_HOSTS, RASTERIZED, Host, Kind
from ..plan.planning import count
from . import lit_splats

NAMES = ("gbuffer", "depth_in_normals", "gbuffer_depth")
VALUES = {
    "color_scale": ("float", lambda tile: tile.shared.color_scale),
    "color_unit": ("float", lambda tile: 1 / tile.shared.color_scale),
}

SPRITE_DEPTH = Texture("sprite_depth", "DEPTH32F")


def state(planning) -> dict:
    """State of programs that sum splats."""
    rasterizer, is_linear = planning.method.rasterizer, planning.find(depth_format).is_linear
    settings, in_space = planning.settings, rasterizer == "object_space"
    return {
        "blend": "none" if rasterizer == "point_sprite" else "add",
        "depth_test": rasterizer != "screen_space" or not is_linear,
        "depth_write": rasterizer == "point_sprite",
        "fragment_depth": in_space and is_linear,
        "sample_shading": bool(in_space and settings.multisampling and settings.sample_shading),
    }


def attributes(planning, reason: str, tests: Texture | None, kind: Kind = Kind.OPAQUE) -> Pass:
    """The attribute pass, with a depth for the hardware's test."""
    own = Part("gbuffer", writes=(COLOR_SUM,), tests=(tests,) if tests else ())
    own_parts = own, *rasterized(planning), depth_parts(planning, kind, writes=(NORMAL_SUM,))
    if planning.method.rasterizer == "point_sprite":
        own_parts += (Part("gbuffer", writes=(SPRITE_DEPTH,)),)
    host, lit = RASTERIZED[planning.method.rasterizer], lit_splats.each(planning)
    return Pass("attributes", reason, host, lit_splats.run if lit else run, own_parts, kind, state(planning), each=lit)


def passes(planning):
    if not planning.shown:
        return
    if planning.settings.sum_format != "float16":
        planning.skip(DEPTH_SUM.name, "float32 sums of normals have room for depths")
    if planning.method.rasterizer == "point_sprite":
        yield attributes(planning, "the nearest splat wins", None)
    else:
        yield attributes(planning, _why(planning), VISIBILITY_DEPTH)


def parts(planning, p):
    if p.host in (*LIT_HOSTS, Host.LINES):
        yield depth_parts(planning, p.kind, reads=(COLOR_SUM, NORMAL_SUM))


def _why(planning) -> str:
    if not planning.surfels:
        return "there are no splats: their sums stay empty"
    textured = count(lambda instance: instance.is_textured, planning.surfels)
    every = count(lambda instance: True, planning.surfels)
    looked_up = f"; {textured} of {every} instances look textures up" if textured else ""
    return f"overlapping splats blend by {planning.method.name}{looked_up}"


def run(tile, p: Pass):
    """Fill the sums; textured instances use programs that look up colours."""
    target, vertex = tile.target(p), p.host.vertex
    tile.clear(target, color=0.0, depth=1.0 if p.state["depth_write"] else None)
    drawn = tile.drawn_by(p)
    yield from draw_splats(tile, p, target, drawn.of_kinds(lambda i: not i.is_textured), vertex)
    yield from draw_splats(tile, p, target, drawn.of_kinds(lambda i: i.is_textured), vertex, "textured")
    return target
