# SPDX-License-Identifier: GPL-3.0-or-later
"""The surfaces of glass, through which light is followed, and scenes without them."""

from __future__ import annotations

from dataclasses import replace
from weakref import WeakKeyDictionary

import numpy as np

from ..scene import Placed, Scene
from ..scene.glass_surfaces import GlassSurfaces
from ..scene.material import Material
from ..scene.placements import Placements
from ..scene.table import InstanceTable


def is_glass(material: Material) -> bool:
    """Whether it lets light through as glass does."""
    return material.finish.transmission > 0 and material.metallic < 1


def has_glass(placed: Placed) -> bool:
    """Whether any of an object's materials is glass."""
    return not placed.is_holdout and any(map(is_glass, placed.materials))


def _shows_glass(placed: Placed) -> bool:
    return placed.is_seen and has_glass(placed)


def glass_slots(placed: Placed) -> np.ndarray:
    """(n,) bool: which surfels or corners of an object are of glass."""
    slots = np.array([is_glass(material) for material in placed.materials])
    return slots[np.minimum(placed.shape.materials, len(slots) - 1)]


class GlassApart:
    """Scenes whose glass is apart from the rest, as are the parts of shapes that are glass. They are kept."""

    def __init__(self):
        self._shapes: WeakKeyDictionary = WeakKeyDictionary()
        self._scenes: WeakKeyDictionary = WeakKeyDictionary()

    def without(self, scene: Scene) -> Scene:
        """The scene in which glass only casts its shadow: the same object if it has none."""
        return self._made(scene, is_seen=False)

    def without_shadows(self, scene: Scene) -> Scene:
        """The scene in which glass casts none: the same object if it has none."""
        return self._made(scene, casts_shadow=False)

    def _made(self, scene: Scene, **changes: bool) -> Scene:
        if not any(_shows_glass(kind.placed) for kind in scene.table.kinds):
            return scene
        known, key = self._scenes.setdefault(scene, {}), tuple(changes)
        if key not in known:
            known[key] = replace(
                scene, surfels=self._parted(scene.surfels, changes), polygons=self._parted(scene.polygons, changes)
            )
        return known[key]

    def _parted(self, placed: Placements, changes: dict[str, bool]) -> Placements | tuple[Placed, ...]:
        are_mixed = any(_shows_glass(one) and isinstance(self._parts(one), tuple) for one in placed.different)
        if not are_mixed:
            return placed.changed(
                lambda one: replace(one, **changes) if _shows_glass(one) and self._parts(one) else one
            )
        made = []
        for one in placed:
            parts = _shows_glass(one) and self._parts(one)
            if isinstance(parts, tuple):
                made += replace(one, shape=parts[0], **changes), replace(one, shape=parts[1])
            else:
                made.append(replace(one, **changes) if parts else one)
        return tuple(made)

    def _parts(self, placed: Placed) -> tuple | bool:
        """What of a shape is glass, and what is not, or whether all of it is."""
        slots, known = tuple(map(is_glass, placed.materials)), self._shapes.setdefault(placed.shape, {})
        if slots not in known:
            which, shape = glass_slots(placed), placed.shape
            is_mixed = which.any() and not which.all()
            known[slots] = (shape.take(which), shape.take(~which)) if is_mixed else bool(which.any())
        return known[slots]


def surfaces_of(table: InstanceTable) -> GlassSurfaces:
    """The glass of a scene."""
    rows = np.flatnonzero(table.of_kinds(_shows_glass))
    return GlassSurfaces.of([(table.placed[row], glass_slots(table.placed[row])) for row in rows.tolist()])
