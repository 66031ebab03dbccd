# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds what changes from frame to frame: animated properties, and objects that move."""

from __future__ import annotations

from collections.abc import Iterator

import bpy

#: How the data paths begin that move an object, or the bones that its children follow.
_PLACE = ("location", "rotation", "scale", "delta_", "pose")


def animated_paths(owner: bpy.types.ID) -> Iterator[str]:
    """The data paths of an object's or data-block's properties that have keyframes or drivers, also of the NLA; what
    is muted does not count, nor what an action that several use has for the others."""
    animation = owner.animation_data
    if animation is None:
        return
    yield from (driver.data_path for driver in animation.drivers if not driver.mute)
    strips = (strip for track in animation.nla_tracks if not track.mute for strip in track.strips if not strip.mute)
    for user in (animation, *strips):
        parts = (part for layer in user.action.layers for part in layer.strips) if user.action else ()
        for bag in (bag for part in parts for bag in part.channelbags if bag.slot_handle == user.action_slot_handle):
            yield from (curve.data_path for curve in bag.fcurves if not curve.mute)


def is_moving(source: bpy.types.Object | None) -> bool:
    """Whether an object or one of its parents has animation, drivers, constraints or a rigid body."""
    return any(is_animated(each) or _is_carried(each) for each in _with_parents(source))


def moves_against(one: bpy.types.Object, other: bpy.types.Object) -> bool:
    """Whether one of two objects moves without the other; a common parent moves both."""
    return any(map(_has_movement, _with_parents(one) ^ _with_parents(other)))


def is_animated(owner: bpy.types.ID | None) -> bool:
    """Whether a data-block has animation or drivers."""
    animation = getattr(owner, "animation_data", None)
    return animation is not None and bool(animation.action or animation.drivers or animation.nla_tracks)


def _has_movement(source: bpy.types.Object) -> bool:
    return _is_carried(source) or any(path.startswith(_PLACE) for path in animated_paths(source))


def _is_carried(source: bpy.types.Object) -> bool:
    return len(source.constraints) > 0 or source.rigid_body is not None


def _with_parents(source: bpy.types.Object | None) -> set[bpy.types.Object]:
    found = set()
    while source is not None:
        found.add(source)
        source = source.parent
    return found
