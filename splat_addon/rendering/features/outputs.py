# SPDX-License-Identifier: GPL-3.0-or-later
"""Storage of a frame's arrays: their packing into pixel textures, and the limits of attachments and samplers.

Outputs other than colour, depth and normal go from lit samples to pixels in textures of the same packing: one set for
samples if silhouettes are filtered later, one for layers if there is transparency, and one for pixels.
"""

from __future__ import annotations

from ..frame import HELD_BY
from ..passes.decisions import layers, model_in
from ..passes.sums import counts_splats, plane_sum
from ..passes.textures import HANDED_ON, LAYERS, LAYERS_NORMAL, MAX_COLORS, PIXELS, SAMPLES
from ..plan.frame_plan import FramePlan
from ..plan.graph import Part, Texture
from ..plan.hosts import LIGHTING_HOSTS, LIT_HOSTS, SPLAT_HOSTS, Host, Kind

NAMES = ("overdraw", "weight_output", "shadow_output", "normal_coverage", *HANDED_ON)
OVERDRAW = Texture("gbuffer_overdraw", "R32F", is_multisampled=True)

_HOSTS = LIGHTING_HOSTS | SPLAT_HOSTS | {Host.RESOLVE, Host.LAYER, Host.BACKGROUND}


def wanted(planning) -> tuple[str, ...]:
    """Names of all pixel textures."""
    asked_for = {HELD_BY[name][0] for name in planning.settings.outputs if name in HELD_BY}
    return tuple(name for name in PIXELS if name in {"combined", "depth"} | asked_for)


def handed_on(planning, by_layers: bool = False) -> tuple[str, ...]:
    """The textures that samples pass on. Layers do not pass on overdraw, which counts opaque splats only."""
    names = [name for name in planning.find(wanted) if name in HANDED_ON]
    if by_layers and "shadow" not in planning.settings.outputs:
        names = [name for name in names if name != "shadow_overdraw"]
    return tuple(names)


def read_back(planning) -> tuple[Texture, ...]:
    """The textures that are read back for a frame."""
    return tuple(PIXELS[name] for name in planning.find(wanted))


def passes(planning):
    """No passes; records what is not requested."""
    if planning.shown or planning.scene.environment:
        given = planning.find(wanted)
        for name in PIXELS:
            if name not in given:
                planning.skip(name, "nothing that it holds is asked for")
    if not planning.shown:
        return ()
    model, names = planning.model, planning.settings.outputs
    if not counts_splats(planning):
        planning.skip(OVERDRAW.name, "nobody asks how many splats a sample is the mean of")
    if model.has_material and "diffuse_color" in names:
        planning.has("METALS", "of its diffuse colour a surface shows what is not metal")
    if model.is_lit and planning.scene.lights and "shadow" in names:
        planning.has("SHADOW_SHARE", "the share of the lights that arrives is asked for")
    for feature, why in model.features:
        planning.has(feature, why)
    return ()


def _count(planning, p):
    """The sum that counts splats: separate, or beside the planes that shadows compare depths with."""
    beside = plane_sum(planning, p.kind)
    words, own = (("beside_planes",), ()) if beside else (("by_itself",), (OVERDRAW,))
    if p.host in SPLAT_HOSTS:
        yield Part("overdraw", words, writes=own)
    if p.host in LIT_HOSTS:
        model = ("overdraw_model",) if model_in(planning, p).sums else ()
        yield Part("overdraw", (*words, *model), reads=(beside or OVERDRAW,))


def _found(planning):
    """The textures requested, passed on by samples, and passed on by layers."""
    return planning.find(wanted), handed_on(planning), handed_on(planning, True)


def parts(planning, p):
    if p.host not in _HOSTS:
        return
    model, in_layer = model_in(planning, p), p.kind == Kind.LAYER
    is_counted = counts_splats(planning) and p.kind == Kind.OPAQUE
    if is_counted:
        yield from _count(planning, p)
    if p.host in LIT_HOSTS and model.features:
        yield Part("weight_output")
    if p.host in LIT_HOSTS:
        if model.is_lit and planning.scene.lights and "shadow" in planning.settings.outputs:
            yield Part("shadow_output")
    has_layers = p.host in (Host.SHADING, Host.RESOLVE) and planning.find(layers).count > 0 and not in_layer
    if p.host in (Host.SHADING, Host.RESOLVE, Host.LAYER, Host.BACKGROUND):
        if "normal_coverage" in planning.find(_found)[0]:
            texture = LAYERS_NORMAL if in_layer else PIXELS["normal_coverage"]
            before = {"reads": (LAYERS_NORMAL,), "words": ("layers_normal",)} if has_layers else {}
            yield Part("normal_coverage", writes=(texture,), **before)
    yield from _handing(planning, p, in_layer, has_layers)


def _handing(planning, p, in_layer: bool, has_layers: bool):
    """The parts that pass outputs on from samples to pixels."""
    shows_metals = model_in(planning, p).has_material and "diffuse_color" in planning.settings.outputs
    has_material = ("has_material",) if shows_metals else ()
    _, of_all, of_layers = planning.find(_found)
    names = of_layers if in_layer else of_all
    for name in names:
        words = [*(has_material if p.host in LIT_HOSTS else ())]
        reads = []
        if p.host in (Host.RESOLVE, Host.LAYER):
            reads.append(SAMPLES[name])
        if has_layers and name in of_layers:
            reads.append(LAYERS[name])
            words.append(f"layers_{name}")
        kinds = {Host.DEFERRED_LIGHTING: SAMPLES, Host.SHADING: PIXELS, Host.BACKGROUND: PIXELS}
        kinds |= {Host.RESOLVE: LAYERS if in_layer else PIXELS, Host.LAYER: LAYERS}
        if p.host in kinds:
            texture = kinds[p.host][name]
            called = ((texture, f"out_{name}"),)
            yield Part(name, tuple(words), tuple(reads), writes=(texture,), called=called)


def check(plan: FramePlan) -> None:
    """Raise ValueError for a pass with more attachments than all devices support."""
    for p in plan.passes:
        if len(p.colors) > MAX_COLORS and p.host:
            names = [texture.name for texture in p.colors]
            raise ValueError(
                f"The {p.name} pass would write {len(names)} textures at once ({', '.join(names)}), and "
                f"devices have room for {MAX_COLORS}. Leave Overdraw, indices and mattes out, or choose float32 sums."
            )


def check_samplers(plan: FramePlan, room: int) -> None:
    """Raise ValueError for a pass whose shader would read more textures than a device supports."""
    for p in plan.passes:
        read = p.wiring.most_read
        if len(read) > room:
            raise ValueError(
                f"The {p.name} pass would read {len(read)} textures at once ({', '.join(read)}), and this device "
                f"has room for {room}. Leave outputs out, or give all objects one material and no transparency."
            )
