# SPDX-License-Identifier: GPL-3.0-or-later
"""Splats that are lit individually, so that lit colours are blended (Botsch and Kobbelt 2003, section 4).

Without this feature, samples are lit once (Botsch et al. 2005, section 4). Each instance's splats are lit before they
are summed, in one fragment per splat, with their own colours, even if they are texture-mapped. Polygons among them are
lit at samples, and colours blend (Guennebaud et al. 2006, section 5.1).
"""

from __future__ import annotations

from ..passes.decisions import lights_samples, splat_lighting
from ..passes.drawing import Programs, draw_block, draw_parts
from ..passes.rasterizers import storage_samplers
from ..plan.graph import Part, Pass, Texture
from ..plan.hosts import BLENDED, LIT_HOSTS, SPLAT_HOSTS, Host, Kind
from ..upload.packing import SPLATS_PER_ROW, row_count
from ..upload.parts import largest_part


def _of_splats(plan, pixels: tuple[int, int]) -> tuple[int, int]:
    return SPLATS_PER_ROW, plan.find(rows)


LIT = Texture("lit_splats", per=_of_splats)


def rows(planning) -> int:
    """Rows of the texture of lit splats, for those of the largest instance."""
    are_all = planning.find(splat_lighting).is_wanted
    lit = (kind.placed for kind in planning.surfels if are_all or kind.placed.is_transparent)
    return max((row_count(largest_part(len(instance.surfels))) for instance in lit), default=1)


def passes(planning):
    """No passes; records whether splats are lit."""
    is_wanted, why_not = planning.find(splat_lighting)
    if is_wanted:
        planning.has("LIT_SPLATS", "each splat is lit, and colours blend")
    elif why_not:
        planning.skip("lighting of splats", why_not)
    return ()


def each(planning) -> Pass | None:
    """The pass that lights the splats of an instance before they are summed."""
    return light(planning) if planning.find(splat_lighting).is_wanted else None


def light(planning) -> Pass:
    """Light the splats of one instance, or part of it; the texture has one texel per splat of the largest one."""
    planning.find(rows)
    own = Part("lit_splats", inputs=storage_samplers(planning), writes=(LIT,))
    return Pass("light_splats", "each splat is lit by itself", Host.LIT_SPLATS, run, (own,), Kind.REST)


def parts(planning, p):
    if not planning.find(splat_lighting).is_wanted or p.kind not in BLENDED:
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
