# SPDX-License-Identifier: GPL-3.0-or-later
"""Splits a mesh by a vertex group: polygons where its weights are 1/2 or more, splats elsewhere."""

from __future__ import annotations

from typing import NamedTuple

import bpy
import numpy as np

from ...sampling import TriangleMesh


class MeshParts(NamedTuple):
    """Two parts of one mesh, over the same vertices. near: drawn as polygons. far: sampled."""

    near: TriangleMesh
    far: TriangleMesh


def parts_by_group(evaluated: bpy.types.Object, mesh: bpy.types.Mesh, triangles: TriangleMesh, group: str) -> MeshParts:
    """Assign each triangle by the mean weight of its corners.

    Raises ValueError with the end of a sentence if the object does not have the group.
    """
    found = evaluated.vertex_groups.get(group)
    if found is None:
        raise ValueError(f"It is split by the vertex group {group!r}, which it does not have; choose one that it has.")
    weights = _weights(mesh, found.index)[triangles.triangles].mean(axis=1)
    return MeshParts(*(triangles.with_triangles(np.flatnonzero(at)) for at in (weights >= 0.5, weights < 0.5)))


def _weights(mesh: bpy.types.Mesh, index: int) -> np.ndarray:
    """(V,) weights of one vertex group, 0 outside. Blender returns them one at a time: half a second per million."""
    weights = np.zeros(len(mesh.vertices))
    for vertex in mesh.vertices:
        for element in vertex.groups:
            if element.group == index:
                weights[vertex.index] = element.weight
    return weights
