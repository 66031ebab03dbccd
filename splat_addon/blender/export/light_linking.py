# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts Blender's light linking to sets of objects with the same lights: `Instance.light_set`, `Light.receivers`."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import bpy

from ...rendering.scene.light import MAX_LIGHT_SETS


class LinkedReceivers(NamedTuple):
    """included: the objects that a light lights, or None for all. excluded: the objects that it does not light. Each is
    known by its session_uid, as objects of several libraries may have the same name."""

    included: frozenset[int] | None
    excluded: frozenset[int]

    def has(self, objects: tuple[int, ...]) -> bool:
        """Whether the light reaches an instance. objects: session_uids of the object, and of the objects that make the
        instance."""
        if self.excluded.intersection(objects):
            return False
        return self.included is None or bool(self.included.intersection(objects))


EVERYTHING = LinkedReceivers(None, frozenset())


def receivers_of(light: bpy.types.Object) -> LinkedReceivers:
    """The receivers from a light object's receiver collection; an empty collection has no effect."""
    collection = light.light_linking.receiver_collection if light.light_linking else None
    if collection is None:
        return EVERYTHING
    states: dict[str, set[int]] = {"INCLUDE": set(), "EXCLUDE": set()}
    for object_, member in zip(collection.objects, collection.collection_objects, strict=True):
        states[member.light_linking.link_state].add(object_.session_uid)
    for child, member in zip(collection.children, collection.collection_children, strict=True):
        states[member.light_linking.link_state].update(o.session_uid for o in child.all_objects)
    return LinkedReceivers(frozenset(states["INCLUDE"]) or None, frozenset(states["EXCLUDE"]))


class LightSets:
    """Numbers the sets of lights that objects receive, limited to what the renderer can distinguish."""

    def __init__(self, lights: Iterable[bpy.types.Object], notes):
        self._receivers = [receivers_of(light) for light in lights]
        self._numbers: dict[tuple[bool, ...], int] = {}
        self._notes = notes

    def of_instance(self, entry: bpy.types.DepsgraphObjectInstance) -> int:
        """The set number for an entry of the depsgraph."""
        makers = (entry.object, entry.parent) if entry.is_instance else (entry.object,)
        objects = tuple(each.original.session_uid for each in makers)
        lit_by = tuple(receivers.has(objects) for receivers in self._receivers)
        if lit_by not in self._numbers and len(self._numbers) == MAX_LIGHT_SETS:
            self._notes.add(
                f"Light linking uses more than {MAX_LIGHT_SETS} different sets of objects; the further ones are lit "
                "like the first"
            )
            return 0
        return self._numbers.setdefault(lit_by, len(self._numbers))

    def lit_by(self, light: int) -> tuple[int, ...] | None:
        """Numbers of the sets that the light with this index lights; None for all."""
        lit = tuple(number for lit_by, number in self._numbers.items() if lit_by[light])
        return None if len(lit) == len(self._numbers) else lit
