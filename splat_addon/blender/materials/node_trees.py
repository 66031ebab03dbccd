# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether a material, a world or a light is described by its nodes, and what a node is called in a sentence.

Blender 4.5 has a switch for it. From 5.0 on, materials and worlds always use their nodes, later lights too; the switch
is then deprecated, and Blender 6 is to drop it. What Blender says of the property decides, not its version.
"""

from __future__ import annotations

import bpy

Owner = bpy.types.Material | bpy.types.World | bpy.types.Light


def has_switch(owner: Owner) -> bool:
    """Whether the use of nodes can be switched off in this Blender."""
    switch = owner.bl_rna.properties.get("use_nodes")
    return switch is not None and not getattr(switch, "is_deprecated", False)


def uses_nodes(owner: Owner) -> bool:
    """Whether the owner's node tree describes it."""
    return owner.node_tree is not None and (not has_switch(owner) or owner.use_nodes)


def called(node: bpy.types.Node) -> str:
    """A node in a sentence: "a Mix node", "an Object Info node", "a muted Object Info node"."""
    name = f"{'muted ' if node.mute else ''}{node.bl_label} node"
    return f"{'an' if name[0] in _VOWELS else 'a'} {name}"


_VOWELS = "AEIO"
