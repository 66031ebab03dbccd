# SPDX-License-Identifier: GPL-3.0-or-later
"""Turns mixed and added shaders, and those without a diffuse colour such as Glass, into colours that Cycles can bake.

A tree of shaders becomes a tree of colours of the same shape, once for each channel of surfels: Mix Shader mixes them,
Add Shader adds them, and each leaf shader supplies its own (`mixed_leaves`). Opacity is 1 minus the transmitted share.
"""

from __future__ import annotations

from itertools import takewhile
from typing import NamedTuple

import bpy

from .graphs.channels import mix_factor
from .mixed_leaves import LEAVES
from .node_walks import input_of, linked, within
from .surface_shaders import CLEAR, Shader, folded, parts

Node = bpy.types.Node
Tree = bpy.types.NodeTree
Socket = bpy.types.NodeSocket
#: A socket, or a constant colour.
Given = Socket | tuple[float, float, float]

_BLACK, _WHITE = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)


def channels(shader: Shader) -> list[str]:
    """The channels of a surface to bake for a tree of shaders."""
    ends = [part.shader.node for part in parts(shader, mix_factor)]
    kinds = [end.type for end in ends]
    emits = any(end.type == "EMISSION" or _emits(end) for end in ends)
    is_clear = any(kind in CLEAR or kind == "BSDF_PRINCIPLED" for kind in kinds)
    return ["color", *["opacity"] * is_clear, *["emission"] * emits]


def _emits(end: Node) -> bool:
    strength = end.inputs.get("Emission Strength")
    return strength is not None and (strength.is_linked or strength.default_value != 0)


def emitted(shader: Shader, channel: str) -> Socket:
    """The output of new nodes for one channel of a tree of shaders, beside the last of these; colours are weighted by
    coverage. The groups among them must belong to their nodes alone."""
    tree = shader.node.id_data
    found = folded(shader, lambda leaf: LEAVES[channel](_Sockets(leaf.node.id_data, leaf.node)), _joined, _BLACK)
    if channel == "opacity":
        found = _mixed(tree, "SUBTRACT", _WHITE, found)
    return found if isinstance(found, Socket) else _mixed(tree, "ADD", found, _BLACK)


def _joined(shader: Shader, fed: list[tuple[Shader | None, Given]]) -> Given:
    parts = [_moved(value, each, shader) for each, value in fed]
    if len(parts) < 2:
        return parts[0] if parts else _BLACK
    node, tree = shader.node, shader.node.id_data
    return _mixed(tree, "ADD", *parts) if node.type == "ADD_SHADER" else _mixed(tree, "MIX", *parts, node.inputs[0])


def _moved(value: Given, start: Shader | None, end: Shader) -> Given:
    """A value beside one shader, beside another, out of groups and into others."""
    if start is None or not isinstance(value, Socket):
        return value
    inner, outer = start.groups, end.groups
    shared = sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(inner, outer, strict=False)))
    for group in reversed(inner[shared:]):
        added = group.node_tree.interface.new_socket("channel", in_out="OUTPUT", socket_type="NodeSocketColor")
        group.node_tree.links.new(value, within(group, added.identifier))
        value = next(socket for socket in group.outputs if socket.identifier == added.identifier)
    for group in outer[shared:]:
        added = group.node_tree.interface.new_socket("channel", in_out="INPUT", socket_type="NodeSocketColor")
        group.id_data.links.new(value, input_of(group, added.identifier))
        inside = group.node_tree.nodes.new("NodeGroupInput")
        value = next(socket for socket in inside.outputs if socket.identifier == added.identifier)
    return value


class _Sockets(NamedTuple):
    """`mixed_leaves.Terms` of a shader as sockets of new nodes."""

    tree: Tree
    node: Node
    black: Given = _BLACK
    white: Given = _WHITE
    grey: Given = (0.8, 0.8, 0.8)

    def read(self, name: str) -> Given:
        return _given(self.node.inputs[name])

    def product(self, a: Given, b: Given) -> Given:
        return _mixed(self.tree, "MULTIPLY", a, b)

    def rest(self, share: Given) -> Given:
        return _mixed(self.tree, "SUBTRACT", _WHITE, share)


def _given(socket: Socket) -> Given:
    """The link that feeds a socket, or its own value as a colour."""
    if linked(socket) is not None:
        return socket.links[0].from_socket
    value = socket.default_value
    return (value,) * 3 if isinstance(value, float) else tuple(value[:3])


def _mixed(tree: Tree, how: str, a: Given, b: Given, factor: Socket | None = None) -> Socket:
    """The colour of a new Mix node."""
    node = tree.nodes.new("ShaderNodeMix")
    node.data_type, node.blend_type, node.clamp_factor, node.clamp_result = "RGBA", how, True, False
    sockets = {socket.identifier: socket for socket in node.inputs}
    sockets["Factor_Float"].default_value = 1.0
    for name, given in (("A_Color", a), ("B_Color", b)):
        if isinstance(given, bpy.types.NodeSocket):
            tree.links.new(given, sockets[name])
        else:
            sockets[name].default_value = (*given, 1.0)
    if factor is not None:
        if linked(factor) is not None:
            tree.links.new(factor.links[0].from_socket, sockets["Factor_Float"])
        else:
            sockets["Factor_Float"].default_value = factor.default_value
    return next(socket for socket in node.outputs if socket.identifier == "Result_Color")
