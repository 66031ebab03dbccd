# SPDX-License-Identifier: GPL-3.0-or-later
"""The visibility pass: depth, every splat moved back by its epsilon (Botsch et al. 2005, section 4.1)."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import replace

from ..passes.decisions import depth_format, nearest_depth, nearest_state
from ..passes.drawing import draw_polygons, draw_splats
from ..passes.rasterizers import storage_samplers
from ..passes.textures import rows_of
from ..plan.frame_plan import VISIBILITY_ROWS
from ..plan.graph import Part, Pass, Pause, Texture
from ..plan.hosts import BLENDED, Host, Kind
from ..view import Items
from . import hidden_objects

NAMES = ("visibility", "sprite_visibility", "square_visibility")
_OF_POLYGONS = Part("visibility", ("of_polygons",), inputs=("polygon_corners",), only="polygons")


def own_parts(planning, depth: Texture, has_polygons: bool = True) -> tuple[Part, ...]:
    """The parts of a pass that finds the nearest surface."""
    return (
        Part(
            "visibility",
            ("moved_back",),
            writes=(depth,),
            varyings=(("smooth", "vec3", "place_depth"),),
        ),
        Part("visibility", inputs=storage_samplers(planning), only="splats"),
        Part("visibility", varyings=(("smooth", "vec3", "across_offset"),), only="linear"),
        *((_OF_POLYGONS,) if has_polygons and planning.scene.polygons else ()),
    )


def drawn(name: str, reason: str, own: tuple[Part, ...], planning, kind: Kind = Kind.OPAQUE) -> Pass:
    """A pass that finds the nearest surface."""
    return Pass(name, reason, Host.VISIBILITY, run, own, kind, nearest_state(planning))


def passes(planning):
    if not planning.shown:
        return
    if planning.method.rasterizer == "point_sprite":
        planning.skip("visibility", f"of {planning.method.name} the nearest splat wins, and nothing blends")
        return
    why = f"splats may hide one another; {planning.find(depth_format).why}"
    seen = nearest_depth(planning)
    made = drawn("visibility", why, own_parts(planning, seen), planning)
    yield made.with_values(each=hidden_objects.search(planning, seen, rows_of(seen)))


def parts(planning, p):
    if p.host == Host.SCREEN_SPACE and p.kind in BLENDED:
        yield Part("visibility")
    if p.host == Host.VISIBILITY and p.kind in BLENDED and planning.method.hides_within:
        within = planning.method.hides_within
        varyings = (("flat", "vec3", "square"),) if within == "square" else ()
        yield Part(f"{within}_visibility", varyings=varyings, only="splats")


def run(tile, p: Pass):
    """Fill the depth texture and the other textures about the nearest surface."""
    target = tile.target(p)
    tile.clear(target, color=0.0 if p.colors else None, depth=1.0)
    by_rows = tile
    if rows_of(p.depth) > 1:
        # the first of a sample's rows goes through its centre
        by_rows = replace(tile, rise=-(VISIBILITY_ROWS - 1) / target.size[1])
    polygons = tile.view.polygons if p.kind != Kind.LAYER else None
    for splats in hidden_objects.front_to_back(tile, p, tile.drawn_by(p)):
        yield from draw(by_rows, p, target, splats, polygons)
        polygons = None
    return target


def run_in(tile, p: Pass, target, viewport: tuple[int, int, int, int]) -> Generator[Pause]:
    """Draw all that a view shows into a part of the depth texture."""
    polygons = tile.view.polygons
    for splats in hidden_objects.front_to_back(tile, p, tile.view.placed, viewport):
        yield from draw(tile, p, target, splats, polygons, viewport)
        polygons = None


def draw(tile, p: Pass, target, splats: Items, polygons: Items | None, viewport=None) -> Generator[Pause]:
    """Draw polygons and splats with the pass's programs: polygons first, because they hide much and cost little."""
    if polygons:
        yield from draw_polygons(tile, p, target, polygons, "polygon_visibility.vert", "polygons", viewport=viewport)
    yield from draw_splats(tile, p, target, splats, "visibility.vert", "splats", viewport=viewport)
