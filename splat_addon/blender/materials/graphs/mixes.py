# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a tree of mixed and added shaders as graphs of its colour, opacity and emission.

The rules are those of `shader_mixes`, with steps instead of nodes: Mix Shader mixes by its factor, Add Shader adds, and
each leaf supplies its own. Transmitted light adds up, and colours are weighted by their shader's coverage.
"""

from __future__ import annotations

from ..mesh_layers import MeshLayers
from ..surface_shaders import CLEAR, SHADERS, Shader, mixed_sockets
from ..texture_images import UnreadableError
from .channels import ReadGraph, limited
from .reading import GraphReading, Value

_ZERO, _ONE = Value((0.0,)), Value((1.0,))

#: What a shader without a colour socket looks like.
_GREY = Value((0.8,))


def read_mixed(shader: Shader, name: str, layers: MeshLayers) -> ReadGraph:
    """The colour, opacity or emission of a tree of shaders."""
    reading = GraphReading(layers)
    through = _combined(reading, shader, "opacity", {})
    opacity = reading.add("clamp", reading.add("invert", _ONE, through), _ZERO, _ONE, settings=(False,))
    if name == "opacity":
        return ReadGraph(*reading.graph(opacity), reading.doubts, reading.asks_owner)
    total = reading.three(_combined(reading, shader, name, {}), True)
    shown = reading.color("divided", total, opacity)
    return ReadGraph(*reading.graph(shown), reading.doubts, reading.asks_owner)


def _combined(reading: GraphReading, shader: Shader | None, name: str, made: dict[Shader, Value]) -> Value:
    """One channel of a tree; of the opacity, what is let through. made: the same for those that were reached already,
    which is added to; a ring of shaders ends at black."""
    if shader is None:
        return _ZERO
    if shader not in made:
        made[shader] = _ZERO
        made[shader] = _of_one(reading, shader, name, made)
    return made[shader]


def _of_one(reading: GraphReading, shader: Shader, name: str, made: dict[Shader, Value]) -> Value:
    sockets = mixed_sockets(shader)
    if sockets is None:
        return _LEAVES[name](reading.inside(shader.groups), shader)
    parts = [_combined(reading, shader.feeding(socket), name, made) for socket in sockets]
    if len(parts) < 2:
        return parts[0] if parts else _ZERO
    if name != "opacity":
        parts = [reading.three(part, True) for part in parts]
    width = parts[0].width
    if shader.node.type == "ADD_SHADER":
        share, parts = Value((0.5,)), [reading.add("multiplied", Value((2.0,)), p, width=width) for p in parts]
    else:
        share = reading.inside(shader.groups).read(shader.node.inputs[0])
    return reading.add("mixed", share, *parts, settings=(True,), width=width, is_color=width == 3)


def _alpha(reading: GraphReading, shader: Shader) -> Value:
    return limited(reading, shader, "Alpha") if shader.node.type == "BSDF_PRINCIPLED" else _ONE


def _covering(reading: GraphReading, shader: Shader, value: Value) -> Value:
    return reading.color("multiplied", reading.three(value, True), _alpha(reading, shader))


def _color(reading: GraphReading, shader: Shader) -> Value:
    if shader.node.type in CLEAR or shader.node.type == "EMISSION":
        return _ZERO
    name = next((name for name in ("Color", "Base Color") if name in shader.node.inputs), None)
    return _covering(reading, shader, _GREY if name is None else _read(reading, shader, name))


def _emission(reading: GraphReading, shader: Shader) -> Value:
    names = SHADERS.get(shader.node.bl_idname, {}).get("emission")
    if names is None:
        return _ZERO
    color, strength = (_read(reading, shader, name) for name in names)
    return _covering(reading, shader, reading.color("multiplied", reading.three(color, True), strength))


def _let_through(reading: GraphReading, shader: Shader) -> Value:
    if shader.node.type == "BSDF_PRINCIPLED":
        return reading.add("invert", _ONE, _alpha(reading, shader))
    return _ONE if shader.node.type in CLEAR else _ZERO


def _read(reading: GraphReading, shader: Shader, name: str) -> Value:
    """An input, or the plain value of its socket if nothing of it can be read."""
    try:
        return limited(reading, shader, name)
    except UnreadableError as error:
        reading.doubts.setdefault(str(error), "the plain value of its socket is used")
        return reading.constant(shader.socket(name))


#: channel -> what a leaf shader supplies; for the opacity, what it transmits
_LEAVES = {"color": _color, "opacity": _let_through, "emission": _emission}
