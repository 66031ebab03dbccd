# SPDX-License-Identifier: GPL-3.0-or-later
"""What all instances of an object have in common, whatever they consist of."""

from __future__ import annotations

from typing import NamedTuple

import bpy

from ..geometry.sources import may_change, owner_of
from .light_linking import LightSets


class RayVisibility(NamedTuple):
    """Whether the camera, reflections and lights see something: Blender's Ray Visibility."""

    is_seen: bool
    is_reflected: bool
    casts_shadow: bool


class Traits(NamedTuple):
    """Fields of `rendering.scene.Placed`."""

    name: str
    index: int
    light_set: int
    is_seen: bool
    is_reflected: bool
    casts_shadow: bool
    may_change: bool
    is_holdout: bool


def ray_visibility(entry: bpy.types.DepsgraphObjectInstance, depsgraph: bpy.types.Depsgraph) -> RayVisibility:
    """The visibility of an entry, which its own object and the one that makes it may limit."""
    object_, owner = entry.object, owner_of(entry)
    is_indirect = owner.indirect_only_get(view_layer=depsgraph.view_layer)
    return RayVisibility(
        is_seen=object_.visible_camera and owner.visible_camera and not is_indirect,
        is_reflected=object_.visible_glossy and owner.visible_glossy,
        casts_shadow=object_.visible_shadow,
    )


def traits_of(
    entry: bpy.types.DepsgraphObjectInstance, depsgraph: bpy.types.Depsgraph, light_sets: LightSets
) -> Traits:
    """The traits of an entry's instances."""
    return Traits(
        name=entry.object.name,
        index=entry.object.pass_index,
        light_set=light_sets.of_instance(entry),
        **ray_visibility(entry, depsgraph)._asdict(),
        may_change=may_change(entry),
        is_holdout=owner_of(entry).holdout_get(view_layer=depsgraph.view_layer),
    )
