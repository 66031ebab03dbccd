# SPDX-License-Identifier: GPL-3.0-or-later
"""How many surfels meshes get that are rendered as surfels."""

import bpy
import pytest

from splat_addon.blender.conversion.automatic_density import LEAST_RESOLUTION
from splat_addon.blender.export.live_meshes import LiveMeshes
from splat_addon.blender.export.scene import export_scene
from splat_addon.blender.export.surfel_store import SurfelStore
from tests.blender.engine.mesh_scenes import counts


def test_spacing_is_in_world_units(live, packed_surfels, picture):
    bpy.ops.mesh.primitive_cube_add(size=1)
    bpy.context.object.scale = (2, 2, 2)
    live.mesh_density, live.mesh_spacing = "SPACING", 0.25
    picture()
    assert len(packed_surfels[0]) == 6 * 8**2


def test_an_object_can_be_finer_than_the_others(live, packed_surfels, picture):
    bpy.ops.mesh.primitive_cube_add(size=1)
    bpy.ops.mesh.primitive_cube_add(size=1, location=(2, 0, 0))
    bpy.context.object.surfel_splatting.detail = 0.5
    picture()
    assert sorted(map(len, packed_surfels)) == [6 * 16**2, 6 * 32**2]
    bpy.context.object.surfel_splatting.detail = 1
    picture()
    assert len(packed_surfels[-1]) == 6 * 32**2


def test_the_neediest_of_an_objects_linked_copies_decides(live, packed_surfels, picture):
    bpy.ops.mesh.primitive_cube_add(size=1)
    bpy.ops.object.duplicate(linked=True)
    bpy.context.object.location.x = 2
    bpy.context.object.surfel_splatting.detail = 0.5
    picture()
    assert [len(surfels) for surfels in packed_surfels] == [6 * 32**2] and counts()["meshes"] == 1


def test_for_the_camera_a_surfel_covers_as_many_pixels_as_asked(live, scene, packed_surfels, picture):
    """The square is at distance 10 from a camera whose picture is 1 wide at distance 1; another square is behind it."""
    scene.camera.data.sensor_width = scene.camera.data.lens = 36
    bpy.ops.mesh.primitive_plane_add(size=2)
    live.mesh_density, live.mesh_pixels = "CAMERA", 0.5
    picture()
    assert packed_surfels[0].scales[0, 0] / 1.25 == pytest.approx(0.5 * 10 / 32, rel=0.02)
    bpy.context.object.location.z = 20
    picture()
    assert counts()["meshes"] == 1


def test_by_itself_the_density_is_the_cameras(live, scene, packed_surfels, picture):
    scene.camera.data.sensor_width = scene.camera.data.lens = 36
    bpy.ops.mesh.primitive_plane_add(size=2)
    live.mesh_density, live.mesh_pixels = "AUTOMATIC", 0.5
    picture()
    assert packed_surfels[0].scales[0, 0] / 1.25 == pytest.approx(2 / LEAST_RESOLUTION)
    live.mesh_pixels = 0.25
    picture()
    assert packed_surfels[1].scales[0, 0] / 1.25 == pytest.approx(0.25 * 10 / 32, rel=0.02)


def test_by_itself_the_density_is_a_resolution_where_the_camera_sees_nothing(live, packed_surfels, picture):
    bpy.ops.mesh.primitive_plane_add(size=2, location=(0, 0, 20))
    bpy.context.object.surfel_splatting.detail = 0.25
    live.mesh_density = "AUTOMATIC"
    picture()
    assert counts()["meshes"] == 1 and counts()["surfels"] == 64**2


def test_too_many_surfels_are_refused_with_a_sentence(live, picture, said):
    bpy.ops.mesh.primitive_plane_add(size=2)
    live.mesh_resolution = 20_000
    assert not picture().any()
    assert "Plane is left out: It would be 400,000,000 surfels and the limit is 100,000,000" in said()


def test_a_preview_samples_large_meshes_coarsely(live):
    bpy.ops.mesh.primitive_plane_add(size=2)
    live.mesh_resolution = 20_000
    found, _ = export_scene(bpy.context.evaluated_depsgraph_get(), SurfelStore(), LiveMeshes(most=400))
    (instance,) = found.surfels
    assert 300 < len(instance.surfels) < 500
