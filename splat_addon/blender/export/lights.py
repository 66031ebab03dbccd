# SPDX-License-Identifier: GPL-3.0-or-later
"""The lights of a depsgraph, the objects that they light, and its sphere probes."""

from __future__ import annotations

import bpy

from ...rendering import Light
from ...rendering.scene.light_probe import LightProbe
from ..conversion.placement import finite_matrix
from . import passed_over
from .lamps import light_of
from .light_linking import LightSets
from .light_probes import is_sphere_probe, light_probe_of
from .notes import Notes


def lights_of(depsgraph: bpy.types.Depsgraph, notes: Notes) -> tuple[list[Light], LightSets, list[LightProbe]]:
    """All lights that emit, the objects that they light, and the sphere probes: in one walk, of which Blender keeps a
    wrapper for each instance."""
    lights, objects, probes = [], [], []
    for entry in depsgraph.object_instances:
        if (kind := entry.object.type) not in ("LIGHT", "LIGHT_PROBE"):
            continue
        if is_sphere_probe(entry):
            try:
                probes.append(light_probe_of(entry))
            except Exception as error:
                notes.leave_out(entry.object.name, error)
        if kind == "LIGHT" and entry.show_self:
            try:
                light = light_of(entry.object.data, finite_matrix(entry.matrix_world), notes)
            except Exception as error:
                notes.leave_out(entry.object.name, error)
                continue
            if light:
                for sentence in passed_over.of_light(entry.object.original):
                    notes.add(sentence)
                lights.append(light)
                objects.append(entry.object.original)
    return lights, LightSets(objects, notes), probes
