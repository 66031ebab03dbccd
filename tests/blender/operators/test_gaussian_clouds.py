# SPDX-License-Identifier: GPL-3.0-or-later
"""Point clouds of Gaussian splats, as Blender 5.3 imports them, are named by the engine and can be converted."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.engine import final_render
from splat_addon.blender.geometry.attributes import has_surfels

#: type of each attribute, as Blender 5.3's importers write it
TYPES = {"scale": "FLOAT_VECTOR", "rotation": "QUATERNION", "radiance:base": "FLOAT4", "radiance:sh_0": "FLOAT_VECTOR"}
KEYS = {"FLOAT_VECTOR": "vector", "QUATERNION": "value", "FLOAT4": "vector"}
WHITE = 0.5 / 0.28209479177387814

needs_float4 = pytest.mark.skipif(
    "FLOAT4" not in bpy.types.Attribute.bl_rna.properties["data_type"].enum_items,
    reason="this Blender has no attributes of four numbers, so no Gaussian splats",
)


@pytest.fixture
def splats():
    """Two flat Gaussians, along z and along x, and a round one; white, half opaque, 3 units above the origin."""
    cloud = bpy.data.pointclouds.new("capture")
    cloud.resize(3)
    values = {
        "position": [(0, 0, 3), (1, 0, 3), (2, 0, 3)],
        "scale": [(0.5, 0.25, 0.001), (0.002, 0.5, 0.25), (0.5, 0.5, 0.5)],
        "rotation": [(1, 0, 0, 0)] * 3,
        "radiance:base": [(WHITE, WHITE, 0, 0.5)] * 3,
        "radiance:sh_0": [(1, 2, 3)] * 3,
    }
    for name, rows in values.items():
        attribute = cloud.attributes.get(name) or cloud.attributes.new(name, TYPES[name], "POINT")
        attribute.data.foreach_set(KEYS[attribute.data_type], np.ravel(np.float32(rows)))
    made = bpy.data.objects.new("capture", cloud)
    bpy.context.collection.objects.link(made)
    made.select_set(True)
    bpy.context.view_layer.objects.active = made
    return made


def test_gaussian_splats_are_no_surfels_although_two_names_are_the_same():
    cloud = bpy.data.pointclouds.new("capture")
    for name in ("scale", "rotation"):
        cloud.attributes.new(name, TYPES[name], "POINT")
    assert has_surfels(cloud)
    cloud.attributes.new("radiance:base", "FLOAT_COLOR", "POINT")
    assert not has_surfels(cloud)


@needs_float4
def test_the_engine_names_them_and_draws_the_rest(splats, camera):
    bpy.context.scene.render.engine = "SURFEL_SPLATTING"
    bpy.context.scene.surfel_splatting.broken_objects = "STOP"
    bpy.context.scene.render.resolution_x = bpy.context.scene.render.resolution_y = 4
    bpy.ops.render.render()
    sentence = "Gaussian splats are not drawn; convert them with Object > Convert Points to Surfels"
    assert final_render.last_frame_stats["notes"] == [sentence]


@needs_float4
def test_flat_splats_become_surfels_and_the_others_are_counted(splats, surfels_of, capfd):
    splats.location.x = 7
    bpy.ops.object.surfels_from_points()
    made = bpy.context.object
    surfels = surfels_of(made)
    assert len(surfels) == 2 and made.matrix_world.translation.x == pytest.approx(7)
    positions = surfels.positions + surfels.origin
    assert np.allclose(positions + made.matrix_world.translation - surfels.origin, [(7, 0, 3), (8, 0, 3)])
    assert np.allclose(surfels.scales, [(1.0, 0.5), (1.0, 0.5)])
    assert np.allclose(np.abs(surfels.normals), [(0, 0, 1), (1, 0, 0)], atol=1e-6)
    assert np.allclose(surfels.colors, [(1, 1, 0.2140411, 0.5)] * 2, atol=1e-6)
    told = capfd.readouterr().out
    assert "3 Gaussians -> 2 surfels" in told and "Skipped 1 of 3 Gaussians thicker" in told
    assert "changes with the view" in told


@needs_float4
def test_update_from_source_keeps_the_flatness(splats, surfels_of):
    bpy.ops.object.surfels_from_points(flatness=1.0, source="KEEP")
    made = bpy.context.object
    assert len(surfels_of(made)) == 3
    splats.data.attributes["scale"].data[0].vector = (0.75, 0.25, 0.001)
    splats.data.update_tag()
    bpy.ops.object.surfels_update()
    assert len(surfels_of(made)) == 3 and surfels_of(made).scales.max() == pytest.approx(1.5)


@needs_float4
@pytest.mark.parametrize("change", ["thick", "radiance:base"])
def test_what_gives_no_surfels_is_refused_with_a_reason(splats, change):
    if change == "thick":
        splats.data.attributes["scale"].data.foreach_set("vector", np.full(9, 0.5, np.float32))
        expected = "None of its 3 Gaussians gives a surfel at a flatness of 0.25"
    else:
        splats.data.attributes.remove(splats.data.attributes["rotation"])
        expected = "need the attribute 'rotation' as QUATERNION on POINT, which is missing"
    with pytest.raises(RuntimeError, match=expected):
        bpy.ops.object.surfels_from_points()


@needs_float4
def test_a_sheared_cloud_stays_in_its_place(splats, world_positions):
    parent = bpy.data.objects.new("parent", None)
    bpy.context.collection.objects.link(parent)
    parent.scale, splats.parent, splats.rotation_euler = (1, 3, 1), parent, (0, 0, 0.5)
    bpy.context.view_layer.update()
    matrix = np.array(splats.matrix_world)
    bpy.ops.object.surfels_from_points(follow=False)
    expected = np.array([(0, 0, 3), (1, 0, 3)]) @ matrix[:3, :3].T + matrix[:3, 3]
    assert np.allclose(world_positions(bpy.context.object), expected, atol=1e-5)
