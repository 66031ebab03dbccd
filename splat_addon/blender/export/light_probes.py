# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's sphere light probes, as places from which glossy objects see their surroundings."""

from __future__ import annotations

import bpy

from ...rendering.scene.light_probe import LightProbe
from ..conversion.placement import finite_matrix
from .notes import Notes


def light_probes(depsgraph: bpy.types.Depsgraph, notes: Notes) -> tuple[LightProbe, ...]:
    """The sphere probes that are visible."""
    found = []
    for entry in depsgraph.object_instances:
        if entry.object.type == "LIGHT_PROBE" and entry.show_self and entry.object.data.type == "SPHERE":
            try:
                matrix = finite_matrix(entry.matrix_world)
                axes = matrix[:3, :3].T * entry.object.data.influence_distance
                found.append(LightProbe(tuple(matrix[:3, 3]), tuple(map(tuple, axes))))
            except Exception as error:
                notes.leave_out(entry.object.name, error)
    return tuple(found)
