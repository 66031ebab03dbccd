# SPDX-License-Identifier: GPL-3.0-or-later
"""Turns mixed and added shaders, and those without a diffuse colour such as Glass, into colours that Cycles can bake.

A tree of shaders becomes a tree of colours of the same shape, once for each channel of surfels: Mix Shader mixes them,
Add Shader adds them, and each leaf shader supplies its own (`mixed_leaves`). Opacity is 1 minus the transmitted share.
"""

from __future__ import annotations

from typing import NamedTuple

import bpy

from .graphs.channels import mix_factor
from .mixed_leaves import LEAVES
from .node_walks import linked, passed_through_link, within
from .surface_shaders import CLEAR, Shader, parts

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


def emitted(tree: Tree, shader: Node, channel: str) -> Socket:
    """The output of new nodes for one channel of a tree of shaders; colours are weighted by coverage."""
    found = _combined(tree, shader, channel, {})
    if channel == "opacity":
        found = _mixed(tree, "SUBTRACT", _WHITE, found)
    return found if isinstance(found, Socket) else _mixed(tree, "ADD", found, _BLACK)


def _combined(tree: Tree, shader: Node | None, channel: str, made: dict[Node, Given]) -> Given:
    """What one channel of a tree of shaders is. made: the same for those that were reached already, which is added to;
    a ring of shaders ends at black."""
    if shader is None:
        return _BLACK
    if shader not in made:
        made[shader] = _BLACK
        made[shader] = _of_one(tree, shader, channel, made)
    return made[shader]


def _of_one(tree: Tree, shader: Node, channel: str, made: dict[Node, Given]) -> Given:
    if shader.mute:
        link = passed_through_link(shader)
        return _combined(tree, _source(link.from_socket) if link else None, channel, made)
    if shader.type == "GROUP" and shader.node_tree is not None:
        return _out_of_group(shader, channel, made)
    if shader.type in ("MIX_SHADER", "ADD_SHADER"):
        first, second = (_combined(tree, _source(s), channel, made) for s in shader.inputs if s.type == "SHADER")
        if shader.type == "ADD_SHADER":
            return _mixed(tree, "ADD", first, second)
        return _mixed(tree, "MIX", first, second, shader.inputs[0])
    return LEAVES[channel](_Sockets(tree, shader))


def _out_of_group(group: Node, channel: str, made: dict[Node, Given]) -> Given:
    """A new output of a group, which belongs to this node alone, for its first shader."""
    shader = next(socket for socket in group.outputs if socket.type == "SHADER")
    inner = within(group, shader.identifier)
    if inner is None:
        return _BLACK
    tree = group.node_tree
    found = _combined(tree, _source(inner), channel, made)
    if not isinstance(found, Socket):
        return found
    added = tree.interface.new_socket(channel, in_out="OUTPUT", socket_type="NodeSocketColor")
    tree.links.new(found, within(group, added.identifier))
    return next(socket for socket in group.outputs if socket.identifier == added.identifier)


def _source(socket: Socket) -> Node | None:
    source = linked(socket)
    return source and source[0]


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
