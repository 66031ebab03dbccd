# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the objects whose Geometry Nodes take another object, such as copies that an Object Info node places: when that
object is converted, its nodes still have the mesh."""

from __future__ import annotations

import bpy

from ..geometry.node_groups import input_of


def takers_of(taken: bpy.types.Object, scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """The objects in a scene whose Geometry Nodes take this one, from a node's input or from the modifier's."""
    groups: dict[bpy.types.NodeTree, bool] = {}
    return [
        each for each in scene.objects if any(_takes(m, taken, groups) for m in each.modifiers if m.type == "NODES")
    ]


def sentences_about(source: bpy.types.Object, made: bpy.types.Object, scene: bpy.types.Scene) -> list[str]:
    """What to do where Geometry Nodes take the source of the new surfels `made`."""
    names = [repr(taker.name) for taker in takers_of(source, scene) if taker != made]
    if not names:
        return []
    more = f" and {len(names) - 1} more" if len(names) > 1 else ""
    return [
        f"The Geometry Nodes of {names[0]}{more} still take the mesh of {source.name!r}; choose {made.name!r} there if "
        "they place copies"
    ]


def _takes(modifier: bpy.types.NodesModifier, taken: bpy.types.Object, groups: dict) -> bool:
    tree = modifier.node_group
    if tree is None:
        return False
    inputs = (item for item in tree.interface.items_tree if item.item_type == "SOCKET" and item.in_out == "INPUT")
    objects = (item.identifier for item in inputs if item.socket_type == "NodeSocketObject")
    return any(input_of(modifier, identifier) == taken for identifier in objects) or _reads(tree, taken, groups)


def _reads(tree: bpy.types.NodeTree, taken: bpy.types.Object, groups: dict) -> bool:
    """Whether a tree, or a group in it, has the object in an input of a node. groups: what is known of others."""
    if tree not in groups:
        groups[tree] = False
        sockets = (socket for node in tree.nodes for socket in node.inputs if socket.type == "OBJECT")
        inner = (node.node_tree for node in tree.nodes if node.type == "GROUP" and node.node_tree is not None)
        has = any(not socket.is_linked and socket.default_value == taken for socket in sockets)
        groups[tree] = has or any(_reads(group, taken, groups) for group in inner)
    return groups[tree]
