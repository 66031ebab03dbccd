# SPDX-License-Identifier: GPL-3.0-or-later
"""The passes of a view layer: named as in Cycles and EEVEE, and filled from the arrays of a `Frame`."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import bpy
import numpy as np
from bpy.props import BoolProperty

from ...rendering import Cryptomatte, Frame
from ..export.passed_over import listed
from ..ids import LAYER_SETTINGS
from ..registration import with_property

#: Since 5.0, passes have the names that users read, and so have their switches: this one was "Emit".
_HAS_LONG_NAMES = bpy.types.ViewLayer.bl_rna.properties["use_pass_emit"].name == "Emission"


#: Names in each layer of a Cryptomatte pass.
_RANKS_PER_LAYER = 2


class RenderPass(NamedTuple):
    """output: the array of `Frame` that fills it.
    flag: the view layer's property that enables it, if any.
    is_ours: whether that property belongs to `ViewLayerPasses`.
    """

    name: str
    letters: str
    kind: str
    output: str
    flag: str | None = None
    is_ours: bool = False


#: Name of the Cryptomatte layers, before their numbers.
_MATTE = "CryptoObject"


def _named(long: str, short: str) -> str:
    return long if _HAS_LONG_NAMES else short


RENDER_PASSES = (
    RenderPass("Combined", "RGBA", "COLOR", "color"),
    RenderPass("Depth", "Z", "VALUE", "depth", "use_pass_z"),
    RenderPass("Position", "XYZ", "VECTOR", "position", "use_pass_position"),
    RenderPass("Normal", "XYZ", "VECTOR", "normal", "use_pass_normal"),
    RenderPass(_named("Diffuse Color", "DiffCol"), "RGB", "COLOR", "diffuse_color", "use_pass_diffuse_color"),
    RenderPass(_named("Emission", "Emit"), "RGB", "COLOR", "emission", "use_pass_emit"),
    RenderPass("Shadow", "RGB", "COLOR", "shadow", "use_pass_shadow"),
    RenderPass(_named("Object Index", "IndexOB"), "X", "VALUE", "object_index", "use_pass_object_index"),
    RenderPass(_named("Material Index", "IndexMA"), "X", "VALUE", "material_index", "use_pass_material_index"),
    RenderPass("Coverage", "X", "VALUE", "coverage", "use_pass_coverage", is_ours=True),
    RenderPass("Overdraw", "X", "VALUE", "overdraw", "use_pass_overdraw", is_ours=True),
)


class ViewLayerPasses(bpy.types.PropertyGroup):
    use_pass_coverage: BoolProperty(
        name="Coverage",
        description="The share of each pixel that surfaces cover, regardless of the background",
        default=False,
    )
    use_pass_overdraw: BoolProperty(
        name="Overdraw",
        description="Number of splats blended in a sample, averaged over the pixel. Frames take slightly longer",
        default=False,
    )


def asked_for(view_layer: bpy.types.ViewLayer) -> list[RenderPass]:
    """The passes enabled in the view layer, in the order of `RENDER_PASSES`, and its Cryptomatte layers."""
    ours = getattr(view_layer, LAYER_SETTINGS)
    passes = [p for p in RENDER_PASSES if p.flag is None or getattr(ours if p.is_ours else view_layer, p.flag)]
    return passes + [RenderPass(name, "rgba", "COLOR", "cryptomatte") for name in _matte_layers(view_layer)]


def _matte_layers(view_layer: bpy.types.ViewLayer) -> list[str]:
    if not view_layer.use_pass_cryptomatte_object:
        return []
    count = -(-view_layer.pass_cryptomatte_depth // _RANKS_PER_LAYER)
    return [f"{_MATTE}{number:02d}" for number in range(count)]


def outputs_of(view_layer: bpy.types.ViewLayer) -> tuple[str, ...]:
    """Names of the arrays that fill these passes."""
    return tuple(dict.fromkeys(p.output for p in asked_for(view_layer)))


#: A Cryptomatte of objects is filled besides the table; Combined is always there, and so is an accurate Cryptomatte.
_ALWAYS = frozenset({"use_pass_cryptomatte_object", "use_pass_combined", "use_pass_cryptomatte_accurate"})


def absent_passes(view_layer: bpy.types.ViewLayer) -> Iterator[str]:
    """A sentence about passes that the view layer asks for and this engine does not have."""
    known = {p.flag for p in RENDER_PASSES} | _ALWAYS
    every = (p for p in view_layer.bl_rna.properties if p.identifier.startswith("use_pass_"))
    names = [p.name for p in every if p.identifier not in known and getattr(view_layer, p.identifier)]
    names += [f"AOV {aov.name}" for aov in view_layer.aovs]
    names += [f"Light Group {group.name}" for group in view_layer.lightgroups]
    if names:
        yield f"The view layer {view_layer.name!r} asks for {listed(names)}, passes that this engine does not have"


def register_passes(engine: bpy.types.RenderEngine, scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> None:
    """Register every pass that the view layer requests with Blender."""
    for p in asked_for(view_layer):
        engine.register_pass(scene, view_layer, p.name, len(p.letters), p.letters, p.kind)


def hand_over(engine: bpy.types.RenderEngine, view_layer: bpy.types.ViewLayer, view: str, frame: Frame) -> None:
    """Fill the view layer's passes for one view of a stereo render, or for the only view."""
    height, width = frame.color.shape[:2]
    result = engine.begin_result(0, 0, width, height, layer=view_layer.name, view=view)
    targets = result.layers[0].passes
    for p in asked_for(view_layer):
        if p.output != "cryptomatte":
            _fill(targets[p.name], getattr(frame, p.output))
    if frame.cryptomatte is not None:
        _fill_matte(targets, _matte_layers(view_layer), frame.cryptomatte)
    engine.end_result(result)
    if frame.cryptomatte is not None:
        for field, value in frame.cryptomatte.metadata(f"{view_layer.name}.{_MATTE}").items():
            engine.get_result().stamp_data_add_field(field, value)


def _fill_matte(targets: bpy.types.RenderPasses, layers: list[str], matte: Cryptomatte) -> None:
    """Fill Cryptomatte: two names and their coverage per layer, largest first."""
    ranks = matte.ranks(_RANKS_PER_LAYER * len(layers))
    for number, name in enumerate(layers):
        _fill(targets[name], ranks[:, :, _RANKS_PER_LAYER * number : _RANKS_PER_LAYER * (number + 1)])


def _fill(target: bpy.types.RenderPass, values: np.ndarray) -> None:
    target.rect.foreach_set(np.ascontiguousarray(values, np.float32).ravel())


register, unregister = with_property(bpy.types.ViewLayer, LAYER_SETTINGS, ViewLayerPasses)
