# SPDX-License-Identifier: GPL-3.0-or-later
"""A render of Blender has bounced light if that is switched on, and gathers it once while nothing changes."""

import bpy
import numpy as np
import pytest

from splat_addon.rendering.bounced import kept, light

WHITE, GLOW = 0.8, (0.5, 0.25, 0.1)


@pytest.fixture
def gathered(monkeypatch):
    """Gathers few rays, and counts how often."""
    calls = []

    def few(scene, solid, bounces):
        calls.append(bounces)
        return light.bounced_light(scene, solid, bounces, rays=1 << 15, voxels=1 << 15, surfels=500)

    monkeypatch.setattr(kept, "bounced_light", few)
    return calls


def furnace(scene, add_camera):
    """The inside of a closed white box that glows."""
    scene.render.resolution_x = scene.render.resolution_y = 16
    scene.surfel_splatting.shading = "principled"
    add_camera((0, 0, 0), (np.pi / 2, 0, 0), angle=1.0)
    bpy.ops.mesh.primitive_cube_add(size=2)
    material = bpy.data.materials.new("material")
    material.use_nodes = True
    inputs = material.node_tree.nodes["Principled BSDF"].inputs
    inputs["Base Color"].default_value, inputs["Roughness"].default_value = (WHITE, WHITE, WHITE, 1), 1.0
    inputs["Specular IOR Level"].default_value = 0.0
    inputs["Emission Color"].default_value, inputs["Emission Strength"].default_value = (*GLOW, 1), 1.0
    bpy.context.object.data.materials.append(material)


def test_furnace_glows_as_the_geometric_series(scene, add_camera, picture, gathered):
    furnace(scene, add_camera)
    assert picture()[..., :3] == pytest.approx(np.broadcast_to(GLOW, (16, 16, 3)), abs=1e-3)
    assert not gathered
    scene.surfel_splatting.use_bounced_light, scene.surfel_splatting.bounces = True, 3
    expected = np.multiply(GLOW, sum(WHITE**k for k in range(5)))
    assert np.abs(picture()[..., :3] / expected - 1).max() < 0.02
    assert gathered == [3]


def test_light_is_kept_from_render_to_render(scene, add_camera, picture, gathered):
    furnace(scene, add_camera)
    lamp = bpy.data.objects.new("lamp", bpy.data.lights.new("lamp", "POINT"))
    scene.collection.objects.link(lamp)
    scene.surfel_splatting.use_bounced_light, scene.render.use_persistent_data = True, True
    picture(), picture()
    assert len(gathered) == 1
    lamp.data.energy *= 2
    picture()
    assert len(gathered) == 2
