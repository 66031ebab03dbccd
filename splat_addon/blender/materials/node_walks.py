# SPDX-License-Identifier: GPL-3.0-or-later
"""Walks up a node tree from a socket: through links, reroutes, groups and muted nodes.

What a node's output is read as, is the matter of whoever walks: `node_products` or `graphs`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import bpy

from .node_trees import called
from .texture_images import UnreadableError

Socket = bpy.types.NodeSocket
Node = bpy.types.Node

#: Maximum length of a chain of nodes: far more than anyone uses, and within Python's own limit.
MAX_CHAIN = 100


class Walk:
    """One walk up a node tree. groups: the group nodes around its start, the innermost last.

    The output of each node is read once, however many sockets it feeds: in a chain of nodes that use their predecessor
    twice, the number of paths doubles with each node. The contents of a group are read once for each of its users.
    """

    def __init__(self, groups: tuple[Node, ...] = ()):
        self._read: dict[tuple, Any] = {}
        self._followed: list[tuple] = []
        self._groups: list[Node] = list(groups)

    def constant(self, socket: Socket) -> Any:
        """The own value of a socket."""
        raise NotImplementedError

    def arrived(self, read: Any, socket: Socket) -> Any:
        """What was read of an output, as a socket that it feeds takes it."""
        raise NotImplementedError

    def reader(self, node: Node, output: str) -> Callable[[], Any] | None:
        """The function that reads the output of a node; None if there is none."""
        raise NotImplementedError

    def read(self, socket: Socket) -> Any:
        """What feeds a socket. Raises UnreadableError."""
        source = linked(socket)
        if source is None:
            return self.constant(socket)
        key = (*source, *self._groups)
        if key not in self._read:
            self._read[key] = self.output(source, key)
        return self.arrived(self._read[key], socket)

    def output(self, source: tuple[Node, str], key: tuple) -> Any:
        """What the output of a node is read as."""
        node, output = source
        reader = self._way(node, output)
        if reader is None:
            raise UnreadableError(called(node))
        if key in self._followed:
            raise UnreadableError(f"{called(node)} in a ring of nodes")
        if len(self._followed) == MAX_CHAIN:
            raise UnreadableError(f"a chain of more than {MAX_CHAIN} nodes")
        self._followed.append(key)
        try:
            return reader()
        finally:
            self._followed.pop()

    def _way(self, node: Node, output: str) -> Callable[[], Any] | None:
        if node.mute:
            return self._passed_through(node, output)
        if node.bl_idname == "ShaderNodeGroup" and node.node_tree is not None:
            return lambda: self._inside(node, output)
        if node.bl_idname == "NodeGroupInput" and self._groups:
            return lambda: self._outside(output)
        return self.reader(node, output)

    def _passed_through(self, node: Node, output: str) -> Callable[[], Any] | None:
        """A muted node passes on the input that Blender links to that output internally; None if it links none."""
        links = (link for link in node.internal_links if link.to_socket.identifier == output)
        found = next(links, None)
        return found and (lambda: self.read(found.from_socket))

    def _inside(self, group: Node, output: str) -> Any:
        """The output of a group."""
        inner = within(group, output)
        if inner is None:
            raise UnreadableError(f"the group {group.node_tree.name!r}, which has no output")
        self._groups.append(group)
        try:
            return self.read(inner)
        finally:
            self._groups.pop()

    def _outside(self, output: str) -> Any:
        """The input of the innermost group."""
        group = self._groups.pop()
        try:
            return self.read(input_of(group, output))
        finally:
            self._groups.append(group)


def outer(socket: Socket, groups: tuple[Node, ...]) -> tuple[Socket, tuple[Node, ...]]:
    """The socket that supplies the value of one inside groups: that of a group's node where the group passes it in.
    Also the groups around that socket."""
    while groups and (source := linked(socket)) and source[0].bl_idname == "NodeGroupInput":
        socket, groups = input_of(groups[-1], source[1]), groups[:-1]
    return socket, groups


def within(group: Node, output: str) -> Socket | None:
    """The socket inside a group that supplies one of its outputs; None if the group has no output node."""
    ends = (n for n in group.node_tree.nodes if n.bl_idname == "NodeGroupOutput" and n.is_active_output)
    end = next(ends, None)
    return end and input_of(end, output)


def passed_through_link(node: Node) -> bpy.types.NodeLink | None:
    """The link inside a muted shader, from one of its inputs to its output."""
    return next((link for link in node.internal_links if link.to_socket == node.outputs[0]), None)


def linked(socket: Socket) -> tuple[Node, str] | None:
    """The node that feeds a socket, skipping reroutes, and the identifier of its output; None if there is none, or if
    reroutes form a ring."""
    passed = set()
    while socket.links and not socket.links[0].is_muted:
        link = socket.links[0]
        if link.from_node.bl_idname != "NodeReroute":
            return link.from_node, link.from_socket.identifier
        if link.from_node in passed:
            return None
        passed.add(link.from_node)
        socket = link.from_node.inputs[0]
    return None


def has_volume(tree: bpy.types.NodeTree | None) -> bool:
    """Whether something is linked to the volume of a tree's output, which of a light has none."""
    output = tree.get_output_node("ALL") if tree else None
    socket = output.inputs.get("Volume") if output else None
    return socket is not None and linked(socket) is not None


def input_of(node: Node, identifier: str) -> Socket:
    """The input of a node with that identifier."""
    return next(socket for socket in node.inputs if socket.identifier == identifier)
