# SPDX-License-Identifier: GPL-3.0-or-later
"""The range of visible depths of each sample, for methods that spread splats past the visible ellipses: in screen space
they compare depths themselves, and only visible polygons are drawn.
"""

from __future__ import annotations

from ..plan.graph import Part, Pass, Texture, fill
from . import silhouettes, visibility

BOUNDS = Texture("depth_bounds")


def bounds(planning, reason: str, seen: Texture, kind: str = "opaque") -> Pass:
    """The pass that stores the visible depths; and the depths of samples, if visibility has more rows than there are
    samples."""
    rows = silhouettes.rows_of(seen)
    own = Part(
        "depth_bounds",
        reads=(seen,),
        writes=(BOUNDS, *((visibility.DEPTH,) if rows > 1 else ())),
        called=((seen, "seen_depth"),),
        constants=(("ROWS", rows),),
        words=("writes_depth",) if rows > 1 else (),
    )
    state = dict.fromkeys(("depth_test", "depth_write", "fragment_depth"), rows > 1)
    return Pass("depth_bounds", reason, "depth_bounds.frag", fill, (own,), kind, state)


def passes(planning):
    method = planning.method
    if not planning.shown or method.rasterizer == "point_sprite":
        return
    if not method.spreads:
        planning.skip(BOUNDS.name, f"{method.name} is tested by the hardware, with the depth of visibility")
        return
    compared = f"{method.name} computes its depths, which are compared in the shader"
    if method.rasterizer == "object_space":
        compared = f"polygons are seen where {method.name} spreads past what hides them"
    if planning.find(silhouettes.have_rows):
        compared += "; between samples, silhouettes are looked for alone"
    yield bounds(planning, compared, visibility.nearest_depth(planning))


def is_present(planning) -> bool:
    return planning.method.spreads


def parts(planning, p):
    if p.host == "screen_space.frag" and p.kind in ("opaque", "layer"):
        yield Part("depth_bounds", reads=(BOUNDS,))
    if p.host in ("polygons.frag", "lines.frag"):
        yield Part("depth_bounds", reads=(BOUNDS,))
