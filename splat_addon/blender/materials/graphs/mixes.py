# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a tree of mixed and added shaders as graphs of its colour, opacity and emission.

Mix Shader mixes by its factor, Add Shader adds, and each leaf supplies its own (`mixed_leaves`). `shader_mixes` makes
nodes of the same walk (`folded`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import bpy

from ..mesh_layers import MeshLayers
from ..mixed_leaves import LEAVES
from ..surface_shaders import Shader, folded
from ..texture_images import UnreadableError
from .channels import ReadGraph, limited
from .reading import GraphReading, Value

_ZERO, _ONE = Value((0.0,)), Value((1.0,))

#: Reads something of a shader.
Leaf = Callable[[GraphReading, Shader], Value]


def read_mixed(shader: Shader, name: str, layers: MeshLayers) -> ReadGraph:
    """The colour, opacity or emission of a tree of shaders."""
    reading = GraphReading(layers)
    through = combined(reading, shader, _leaf("opacity"))
    opacity = reading.add("clamp", reading.add("invert", _ONE, through), _ZERO, _ONE, settings=(False,))
    if name == "opacity":
        return ReadGraph(*reading.graph(opacity), reading.doubts, reading.asks_owner)
    total = reading.three(combined(reading, shader, _leaf(name)), True)
    shown = reading.color("divided", total, opacity)
    return ReadGraph(*reading.graph(shown), reading.doubts, reading.asks_owner)


def _leaf(name: str) -> Leaf:
    """One channel of a shader that mixes no others; of the opacity, what is let through."""
    return lambda reading, shader: LEAVES[name](_Steps(reading, shader))


def _factor(reading: GraphReading, mix: Shader) -> Value:
    return reading.read(mix.node.inputs[0])


def combined(reading: GraphReading, shader: Shader | None, leaf: Leaf, factor: Leaf = _factor) -> Value:
    """What a tree of shaders comes to. leaf: of a shader that mixes no others; factor: of a Mix Shader. Both are called
    with a reading inside the shader's groups. A ring of shaders ends at black."""

    def joined(shader: Shader, fed: list[tuple[Shader | None, Value]]) -> Value:
        parts = [value for _, value in fed]
        if len(parts) < 2:
            return parts[0] if parts else _ZERO
        width = max(part.width for part in parts)
        if width == 3:
            parts = [reading.three(part, True) for part in parts]
        if shader.node.type == "ADD_SHADER":
            share, parts = Value((0.5,)), [reading.add("multiplied", Value((2.0,)), p, width=width) for p in parts]
        else:
            share = factor(reading.inside(shader.groups), shader)
        return reading.add("mixed", share, *parts, settings=(True,), width=width, is_color=width == 3)

    return folded(shader, lambda shader: leaf(reading.inside(shader.groups), shader), joined, _ZERO)


@dataclass(frozen=True)
class _Steps:
    """`mixed_leaves.Terms` of a shader as steps of a graph."""

    reading: GraphReading
    shader: Shader
    black: ClassVar[Value] = _ZERO
    white: ClassVar[Value] = _ONE
    grey: ClassVar[Value] = Value((0.8,))

    @property
    def node(self) -> bpy.types.Node:
        return self.shader.node

    def read(self, name: str) -> Value:
        """An input, or the plain value of its socket if nothing of it can be read. Raises UnreadableError for what
        covers, because that decides what is seen."""
        try:
            return limited(self.reading, self.shader, name)
        except UnreadableError as error:
            if name == "Alpha":
                raise
            self.reading.doubts.setdefault(str(error), "the plain value of its socket is used")
            return self.reading.constant(self.shader.socket(name))

    def product(self, a: Value, b: Value) -> Value:
        return self.reading.color("multiplied", self.reading.three(a, True), b)

    def rest(self, share: Value) -> Value:
        return self.reading.add("invert", _ONE, share)
