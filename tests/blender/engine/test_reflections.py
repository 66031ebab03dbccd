# SPDX-License-Identifier: GPL-3.0-or-later
"""Glossy objects reflect their surroundings in a render of Blender, unless that is switched off; light probes count."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.export.live_meshes import LiveMeshes
from splat_addon.blender.export.scene import export_scene
from splat_addon.blender.export.surfel_store import SurfelStore

RED = (1.0, 0.05, 0.05)


def metal_and_wall(scene, add_camera):
    """A ball of metal before the camera, which stands between it and a red wall."""
    scene.render.resolution_x = scene.render.resolution_y = 24
    scene.surfel_splatting.shading = "principled"
    scene.surfel_splatting.property_unset("use_reflections")
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    add_camera((0, -4, 0), (np.pi / 2, 0, 0), angle=0.4)
    bpy.ops.mesh.primitive_uv_sphere_add(segments=32, ring_count=16, radius=0.5)
    bpy.context.object.data.shade_smooth()
    metal = painted((1, 1, 1), metallic=1.0, roughness=0.05)
    bpy.ops.mesh.primitive_plane_add(size=40, location=(0, -8, 0), rotation=(np.pi / 2, 0, 0))
    painted((0, 0, 0), emission=RED)
    return metal


def painted(color, metallic=0.0, roughness=1.0, emission=(0, 0, 0)):
    material = bpy.data.materials.new("material")
    material.use_nodes = True
    inputs = material.node_tree.nodes["Principled BSDF"].inputs
    inputs["Base Color"].default_value, inputs["Metallic"].default_value = (*color, 1), metallic
    inputs["Roughness"].default_value = roughness
    inputs["Emission Color"].default_value, inputs["Emission Strength"].default_value = (*emission, 1), 1.0
    bpy.context.object.data.materials.append(material)
    return material


def test_metal_reflects_the_wall_behind_the_camera(scene, add_camera, picture):
    metal_and_wall(scene, add_camera)
    middle = picture()[12, 12, :3]
    assert middle == pytest.approx(RED, abs=0.1)
    scene.surfel_splatting.use_reflections = False
    assert picture()[12, 12, 0] < 0.2


def test_sphere_probes_are_exported(scene):
    made = bpy.data.objects.new("probe", bpy.data.lightprobes.new("probe", "SPHERE"))
    made.data.influence_distance, made.location, made.scale = 3.0, (1, 2, 3), (1, 1, 2)
    scene.collection.objects.link(made)
    other = bpy.data.objects.new("volume", bpy.data.lightprobes.new("volume", "VOLUME"))
    scene.collection.objects.link(other)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    (found,) = export_scene(depsgraph, SurfelStore(), LiveMeshes())[0].light_probes
    assert found.middle == (1, 2, 3)
    np.testing.assert_allclose(found.axes, np.diag((3.0, 3.0, 6.0)))
