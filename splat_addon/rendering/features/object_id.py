# SPDX-License-Identifier: GPL-3.0-or-later
"""Object numbers of samples, which passes that find the nearest surface write beside its depth."""

from __future__ import annotations

from ..passes.decisions import asked_numbers, have_rows, numbered, polygons_are_apart
from ..passes.drawing import draw_splats
from ..passes.rasterizers import rasterized
from ..passes.textures import IDENTITY, POLYGON_IDENTITY, ROW_IDENTITY, VISIBILITY_DEPTH
from ..plan.graph import Part, Pass, Texture
from ..plan.hosts import BLENDED, RASTERIZED, Host, Kind

LAYER_IDENTITY = Texture("layer_identity", "RG32F")
EDGE_DEPTH = Texture("edge_depth", "DEPTH32F")
_VARYINGS = (("flat", "float", "number"),)


def read_back(planning) -> tuple[Texture, ...]:
    """The textures that are read back for a frame."""
    return planning.find(numbered).textures


def passes(planning):
    """The pass that finds numbers for samples that only see what a filter spreads; not needed if silhouettes are
    filtered."""
    if not planning.shown:
        return
    names, method = asked_numbers(planning), planning.method
    if not names:
        planning.skip("identity", "no index or matte tells objects or materials apart")
        return
    if planning.settings.multisampling:
        raise ValueError(
            f"Hardware samples are not told apart by object: leave {', '.join(names)} out of the outputs, or set "
            "multisampling to 0 and use supersampling."
        )
    if method.spreads and not method.filters_silhouettes:
        why = f"{method.name} spreads splats past what is visible, which is somebody's"
        in_space = method.rasterizer == "object_space"
        words = ("edge_ids", "in_space") if in_space else ("edge_ids",)
        own = Part("object_id", words, (VISIBILITY_DEPTH,), writes=(IDENTITY, EDGE_DEPTH), varyings=_VARYINGS)
        state = {"depth_test": True, "depth_write": True, "fragment_depth": in_space}
        host, parts = RASTERIZED[method.rasterizer], (own, *rasterized(planning))
        yield Pass("edge_ids", why, host, run_edges, parts, Kind.EDGE_IDS, state, adds=True)


def is_present(planning) -> bool:
    return bool(asked_numbers(planning))


def parts(planning, p):
    if p.host == Host.VISIBILITY and p.kind in BLENDED:
        texture = LAYER_IDENTITY if p.kind == Kind.LAYER else IDENTITY
        if p.kind == Kind.OPAQUE and planning.find(have_rows):
            texture = ROW_IDENTITY
        reason = f"{', '.join(asked_numbers(planning))} tell whose it is" if p.kind == Kind.OPAQUE else ""
        called = ((texture, "identity"),)
        yield Part("object_id", writes=(texture,), called=called, varyings=_VARYINGS, reason=reason)
    if p.host == Host.POINT_SPRITE:
        yield Part("object_id", writes=(IDENTITY,), varyings=_VARYINGS)
    if p.host == Host.POLYGONS and polygons_are_apart(planning):
        yield Part("object_id", writes=(POLYGON_IDENTITY,), varyings=_VARYINGS)
    if p.host == Host.PEEL:
        yield Part("object_id", reads=(LAYER_IDENTITY,), updates=(IDENTITY,))


def run_edges(tile, p: Pass):
    """Fill gaps that the visibility pass left in the numbers with the nearest splat footprint."""
    target = tile.target(p)
    tile.clear(target, depth=1.0)
    yield from draw_splats(tile, p, target, tile.drawn_by(p), p.host.vertex)
    return target
