# SPDX-License-Identifier: GPL-3.0-or-later
"""Splats that are lit individually, so that lit colours are blended (Botsch and Kobbelt 2003, section 4).

Without this feature, samples are lit once (Botsch et al. 2005, section 4). Each instance's splats are lit before they
are summed, in one fragment per splat, with their own colours, even if they are texture-mapped. Polygons among them are
lit at samples, and colours blend (Guennebaud et al. 2006, section 5.1).
"""

from __future__ import annotations

from ..plan.graph import Part, Pass, Texture
from ..plan.hosts import BLENDED, LIT_HOSTS, SPLAT_HOSTS, Host, Kind
from ..scene import Instance
from ..shading_models import ShadingModel, get_shading_model
from ..upload.packing import SPLATS_PER_ROW, row_count
from ..upload.parts import largest_part
from .drawing import Programs, draw_block, draw_parts, storage_samplers


def _of_splats(plan, pixels: tuple[int, int]) -> tuple[int, int]:
    return SPLATS_PER_ROW, plan.facts["lit_rows"]


LIT = Texture("lit_splats", per=_of_splats)


def wanted(planning) -> bool:
    """Whether splats are lit."""
    if not planning.settings.lights_splats or not planning.shown:
        return False
    if get_shading_model(planning.settings.shading).is_diagnostic:
        planning.skip("lighting of splats", f"{planning.settings.shading} shows how splats add up")
        return False
    if not any(isinstance(placed, Instance) for placed in planning.shown):
        planning.skip("lighting of splats", "the scene has none")
        return False
    planning.has("LIT_SPLATS", "each splat is lit, and colours blend")
    return True


def lights_samples(planning, kind: Kind) -> bool:
    """Whether passes of this kind light samples: without this feature, and where polygons are among the splats."""
    return not planning.find(wanted) or (kind == Kind.OPAQUE and bool(planning.scene.polygons))


def model_in(planning, p: Pass) -> ShadingModel:
    """The shading model of a pass: samples show blended colours unchanged."""
    asked_for = get_shading_model(planning.settings.shading)
    of_samples = p.kind in BLENDED and p.host in LIT_HOSTS | SPLAT_HOSTS
    return get_shading_model("flat") if of_samples and not lights_samples(planning, p.kind) else asked_for


def each(planning) -> Pass | None:
    """The pass that lights the splats of an instance before they are summed."""
    return light(planning, planning.surfels) if planning.find(wanted) else None


def light(planning, kinds) -> Pass:
    """Light the splats of one instance, or part of it; the texture has one texel per splat of the largest one."""
    rows = max((row_count(largest_part(len(kind.placed.surfels))) for kind in kinds), default=1)
    planning.facts["lit_rows"] = max(rows, planning.facts.get("lit_rows", 0))
    own = Part("lit_splats", inputs=storage_samplers(planning.settings.storage), writes=(LIT,))
    return Pass("light_splats", "each splat is lit by itself", Host.LIT_SPLATS, run, (own,), Kind.REST)


def parts(planning, p):
    if not planning.find(wanted) or p.kind not in BLENDED:
        return
    if p.host in SPLAT_HOSTS:
        yield Part("lit_splats", reads=(LIT,))
    if p.host in LIT_HOSTS and lights_samples(planning, p.kind):
        yield Part("lit_splats", choices=(("polygon_blend", "colors"),))
    elif p.host in LIT_HOSTS:
        yield Part("lit_splats", choices=(("shading", "flat"),))


def run(tile, p: Pass):
    """Fill the sums, one instance or part of one after another; its splats are lit first, one fragment each, at the
    texel of its place among those that are drawn."""
    target, lit = tile.target(p), tile.target(p.each)
    lights, programs = Programs(tile, p.each, "fullscreen.vert"), Programs(tile, p, p.host.vertex)
    tile.clear(target, color=0.0, depth=1.0 if p.state["depth_write"] else None)
    for placed, cut in (part for each in tile.drawn_by(p) for part in tile.in_parts(each)):
        light = yield from lights.of(*(() if cut.numbers is None else ("cut",)))
        textures = tile.textures(p.each, light, placed)
        blocks = tile.blocks(light, placed, draw_block(tile, placed))
        viewport = 0, 0, SPLATS_PER_ROW, row_count(cut.count)
        tile.draw_triangles(light, lit, 1, blocks, textures, viewport)
        yield from draw_parts(tile, p, target, [(placed, cut)], programs)
    return target
