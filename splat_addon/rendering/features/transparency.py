# SPDX-License-Identifier: GPL-3.0-or-later
"""Transparent layers, peeled from the nearest to the farthest (Guennebaud et al. 2006, section 6).

Opaque surfels are drawn first, and hide what lies behind them. Then each layer, nearest first, is drawn like an opaque
picture, with visibility, attributes and shading, but without the splats of nearer layers. A layer contains what is no
deeper than its nearest splat moved back by epsilon, so at each sample every splat is in exactly one layer, and
overlapping splats of a surface are in the same one.

The last layer may contain everything left: splats are lit individually and their colours mixed by opacity, and their
weights, relative to those of a single surface, give the number of surfaces (`oit`).

Layers are composited at the resolution of visibility: each adds to the pixel what the nearer ones let through at each
of its samples, and so does the opaque picture behind them.
"""

from __future__ import annotations

from ..passes.decisions import layers
from ..passes.textures import LAYERS, LAYERS_NORMAL, SHADED, VISIBILITY_DEPTH
from ..plan.graph import Loop, Part, Pass, Texture, fill_all, of_pixels
from ..plan.hosts import SPLAT_HOSTS, Host, Kind
from . import depth_bounds, gbuffer, lighting, oit, outputs, visibility

#: Samples that are read on each side of a layer's.
LAYER_MARGIN = 1
#: Blocks along each side of a picture; `OCCUPANCY` stores one value for each.
OCCUPANCY_BLOCKS = 64
CONSTANTS = {"OCCUPANCY_BLOCKS": OCCUPANCY_BLOCKS}
VALUES = {"alpha_threshold": ("float", lambda tile: tile.settings.alpha_threshold)}

DEPTH = Texture("layer_depth", "DEPTH32F")
OCCUPANCY = Texture("layer_occupancy", "R32F", lambda plan, pixels: (OCCUPANCY_BLOCKS, OCCUPANCY_BLOCKS))
PEELED = Texture("peel_state", "RG32F")
COLOR = Texture("layers", per=of_pixels)
COLOR_DEPTH = Texture("layers_depth", "R32F", of_pixels)


def passes(planning):
    if not planning.shown:
        return
    count, why_not = planning.find(layers)
    if why_not:
        planning.lack("transparency", f"surfels whose opacity is below 1 are drawn opaque: {why_not}")
    elif not count:
        planning.skip("transparent layers", "every surfel is opaque")
    if not count:
        return
    cleared = PEELED, COLOR, COLOR_DEPTH
    more = (LAYERS_NORMAL,) if "normal_coverage" in outputs.wanted(planning) else ()
    more += tuple(LAYERS[name] for name in outputs.handed_on(planning, True))
    yield Pass("start_layers", "nothing is peeled yet", None, start, (Part("transparency", writes=(*cleared, *more)),))
    peeled = count - planning.settings.blends_rest
    last = oit.passes_of_rest(planning, PEELED, COLOR) if planning.settings.blends_rest else ()
    yield Loop("layers", "from the nearest to the farthest", peeled, _body(planning), OCCUPANCY, last)


def _body(planning) -> tuple[Pass, ...]:
    in_space = planning.method.rasterizer == "object_space"
    own, ends = visibility.own_parts(planning, DEPTH, has_polygons=False), "layers end where nothing is left"
    found = visibility.drawn("visibility", "behind nearer layers, before what is opaque", own, planning, Kind.LAYER)
    occupied = Part("transparency", reads=(DEPTH,), writes=(OCCUPANCY,))
    bounds = depth_bounds.bounds(planning, "depths are compared in the shader", DEPTH, Kind.LAYER)
    peel = Part("transparency", reads=(DEPTH, SHADED), updates=(PEELED,))
    return (
        found,
        Pass("layer_occupancy", ends, Host.LAYER_OCCUPANCY, fill_all, (occupied,), Kind.LAYER),
        *(() if in_space else (bounds,)),
        gbuffer.attributes(planning, "splats of one layer blend", DEPTH, Kind.LAYER),
        lighting.deferred(planning, "a layer is lit once", Kind.LAYER),
        lighting.layer_pixels(planning, DEPTH, (COLOR, COLOR_DEPTH)),
        Pass("peel", "the next layer lies behind this one", Host.PEEL, fill_all, (peel,), Kind.LAYER),
    )


def is_present(planning) -> bool:
    return planning.find(layers).count > 0


def draws(tile, p: Pass, instance) -> bool:
    """Whether a pass draws an object: if there are layers, they draw transparent objects, and other passes the rest."""
    return not tile.plan.find(layers).count or instance.is_transparent is (p.kind in (Kind.LAYER, Kind.REST))


def margin(planning) -> int:
    return LAYER_MARGIN if planning.find(layers).count else 0


def parts(planning, p):
    opaque, tested = VISIBILITY_DEPTH, (PEELED, VISIBILITY_DEPTH)
    opacity = {"varyings": (("flat", "float", "opacity"),)}
    if p.kind == Kind.LAYER:
        if p.host == Host.VISIBILITY:
            yield Part("transparency", reads=tested)
        if p.host == Host.OBJECT_SPACE:
            yield Part("transparency", reads=tested, **opacity)
        if p.host == Host.SCREEN_SPACE:
            yield Part("transparency", reads=(PEELED,), **opacity)
        if p.host == Host.DEPTH_BOUNDS:
            yield Part("transparency", reads=(opaque,))
        if p.host in (Host.RESOLVE, Host.LAYER):
            yield Part("transparency", reads=(PEELED,))
    if p.kind == Kind.REST and p.host in SPLAT_HOSTS:
        yield Part("transparency", ("layer",), reads=tested, **opacity)
    if p.kind == Kind.OPAQUE and p.host in (Host.SHADING, Host.RESOLVE):
        yield Part("transparency", reads=(PEELED, COLOR, COLOR_DEPTH))


def start(tile, p: Pass):
    """Start with nothing peeled and nothing visible: all 0."""
    for texture in p.fills:
        target = tile.resources.device.target([tile.texture(texture)])
        target.clear(color=0.0)
    return target
