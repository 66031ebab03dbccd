# SPDX-License-Identifier: GPL-3.0-or-later
"""The range of visible depths of each sample, for methods that spread splats past the visible ellipses: in screen space
they compare depths themselves, and only visible polygons are drawn.
"""

from __future__ import annotations

from ..passes.decisions import have_rows, nearest_depth
from ..passes.textures import DEPTH_BOUNDS, VISIBILITY_DEPTH, rows_of
from ..plan.graph import Part, Pass, Texture, fill
from ..plan.hosts import BLENDED, Host, Kind


def bounds(planning, reason: str, seen: Texture, kind: Kind = Kind.OPAQUE) -> Pass:
    """The pass that stores the visible depths; and the depths of samples, if visibility has more rows than there are
    samples."""
    rows = rows_of(seen)
    own = Part(
        "depth_bounds",
        reads=(seen,),
        writes=(DEPTH_BOUNDS, *((VISIBILITY_DEPTH,) if rows > 1 else ())),
        called=((seen, "seen_depth"),),
        constants=(("ROWS", rows),),
        words=("writes_depth",) if rows > 1 else (),
    )
    state = dict.fromkeys(("depth_test", "depth_write", "fragment_depth"), rows > 1)
    return Pass("depth_bounds", reason, Host.DEPTH_BOUNDS, fill, (own,), kind, state)


def passes(planning):
    method = planning.method
    if not planning.shown or method.rasterizer == "point_sprite":
        return
    if not method.spreads:
        planning.skip(DEPTH_BOUNDS.name, f"{method.name} is tested by the hardware, with the depth of visibility")
        return
    compared = f"{method.name} computes its depths, which are compared in the shader"
    if method.rasterizer == "object_space":
        compared = f"polygons are seen where {method.name} spreads past what hides them"
    if planning.find(have_rows):
        compared += "; between samples, silhouettes are looked for alone"
    yield bounds(planning, compared, nearest_depth(planning))


def is_present(planning) -> bool:
    return planning.method.spreads


def parts(planning, p):
    if p.host == Host.SCREEN_SPACE and p.kind in BLENDED:
        yield Part("depth_bounds", reads=(DEPTH_BOUNDS,))
    if p.host in (Host.POLYGONS, Host.LINES):
        yield Part("depth_bounds", reads=(DEPTH_BOUNDS,))
