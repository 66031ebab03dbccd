# SPDX-License-Identifier: GPL-3.0-or-later
"""What the Color and Converter nodes become."""

from __future__ import annotations

import numpy as np

from ....shading_nodes import numbers
from ... import working_space
from .. import ramps
from ..node_walks import Node
from .reading import GraphReading, Value, reads, unreadable


@reads("RGB", "Value")
def _own(tree: GraphReading, node: Node, output: str) -> Value:
    return tree.constant(node.outputs[0])


@reads("HueSaturation")
def _hue_saturation(tree: GraphReading, node: Node, output: str) -> Value:
    color = tree.input(node, "Color")
    return tree.color("hue saturation", *(tree.input(node, k) for k in ("Hue", "Saturation", "Value", "Fac")), color)


@reads("BrightContrast")
def _bright_contrast(tree: GraphReading, node: Node, output: str) -> Value:
    return tree.color("bright contrast", *map(tree.read, node.inputs))


@reads("Gamma")
def _gamma(tree: GraphReading, node: Node, output: str) -> Value:
    return tree.color("gamma", *map(tree.read, node.inputs))


@reads("Invert")
def _invert(tree: GraphReading, node: Node, output: str) -> Value:
    return tree.color("invert", *map(tree.read, node.inputs))


@reads("MixRGB")
def _mix_rgb(tree: GraphReading, node: Node, output: str) -> Value:
    return tree.color("mixed colors", *map(tree.read, node.inputs), settings=(node.blend_type, True, node.use_clamp))


@reads("Mix")
def _mix(tree: GraphReading, node: Node, output: str) -> Value:
    kind = {"FLOAT": "Float", "VECTOR": "Vector", "RGBA": "Color"}.get(node.data_type)
    if kind is None:
        raise unreadable(node, f"of type {node.data_type.title()}")
    how = "Vector" if node.data_type == "VECTOR" and node.factor_mode == "NON_UNIFORM" else "Float"
    given = [tree.input(node, name) for name in (f"Factor_{how}", f"A_{kind}", f"B_{kind}")]
    if kind == "Color":
        return tree.color("mixed colors", *given, settings=(node.blend_type, node.clamp_factor, node.clamp_result))
    return tree.add("mixed", *given, settings=(node.clamp_factor,), width=3 if kind == "Vector" else 1)


@reads("SeparateColor", "SeparateRGB", "SeparateHSV")
def _separate(tree: GraphReading, node: Node, output: str) -> Value:
    mode = getattr(node, "mode", node.bl_idname[-3:])
    parts = tree.add("separated", tree.read(node.inputs[0]), settings=(mode,), width=3)
    return tree.add("component", parts, settings=([s.identifier for s in node.outputs].index(output),))


@reads("CombineColor", "CombineRGB", "CombineHSV")
def _combine(tree: GraphReading, node: Node, output: str) -> Value:
    return tree.color("combined", *map(tree.read, node.inputs), settings=(getattr(node, "mode", node.bl_idname[-3:]),))


@reads("RGBToBW")
def _luminance(tree: GraphReading, node: Node, output: str) -> Value:
    return tree.number(tree.read(node.inputs[0]))


@reads("Math")
def _math(tree: GraphReading, node: Node, output: str) -> Value:
    if node.operation not in numbers.OPERATIONS:
        raise unreadable(node, f"that does {node.operation.replace('_', ' ').title()}")
    count = numbers.OPERATIONS[node.operation][0]
    given = [tree.read(socket) for socket in node.inputs[:count]] + [Value((0.0,))] * (3 - count)
    return tree.add("math", *given, settings=(node.operation, node.use_clamp))


@reads("Clamp")
def _clamp(tree: GraphReading, node: Node, output: str) -> Value:
    return tree.add("clamp", *map(tree.read, node.inputs), settings=(node.clamp_type == "RANGE",))


@reads("MapRange")
def _map_range(tree: GraphReading, node: Node, output: str) -> Value:
    is_number = node.data_type == "FLOAT"
    names = ["Value", "From Min", "From Max", "To Min", "To Max", "Steps"]
    if not is_number:
        names = ["Vector", *(f"{name.replace(' ', '_')}_FLOAT3" for name in names[1:])]
    given = [tree.input(node, name) for name in names]
    return tree.add("map range", *given, settings=(node.interpolation_type, node.clamp), width=1 if is_number else 3)


@reads("ValToRGB")
def _ramp(tree: GraphReading, node: Node, output: str) -> Value:
    table, is_stepped = ramps.table(node.color_ramp), node.color_ramp.interpolation == "CONSTANT"
    factor = tree.read(node.inputs[0])
    if output == "Alpha":
        return tree.add("ramp alpha", factor, settings=(table[:, 3:], is_stepped))
    return tree.color("ramp", factor, settings=(table[:, :3], is_stepped))


@reads("RGBCurve", "VectorCurve", "FloatCurve")
def _curves(tree: GraphReading, node: Node, output: str) -> Value:
    given = list(map(tree.read, node.inputs))
    settings = _tables(node.mapping, node.bl_idname == "ShaderNodeRGBCurve")
    return tree.add("curves", *given, settings=settings, width=given[1].width, is_color=given[1].is_color)


def _tables(mapping, has_common: bool) -> tuple:
    """The table of a mapping's curves, and its range; has_common: whether the last curve comes before the others."""
    mapping.update()
    curves = list(mapping.curves)
    low = min(curve.points[0].location[0] for curve in curves)
    high = max(curve.points[-1].location[0] for curve in curves)
    places = np.linspace(low, high, ramps.PLACES)
    if has_common:
        *curves, common = curves
        places = [mapping.evaluate(common, place) for place in places.tolist()]
    table = np.array([[mapping.evaluate(curve, place) for curve in curves] for place in places], np.float32)
    return table, low, max(high, low + 1e-6), mapping.extend == "EXTRAPOLATED"


@reads("Blackbody", "Wavelength")
def _spectrum(tree: GraphReading, node: Node, output: str) -> Value:
    kind = node.bl_idname.removeprefix("ShaderNode").lower()
    return tree.color(kind, tree.read(node.inputs[0]), settings=(np.linalg.inv(working_space.to_xyz()),))
