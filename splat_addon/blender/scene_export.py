# SPDX-License-Identifier: GPL-3.0-or-later
"""A depsgraph -> `rendering.Scene`: surfel objects and instances, lights, world; what cannot be drawn is counted."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

import bpy
import numpy as np

from ..rendering import Instance, Light, Scene
from ..surfels import LAYOUT, Surfels
from .attributes import has_surfels, read_surfels
from .shading_export import light_of, shading_material, world_radiance


@dataclass
class Notes:
    """What the user should hear about a scene: sentence -> how often."""

    counts: Counter = field(default_factory=Counter)

    def add(self, sentence: str, count: int = 1) -> None:
        self.counts[sentence] += count

    def sentences(self) -> list[str]:
        """One sentence each, with its count where it happened more than once."""
        return [text if count == 1 else f"{text} ({count} times)" for text, count in self.counts.items()]


class SurfelStore:
    """Keeps the `Surfels` of meshes between frames, the same object as long as the values are the same.

    What is drawn from is cached by that identity. The values are compared, since a final render tells of no
    change: reading and comparing a million surfels takes a tenth of packing and uploading them again.
    """

    def __init__(self):
        self._kept: dict[str, tuple[Surfels, int]] = {}
        self._current: set[str] = set()

    def get(self, mesh: bpy.types.Mesh) -> tuple[Surfels, int]:
        """As `attributes.read_surfels`; once a mesh and frame."""
        key = mesh.original.name_full if mesh.original else mesh.name_full
        if key in self._current:
            return self._kept[key]
        surfels, skipped = read_surfels(mesh)
        kept = self._kept.get(key)
        if kept is None or not _same(kept[0], surfels):
            self._kept[key] = surfels, skipped
        self._current.add(key)
        return self._kept[key]

    def begin_frame(self, changed: set[str] | None = None) -> None:
        """Meshes named in `changed` (None: all) are read again the next time they are asked for."""
        self._current = set() if changed is None else self._current - changed

    def forget_unused(self) -> None:
        """Let go of meshes that this frame did not ask for."""
        self._kept = {key: kept for key, kept in self._kept.items() if key in self._current}


def export_scene(depsgraph: bpy.types.Depsgraph, store: SurfelStore) -> tuple[Scene, Notes]:
    """Everything in the depsgraph that the renderer knows how to draw, and notes on what it does not."""
    notes = Notes()
    surfels, lights = [], []
    for entry in depsgraph.object_instances:
        if not entry.show_self:
            continue
        object_ = entry.object
        if object_.type == "LIGHT":
            lights += _light(object_, entry.matrix_world, notes)
        elif object_.type == "MESH" and len(object_.data.vertices):
            surfels += _instance(object_, entry.matrix_world, store, notes)
    return Scene(tuple(surfels), tuple(lights), world_radiance(depsgraph.scene.world, notes)), notes


def _instance(object_, matrix_world, store: SurfelStore, notes: Notes) -> list[Instance]:
    mesh = object_.data
    if not has_surfels(mesh):
        notes.add("Meshes without surfels are not drawn; convert them with Object > Convert to Surfels")
        return []
    try:
        surfels, skipped = store.get(mesh)
    except ValueError as error:
        notes.add(f"{object_.name}: {error}")
        return []
    if skipped:
        notes.add(f"{object_.name}: {skipped:,} surfels with unusable values are left out")
    materials = tuple(shading_material(slot.material, notes) for slot in object_.material_slots)
    return [Instance(surfels, np.array(matrix_world, np.float64), materials)]


def _light(object_, matrix_world, notes: Notes) -> list[Light]:
    light = light_of(object_.data, np.array(matrix_world, np.float64))
    if light is None:
        notes.add(f"Lights of type {object_.data.type.title()} give no light yet; use a sun or a point")
        return []
    return [light]


def _same(a: Surfels, b: Surfels) -> bool:
    return all(np.array_equal(getattr(a, name), getattr(b, name)) for name in LAYOUT)
