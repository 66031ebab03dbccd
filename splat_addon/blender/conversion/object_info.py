# SPDX-License-Identifier: GPL-3.0-or-later
"""Says where Geometry Nodes take the source of new surfels: copies that they place are still the mesh."""

from __future__ import annotations

from functools import cache

import bpy

from ..geometry.node_groups import taken_by, taken_inside
from .source_record import sources_of


def sentences_about(source: bpy.types.Object, made: bpy.types.Object, scene: bpy.types.Scene) -> list[str]:
    """What to do where Geometry Nodes in the scene take the source of the new surfels `made`; those of surfel objects
    bend surfels with it."""
    inside = cache(taken_inside)  # many objects may have the same nodes

    def takes(owner: bpy.types.Object) -> bool:
        return any(source in taken_by(modifier, inside) for modifier in owner.modifiers if modifier.type == "NODES")

    names = [repr(each.name) for each in scene.objects if takes(each) and not sources_of(each)]
    if not names:
        return []
    more = f" and {len(names) - 1} more" if len(names) > 1 else ""
    return [
        f"The Geometry Nodes of {names[0]}{more} still take the mesh of {source.name!r}; choose {made.name!r} there if "
        "they place copies"
    ]
