# SPDX-License-Identifier: GPL-3.0-or-later
"""Object numbers of samples, which passes that find the nearest surface write beside its depth."""

from __future__ import annotations

from ..identity import NUMBERED
from ..plan.graph import Part, Pass, Texture
from ..plan.hosts import BLENDED, RASTERIZED, Host, Kind
from . import silhouettes, visibility
from .drawing import draw_splats
from .rasterizers import rasterized

IDENTITY = Texture("identity", "RG32F")
ROW_IDENTITY = Texture("row_identity", "RG32F", silhouettes.of_rows)
LAYER_IDENTITY = Texture("layer_identity", "RG32F")
POLYGON_IDENTITY = Texture("polygon_identity", "RG32F")
EDGE_DEPTH = Texture("edge_depth", "DEPTH32F")
_VARYINGS = (("flat", "float", "number"),)


def asked_for(planning) -> tuple[str, ...]:
    """The requested outputs that need numbers."""
    return tuple(name for name in NUMBERED if name in planning.settings.outputs)


def read_back(planning) -> tuple[Texture, ...]:
    """The textures to read back: numbers of samples, and of polygons if they are separate."""
    if not asked_for(planning) or not planning.shown:
        return ()
    first = ROW_IDENTITY if planning.find(silhouettes.have_rows) else IDENTITY
    return (first, POLYGON_IDENTITY) if _polygons_apart(planning) else (first,)


def _polygons_apart(planning) -> bool:
    return bool(planning.scene.polygons) and planning.method.rasterizer == "point_sprite"


def passes(planning):
    """The pass that finds numbers for samples that only see what a filter spreads; not needed if silhouettes are
    filtered."""
    if not planning.shown:
        return
    names, method = asked_for(planning), planning.method
    planning.facts["identity"] = read = read_back(planning)
    planning.facts["identity_rows"] = silhouettes.rows_of(read[0]) if read else 1
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
        own = Part("object_id", words, (visibility.DEPTH,), writes=(IDENTITY, EDGE_DEPTH), varyings=_VARYINGS)
        state = {"depth_test": True, "depth_write": True, "fragment_depth": in_space}
        host, parts = RASTERIZED[method.rasterizer], (own, *rasterized(planning))
        yield Pass("edge_ids", why, host, run_edges, parts, Kind.EDGE_IDS, state, adds=True)


def is_present(planning) -> bool:
    return bool(asked_for(planning))


def parts(planning, p):
    if p.host == Host.VISIBILITY and p.kind in BLENDED:
        texture = LAYER_IDENTITY if p.kind == Kind.LAYER else IDENTITY
        if p.kind == Kind.OPAQUE and planning.find(silhouettes.have_rows):
            texture = ROW_IDENTITY
        reason = f"{', '.join(asked_for(planning))} tell whose it is" if p.kind == Kind.OPAQUE else ""
        called = ((texture, "identity"),)
        yield Part("object_id", writes=(texture,), called=called, varyings=_VARYINGS, reason=reason)
    if p.host == Host.POINT_SPRITE:
        yield Part("object_id", writes=(IDENTITY,), varyings=_VARYINGS)
    if p.host == Host.POLYGONS and _polygons_apart(planning):
        yield Part("object_id", writes=(POLYGON_IDENTITY,), varyings=_VARYINGS)
    if p.host == Host.PEEL:
        yield Part("object_id", reads=(LAYER_IDENTITY,), updates=(IDENTITY,))


def run_edges(tile, p: Pass):
    """Fill gaps that the visibility pass left in the numbers with the nearest splat footprint."""
    target = tile.target(p)
    tile.clear(target, depth=1.0)
    yield from draw_splats(tile, p, target, tile.drawn_by(p), p.host.vertex)
    return target
