# SPDX-License-Identifier: GPL-3.0-or-later
"""Says where Geometry Nodes take the source of new surfels: copies that they place are still the mesh."""

from __future__ import annotations

import bpy

from ..geometry.node_groups import taken_by


def sentences_about(source: bpy.types.Object, made: bpy.types.Object, scene: bpy.types.Scene) -> list[str]:
    """What to do where Geometry Nodes in the scene take the source of the new surfels `made`."""
    names = [repr(each.name) for each in scene.objects if each != made and _takes(each, source)]
    if not names:
        return []
    more = f" and {len(names) - 1} more" if len(names) > 1 else ""
    return [
        f"The Geometry Nodes of {names[0]}{more} still take the mesh of {source.name!r}; choose {made.name!r} there if "
        "they place copies"
    ]


def _takes(owner: bpy.types.Object, source: bpy.types.Object) -> bool:
    return any(source in taken_by(modifier) for modifier in owner.modifiers if modifier.type == "NODES")
