# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects of all kinds that a scene may contain besides plain meshes, and their exact surfaces."""

import bpy
import numpy as np
import pytest
import trimesh


@pytest.fixture
def select():
    """select(*objects) selects these only; the last one becomes active."""

    def only(*objects: bpy.types.Object) -> None:
        bpy.context.view_layer.update()
        for other in bpy.context.view_layer.objects:
            other.select_set(other in objects)
        bpy.context.view_layer.objects.active = objects[-1]

    return only


@pytest.fixture
def made_real():
    """made_real() -> everything in the scene as one trimesh in world space, made real by Blender's own operators."""

    def make() -> trimesh.Trimesh:
        bpy.context.view_layer.update()
        for shown in bpy.context.view_layer.objects:
            shown.select_set(shown.type in ("MESH", "EMPTY"))
        bpy.ops.object.duplicates_make_real()
        bpy.ops.object.select_all(action="SELECT")
        bpy.context.view_layer.objects.active = bpy.context.selected_objects[0]
        bpy.ops.object.convert(target="MESH")
        parts = []
        for made in bpy.context.selected_objects:
            if made.type == "MESH" and made.data.polygons:
                made.data.calc_loop_triangles()
                matrix = np.array(made.matrix_world, np.float64)
                vertices = np.array([v.co for v in made.data.vertices], np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
                faces = np.array([t.vertices for t in made.data.loop_triangles])
                parts.append(trimesh.Trimesh(vertices, faces, process=False))
        return trimesh.util.concatenate(parts)

    return make


@pytest.fixture
def world_surfels(surfels_of):
    """world_surfels(object) -> its surfels in world space: (N, 3) positions, geometric and shading normals, (N, 2)
    half-axes.
    """

    def read(made: bpy.types.Object):
        bpy.context.view_layer.update()
        matrix = np.array(made.matrix_world, np.float64)
        linear, surfels = matrix[:3, :3], surfels_of(made)
        u, v = (axis.astype(np.float64) @ linear.T for axis in surfels.half_axes())
        normals = [n.astype(np.float64) @ np.linalg.inv(linear) for n in (surfels.geometric_normals(), surfels.normals)]
        geometric, shading = (n / np.linalg.norm(n, axis=1, keepdims=True) for n in normals)
        sizes = np.stack([np.linalg.norm(axis, axis=1) for axis in (u, v)], axis=1)
        return surfels.positions.astype(np.float64) @ linear.T + matrix[:3, 3], geometric, shading, sizes

    return read
