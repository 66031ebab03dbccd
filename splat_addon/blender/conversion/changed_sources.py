# SPDX-License-Identifier: GPL-3.0-or-later
"""Says which surfels do not follow what became of their sources since the conversion."""

from __future__ import annotations

from collections.abc import Collection

import bpy

from ..geometry.sources import has_surfaces
from .following import follows
from .shape_following import INSTEAD, is_bent, not_bent
from .source_record import SurfelSource, record_of
from .source_shape import is_same, shape_of


class ChangedSources:
    """Keeps its sentences while nothing changes that they depend on, because large sources take a while to compare."""

    def __init__(self):
        self._kept: tuple[tuple, list[str]] | None = None

    def begin_frame(self, is_changed: bool) -> None:
        """Start a frame. is_changed: objects may have another shape than in the last one."""
        if is_changed:
            self._kept = None

    def sentences(self, made: Collection[bpy.types.Object], depsgraph: bpy.types.Depsgraph) -> list[str]:
        """What to say about surfel objects in the file."""
        key = depsgraph.scene.frame_current_final, *sorted(each.session_uid for each in made)
        if self._kept is None or self._kept[0] != key:
            self._kept = key, _sentences(made, depsgraph)
        return self._kept[1]


def remember_shapes(made: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> None:
    """Record the shapes of the sources of new surfels; of a source that they are bound to, that is done already."""
    if not is_bent(made):
        for entry in record_of(made).sources:
            entry.shape = _shape(entry, made, depsgraph) if entry.object else ""


def _shape(entry: SurfelSource, made: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> str:
    first = record_of(made).sources[0].object
    return shape_of(entry.object, depsgraph, None if entry.object == first else first)


def _sentences(made: Collection[bpy.types.Object], depsgraph: bpy.types.Depsgraph) -> list[str]:
    said, changed, replaced = [], [], []
    for each in made:
        if sentence := not_bent(each, depsgraph):
            said.append(sentence)
        elif _has_changed(each, depsgraph):
            changed.append(each.name)
        replaced += [entry.name for entry in record_of(each).sources if _is_replaced(entry, each, depsgraph)]
    if changed:
        said.append(
            f"The surfels {_first_of(changed)} show a shape that their source no longer has: update them, or {INSTEAD}"
        )
    if replaced:
        said.append(
            f"The source {_first_of(replaced)} was deleted, and another object of its name is drawn beside its "
            "surfels: delete those, and convert the new one"
        )
    return sorted(said)


def _has_changed(made: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> bool:
    """Whether a source of surfels that follow it, and are not bound to it, has another shape than it had."""
    entries = [entry for entry in record_of(made).sources if entry.object is not None]
    if not entries or is_bent(made) or not follows(made, entries[0].object):
        return False
    known = (entry for entry in entries if entry.shape and entry.object.mode == "OBJECT")
    return any(not is_same(entry.shape, _shape(entry, made, depsgraph)) for entry in known)


def _is_replaced(entry: SurfelSource, made: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> bool:
    other = depsgraph.scene.original.objects.get(entry.name) if entry.object is None and entry.name else None
    return other is not None and other != made and has_surfaces(other) and not other.hide_render


def _first_of(names: list[str]) -> str:
    first, *others = sorted(set(names))
    return f"{first!r} and {len(others):,} more" if others else repr(first)
