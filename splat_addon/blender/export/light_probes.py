# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's sphere light probes, as places from which glossy objects see their surroundings."""

from __future__ import annotations

import bpy

from ...rendering.scene.light_probe import LightProbe
from ..conversion.placement import finite_matrix


def is_sphere_probe(entry: bpy.types.DepsgraphObjectInstance) -> bool:
    """Whether an entry is a visible sphere probe."""
    return entry.object.type == "LIGHT_PROBE" and entry.show_self and entry.object.data.type == "SPHERE"


def light_probe_of(entry: bpy.types.DepsgraphObjectInstance) -> LightProbe:
    """A sphere probe. Raises ValueError for a transform that is not finite."""
    matrix = finite_matrix(entry.matrix_world)
    axes = matrix[:3, :3].T * entry.object.data.influence_distance
    return LightProbe(tuple(matrix[:3, 3]), tuple(map(tuple, axes)))
