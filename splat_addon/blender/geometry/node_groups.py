# SPDX-License-Identifier: GPL-3.0-or-later
"""Node groups for modifiers that the extension adds.

A file has at most one of each kind, marked by a custom property.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import bpy

Taken = bpy.types.Object | bpy.types.Collection


def known_group(make: str, version: int) -> bpy.types.NodeTree | None:
    """The file's own group of a kind. Groups linked from another file do not count, because the link may disappear."""
    known = (group for group in bpy.data.node_groups if group.get(make) == version and group.library is None)
    return next(known, None)


def uses_group(modifier: bpy.types.Modifier, make: str) -> bool:
    """Whether a modifier has a group of a kind, of any version."""
    return modifier.type == "NODES" and modifier.node_group is not None and make in modifier.node_group


def input_of(modifier: bpy.types.NodesModifier, identifier: str):
    """The value of an input of the modifier's node group; Blender 5.2 keeps them elsewhere."""
    if hasattr(modifier, "properties"):
        return getattr(modifier.properties.inputs, identifier).value
    return modifier.get(identifier)


def identifier_of(modifier: bpy.types.NodesModifier, name: str) -> str:
    """The identifier of an input of the modifier's node group."""
    items = modifier.node_group.interface.items_tree
    return next(item.identifier for item in items if item.name == name and item.in_out == "INPUT")


def give(modifier: bpy.types.NodesModifier, name: str, value) -> None:
    """Set an input of the modifier's node group."""
    identifier = identifier_of(modifier, name)
    if hasattr(modifier, "properties"):
        getattr(modifier.properties.inputs, identifier).value = value
    else:
        modifier[identifier] = value


def nodes_in(tree: bpy.types.NodeTree, seen: set | None = None) -> Iterator[bpy.types.Node]:
    """The nodes of a tree and of the groups in it, each group once. seen: trees that are left out."""
    seen = set() if seen is None else seen
    seen.add(tree)
    for node in tree.nodes:
        yield node
        inner = node.node_tree if node.type == "GROUP" else None
        if inner is not None and inner not in seen:
            yield from nodes_in(inner, seen)


def taken_inside(tree: bpy.types.NodeTree) -> list[Taken]:
    """The objects and collections that inputs of a tree's nodes have, groups included."""
    sockets = (socket for node in nodes_in(tree) for socket in node.inputs if socket.type in ("OBJECT", "COLLECTION"))
    return [socket.default_value for socket in sockets if not socket.is_linked and socket.default_value is not None]


def taken_by(modifier: bpy.types.NodesModifier, inside: Callable[..., list[Taken]] = taken_inside) -> list[Taken]:
    """The objects and collections that Geometry Nodes take, from inputs of their nodes or of the modifier. inside:
    `taken_inside`, which may remember trees."""
    tree = modifier.node_group
    if tree is None:
        return []
    inputs = (item for item in tree.interface.items_tree if item.item_type == "SOCKET" and item.in_out == "INPUT")
    named = (item.identifier for item in inputs if item.socket_type in ("NodeSocketObject", "NodeSocketCollection"))
    given = (input_of(modifier, name) for name in named)
    return [*inside(tree), *(taken for taken in given if taken is not None)]


def new_modifier_group(name: str, make: str, version: int) -> bpy.types.NodeTree:
    """A new group with a geometry input and a geometry output."""
    group = bpy.data.node_groups.new(name, "GeometryNodeTree")
    group[make] = version
    group.is_modifier = True
    for way in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    return group
