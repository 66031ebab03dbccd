# SPDX-License-Identifier: GPL-3.0-or-later
"""Which transparent layers a frame peels, and the passes of each (Guennebaud et al. 2006, section 6).

Opaque surfels are seen first, and hide what lies behind them. Then, from the nearest to the farthest, a layer of what
is transparent is made as an opaque picture is: by visibility, attributes and shading; but every splat that a nearer
layer holds is left out. As a layer holds just what lies no deeper than its nearest splat moved back by its epsilon,
each splat is in one layer at each sample, and the overlapping splats of a surface are in the same one.

The last layer may hold all that is left: splats are lit one by one, their colours mixed by their opacity, and their
weights, in those of a single surface, tell how many surfaces there are.

Layers are put on one another where visibility is known: each adds to the pixel what the nearer ones let through at each
of its samples, and the opaque picture what all of them do.
"""

from __future__ import annotations

from .frame_plan import TEXTURES, PlannedPass
from .identity import NUMBERED
from .methods import Method
from .packing import row_count
from .scene import Scene
from .settings import Settings
from .shading_models import ShadingModel


def layers_of(scene: Scene, settings: Settings, method: Method, model: ShadingModel, left_out: list) -> int:
    """How many layers are peeled at most; why none are is appended to `left_out`, as "transparency" where some should.

    Raises ValueError where hardware multisampling is asked for, whose samples hold one depth each but are shaded
    together.
    """
    if not any(instance.is_transparent for instance in scene.surfels):
        left_out.append(("transparent layers", "every surfel is opaque"))
        return 0
    why_not = ""
    if method.works_in == "sprites":
        why_not = f"of {method.name} the nearest splat wins"
    elif model.is_diagnostic:
        why_not = f"{model.name} shows how splats add up"
    elif settings.multisampling:
        raise ValueError(
            f"Transparent surfels cannot be peeled with multisampling {settings.multisampling}; set it to 0 and use "
            "supersampling."
        )
    if why_not:
        left_out.append(("transparency", f"surfels whose opacity is below 1 are drawn opaque: {why_not}"))
        return 0
    return settings.layers


def layer_outputs(settings: Settings) -> tuple[str, ...]:
    """What layers add up to in each pixel."""
    has_normal = bool({"normal", "coverage"} & set(settings.outputs))
    more = (f"layers_{texture}" for texture in _handed_on(settings))
    return ("layers", "layers_depth", *(("layers_normal",) if has_normal else ()), *more)


def _handed_on(settings: Settings) -> tuple[str, ...]:
    """Textures of the last pass that layers add to, beside colour, depth and normal."""
    names = {"diffuse_color": "diffuse_color", "emission": "emission", "shadow": "shadow_overdraw"}
    return tuple(texture for name, texture in names.items() if name in settings.outputs)


def layer_passes(
    layers: int, settings: Settings, method: Method, model: ShadingModel, sums: tuple[str, ...], reads: tuple[str, ...]
) -> tuple[PlannedPass, ...]:
    """Of all layers. sums: of the attribute pass of opaque surfels. reads: of their shading."""
    if not layers:
        return ()
    start = PlannedPass("start_layers", "nothing is peeled yet", (), ("peeled", *layer_outputs(settings)))
    peeled = layers - settings.blends_rest
    made = [p for number in range(1, peeled + 1) for p in _layer(number, settings, method, sums, reads)]
    return start, *made, *(_rest(layers, sums, reads) if settings.blends_rest else ())


def lit_rows(scene: Scene) -> int:
    """Of a texture of one texel a splat, for the largest of the transparent instances."""
    return max(row_count(i.surfels) for i in scene.surfels if i.is_transparent)


#: Of what the shading of the opaque picture may read, what a layer has nothing of.
_OPAQUE_ONLY = {"lines", "overdraw_sum"} | {
    f"polygon_{name}" for name in ("color", "normal", "material", "emission", "plane")
}


def _layer(number: int, settings: Settings, method: Method, sums, reads) -> tuple[PlannedPass, ...]:
    in_space, is_filtered = method.works_in == "space", method.filters_silhouettes
    # How many splats overlap is told of what is opaque alone.
    sums = tuple(dict.fromkeys(name for name in (*sums, "depth_sum") if name != "overdraw_sum"))
    tested = ("layer_depth", "visibility_depth", "peeled") if in_space else ("seen_range", "layer_depth", "peeled")
    shading = tuple(dict.fromkeys((*sums, *(name for name in reads if name not in _OPAQUE_ONLY))))
    lit = ("shaded", "surface", *(f"sample_{texture}" for texture in _handed_on(settings)))
    resolved = (*lit, "peeled", "layer_depth", *(("seen_range",) if is_filtered else ()))
    seen, whose, whose_next = ("layer_depth",), (), ()
    if set(NUMBERED) & set(settings.outputs):
        seen, whose, whose_next = ("layer_depth", "layer_identity"), ("identity", "layer_identity"), ("identity_next",)
    passes = [
        ("visibility", "behind nearer layers, before what is opaque", ("peeled", "visibility_depth"), seen),
        ("left", "layers end where nothing is left", ("layer_depth",), ("left",)),
        ("seen_range", "depths are compared in the shader", ("layer_depth", "visibility_depth"), ("seen_range",)),
        ("attributes", "splats of one layer blend", tested, sums),
        ("sample_shading", "a layer is lit once", shading, lit),
        ("resolve" if is_filtered else "layer", "nearer layers cover it", resolved, layer_outputs(settings)),
        (
            "peel",
            "the next layer lies behind this one",
            ("peeled", "layer_depth", "shaded", *whose),
            ("peeled_next", *whose_next),
        ),
    ]
    return tuple(PlannedPass(*p, layer=number) for p in passes if not (in_space and p[0] == "seen_range"))


def _rest(number: int, sums, reads) -> tuple[PlannedPass, ...]:
    light = tuple(name for name in reads if name not in TEXTURES or name == "shadow_depth")
    passes = (
        (
            "rest",
            "all that is left, each splat lit by itself",
            ("visibility_depth", "peeled", *light),
            ("lit_splats", "rest_sum", "rest_weight"),
        ),
        ("rest_shading", "its weights tell how much it hides", ("rest_sum", "rest_weight", "depth_sum"), ("shaded",)),
        ("rest_layer", "nearer layers cover it", ("shaded", "peeled"), ("layers",)),
        ("peel_rest", "it covers what is opaque", ("peeled", "shaded"), ("peeled_next",)),
    )
    return tuple(PlannedPass(*p, layer=number) for p in passes)
