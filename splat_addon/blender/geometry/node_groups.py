# SPDX-License-Identifier: GPL-3.0-or-later
"""Node groups for modifiers that the extension adds.

A file has at most one of each kind, marked by a custom property.
"""

from __future__ import annotations

import bpy


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


def new_modifier_group(name: str, make: str, version: int) -> bpy.types.NodeTree:
    """A new group with a geometry input and a geometry output."""
    group = bpy.data.node_groups.new(name, "GeometryNodeTree")
    group[make] = version
    group.is_modifier = True
    for way in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    return group
