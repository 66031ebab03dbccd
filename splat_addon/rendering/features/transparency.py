# SPDX-License-Identifier: GPL-3.0-or-later
"""Transparent layers, peeled from the nearest to the farthest (Guennebaud et al. 2006, section 6).

Opaque surfels are seen first, and hide what lies behind them. Then, from the nearest to the farthest, a layer of what
is transparent is made as an opaque picture is: by visibility, attributes and shading; but every splat that a nearer
layer holds is left out. As a layer holds just what lies no deeper than its nearest splat moved back by its epsilon,
each splat is in one layer at each sample, and the overlapping splats of a surface are in the same one.

The last layer may hold all that is left: splats are lit one by one, their colours mixed by their opacity, and their
weights, in those of a single surface, tell how many surfaces there are (`oit`).

Layers are put on one another where visibility is known: each adds to the pixel what the nearer ones let through at each
of its samples, and the opaque picture what all of them do.
"""

from __future__ import annotations

from ..plan.graph import Loop, Part, Pass, Texture, fill, of_pixels
from . import depth_bounds, gbuffer, lighting, oit, outputs, visibility
from .drawing import SPLAT_HOSTS

#: Samples that are read to each side of a layer's.
LAYER_MARGIN = 1
#: Of a picture along each side, for which `OCCUPANCY` holds one value each.
OCCUPANCY_BLOCKS = 64
CONSTANTS = {"OCCUPANCY_BLOCKS": OCCUPANCY_BLOCKS}
VALUES = {"alpha_threshold": ("float", lambda tile: tile.settings.alpha_threshold)}

DEPTH = Texture("layer_depth", "DEPTH32F")
OCCUPANCY = Texture("layer_occupancy", "R32F", lambda plan, pixels: (OCCUPANCY_BLOCKS, OCCUPANCY_BLOCKS))
PEELED = Texture("peel_state", "RG32F")
COLOR = Texture("layers", per=of_pixels)
COLOR_DEPTH = Texture("layers_depth", "R32F", of_pixels)


def layers(planning) -> int:
    """How many are peeled at most. Raises ValueError where hardware multisampling is asked for, whose samples hold one
    depth each but are shaded together.
    """
    method, settings = planning.method, planning.settings
    if not any(instance.is_transparent for instance in planning.scene.surfels):
        planning.skip("transparent layers", "every surfel is opaque")
        return 0
    why_not = ""
    if method.rasterizer == "point_sprite":
        why_not = f"of {method.name} the nearest splat wins"
    elif planning.model.is_diagnostic:
        why_not = f"{planning.model.name} shows how splats add up"
    elif settings.multisampling:
        raise ValueError(
            f"Transparent surfels cannot be peeled with multisampling {settings.multisampling}; set it to 0 and use "
            "supersampling."
        )
    if why_not:
        planning.skip("transparency", f"surfels whose opacity is below 1 are drawn opaque: {why_not}")
        return 0
    return settings.layers


def passes(planning):
    count = planning.facts["layers"] = planning.find(layers) if planning.shown else 0
    if not count:
        return
    cleared = PEELED, COLOR, COLOR_DEPTH
    more = (outputs.LAYERS_NORMAL,) if "normal_coverage" in outputs.wanted(planning) else ()
    more += tuple(outputs.LAYERS[name] for name in outputs._handed_on(planning, True))
    yield Pass("start_layers", "nothing is peeled yet", "", start, (Part("transparency", writes=(*cleared, *more)),))
    peeled = count - planning.settings.blends_rest
    last = oit.passes_of_rest(planning, PEELED, COLOR) if planning.settings.blends_rest else ()
    yield Loop("layers", "from the nearest to the farthest", peeled, _body(planning), OCCUPANCY, last)


def _body(planning) -> tuple[Pass, ...]:
    in_space = planning.method.rasterizer == "object_space"
    own = visibility.own_parts(planning, DEPTH)
    found = visibility.drawn("visibility", "behind nearer layers, before what is opaque", own, planning, "layer")
    occupied = Part("transparency", reads=(DEPTH,), writes=(OCCUPANCY,))
    bounds = depth_bounds.bounds(planning, "depths are compared in the shader", DEPTH, "layer")
    peel = Part("transparency", reads=(DEPTH, lighting.SHADED), updates=(PEELED,))
    return (
        found,
        Pass("layer_occupancy", "layers end where nothing is left", "layer_occupancy.frag", fill, (occupied,), "layer"),
        *(() if in_space else (bounds,)),
        gbuffer.attributes(planning, "splats of one layer blend", DEPTH, "layer"),
        lighting.deferred(planning, "a layer is lit once", "layer"),
        lighting.layer_pixels(planning, DEPTH, (COLOR, COLOR_DEPTH)),
        Pass("peel", "the next layer lies behind this one", "peel.frag", fill, (peel,), "layer"),
    )


def is_present(planning) -> bool:
    return bool(planning.facts["layers"])


def draws(tile, p: Pass, instance) -> bool:
    """Where layers are planned, what is transparent is drawn by them, and all the rest by other passes."""
    return not tile.plan.facts["layers"] or instance.is_transparent is (p.kind in ("layer", "rest"))


def margin(planning) -> int:
    return LAYER_MARGIN if planning.facts["layers"] else 0


def parts(planning, p):
    opaque, tested = visibility.DEPTH, (PEELED, visibility.DEPTH)
    opacity = {"varyings": (("flat", "float", "opacity"),)}
    if p.kind == "layer":
        if p.host == "visibility.frag":
            yield Part("transparency", reads=tested)
        if p.host == "object_space.frag":
            yield Part("transparency", reads=tested, **opacity)
        if p.host == "screen_space.frag":
            yield Part("transparency", reads=(PEELED,), **opacity)
        if p.host == "depth_bounds.frag":
            yield Part("transparency", reads=(opaque,))
        if p.host in ("resolve.frag", "layer.frag"):
            yield Part("transparency", reads=(PEELED,))
    if p.kind == "rest" and p.host in SPLAT_HOSTS:
        yield Part("transparency", ("layer",), reads=tested, **opacity)
    if p.kind == "opaque" and p.host in ("shading.frag", "resolve.frag"):
        yield Part("transparency", reads=(PEELED, COLOR, COLOR_DEPTH))


def start(tile, p: Pass):
    """Nothing is peeled, and nothing seen: all 0."""
    for texture in p.fills:
        target = tile.resources.device.target([tile.texture(texture)])
        target.clear(color=0.0)
    return target
