# SPDX-License-Identifier: GPL-3.0-or-later
"""Modifiers' node groups that the extension makes: one of a make in a file, known by a custom property."""

from __future__ import annotations

import bpy


def known_group(make: str, version: int) -> bpy.types.NodeTree | None:
    """The file's own group of a make; not one that is linked from another file, which may go with that."""
    known = (group for group in bpy.data.node_groups if group.get(make) == version and group.library is None)
    return next(known, None)


def new_modifier_group(name: str, make: str, version: int) -> bpy.types.NodeTree:
    """A group that takes a geometry and gives one."""
    group = bpy.data.node_groups.new(name, "GeometryNodeTree")
    group[make] = version
    group.is_modifier = True
    for way in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    return group
