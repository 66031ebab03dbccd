# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts a depsgraph to `rendering.Scene`: surfels, meshes, instances, lights, world; what cannot be drawn is
counted."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

import bpy
import numpy as np

from ...rendering import Scene
from ...rendering.scene.placements import joined
from ..geometry.attributes import since_written
from ..mesh_sampling_settings import density_of_meshes, looks_of_meshes
from . import passed_over
from .entry_kinds import EntryKinds
from .lights import lights_of
from .live_meshes import LiveMeshes
from .notes import Notes
from .surfel_store import SurfelStore


def export_scene(depsgraph: bpy.types.Depsgraph, store: SurfelStore, live_meshes: LiveMeshes) -> tuple[Scene, Notes]:
    """Everything in the depsgraph that the renderer can draw, and notes on what it cannot.

    live_meshes: keeps the meshes that are not surfels.
    """
    notes, bpy_scene = Notes(), depsgraph.scene
    for sentence in passed_over.of_scene(bpy_scene):
        notes.add(sentence)
    lights, light_sets, probes = lights_of(depsgraph, notes)
    kinds = EntryKinds(depsgraph, store, live_meshes, light_sets, notes)
    if depsgraph.view_layer_eval.use_solid:
        kinds.add_all()
    for sentence in store.changed_sources.sentences(kinds.made, depsgraph):
        notes.add(sentence)
    if sentence := _of_another_working_space(kinds.made):
        notes.add(sentence)
    sampled, polygons = live_meshes.instances(
        depsgraph, density_of_meshes(bpy_scene), looks_of_meshes(bpy_scene), notes
    )
    lights = (replace(light, receivers=light_sets.lit_by(number)) for number, light in enumerate(lights))
    surfels = joined(kinds.surfels, sampled)
    scene = Scene(surfels, tuple(lights), polygons=polygons, light_probes=tuple(probes))
    world = _world_of(depsgraph)
    try:
        return store.world.around(scene, world, notes), notes
    except Exception as error:
        notes.leave_out(f"The world {world.name!r}", error)
        return scene, notes


def _of_another_working_space(made: Iterable[bpy.types.Object]) -> str:
    """The sentence about objects whose surfels have the colours of another working space than the file's, if any."""
    older = sorted(each.name for each in made if not np.array_equal(since_written(each.data), np.eye(3)))
    if not older:
        return ""
    return (
        "Colours of surfels are of another working space than the file's; this engine converts them, other engines "
        f"do not: convert {older[0]}{f' and {len(older) - 1:,} more' if older[1:] else ''} again"
    )


def _world_of(depsgraph: bpy.types.Depsgraph) -> bpy.types.World | None:
    """The world of the view layer, which from Blender 5.0 on may have its own, or None."""
    view_layer = depsgraph.view_layer_eval
    if not view_layer.use_sky:
        return None
    return getattr(view_layer, "world_override", None) or depsgraph.scene.world
