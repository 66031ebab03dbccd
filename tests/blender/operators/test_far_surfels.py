# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels of survey coordinates keep their places through Blender, whose object locations are 32-bit numbers."""

import math

import bpy
import numpy as np
import pytest
from mathutils import Matrix

from splat_addon.blender.export.live_meshes import LiveMeshes
from splat_addon.blender.export.scene import export_scene
from splat_addon.blender.export.surfel_store import SurfelStore
from splat_addon.blender.geometry.scene_offset import scene_offset
from splat_addon.interchange import read_contents, read_ply, write_ply
from splat_addon.surfels import Surfels

#: Nothing of it but the height is a float32.
FAR = np.array([403123.2656, 5604987.27, 112.003])


def tile(place, step=(0.0, 0.0, 0.0)):
    """Nine upright discs around a place."""
    x, y = (axis.ravel() for axis in np.meshgrid([-1.0, 0.0, 1.0], [-1.0, 0.0, 1.0]))
    return Surfels(
        positions=np.stack([x, y, 0 * x], axis=1) / 3,
        rotations=[[1, 0, 0, 0]] * 9,
        scales=[[0.2, 0.1]] * 9,
        normals=[[0, 0, 1]] * 9,
        colors=[[1, 0, 0, 1]] * 9,
        materials=[0] * 9,
        origin=np.array(place) + step,
    )


@pytest.fixture
def imported(tmp_path):
    """imported(surfels, **settings) -> the object that the import of their file makes."""

    def make(surfels, **settings):
        write_ply(tmp_path / "given.ply", surfels)
        bpy.ops.import_scene.surfels_ply(filepath=str(tmp_path / "given.ply"), **settings)
        return bpy.context.object

    return make


@pytest.fixture
def exported(tmp_path):
    """exported(**settings) -> what the export of all surfels holds."""

    def make(**settings):
        bpy.ops.export_scene.surfels_ply(filepath=str(tmp_path / "out.ply"), **settings)
        return read_contents(tmp_path / "out.ply").surfels

    return make


def places(surfels, matrix=None):
    """(N, 3) float64 positions of surfels, or of an instance."""
    matrix = np.eye(4) if matrix is None else matrix
    return (surfels.positions.astype(np.float64) + surfels.origin) @ matrix[:3, :3].T + matrix[:3, 3]


def drawn():
    """(N, 3) where the engine draws the surfels of each object."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    scene, _ = export_scene(depsgraph, SurfelStore(), LiveMeshes())
    return [places(instance.shape, instance.matrix_world) for instance in scene.surfels]


def test_import_and_export_move_nothing(imported, exported, capfd):
    given = tile(FAR)
    made = imported(given)
    assert "Blender keeps places so far out in steps of 0.5" in capfd.readouterr().out
    read = exported()
    assert np.array_equal(read.origin, given.origin) and np.array_equal(read.positions, given.positions)
    assert np.array_equal(drawn()[0], places(given)) and tuple(made.location) == tuple(np.float32(FAR))


def test_neighbouring_tiles_meet(imported, exported, tmp_path):
    step = np.array([0.75, 0, 0])
    for each in (tile(FAR), tile(FAR, step)):
        imported(each)
    first, second = drawn()
    assert np.abs(second - first - step).max() < 1e-9
    written = read_ply(tmp_path / "given.ply").origin, exported()
    assert len(written[1]) == 18
    assert np.abs(places(written[1])[9:] - places(written[1])[:9] - step).max() < 1e-6


@pytest.mark.parametrize("is_applied", [False, True])
def test_they_turn_with_their_object_and_with_an_applied_rotation(imported, exported, is_applied):
    made = imported(tile(FAR))
    local = places(tile(FAR)) - made.location
    made.rotation_euler.z = math.pi / 2
    made.location.x += 8
    if is_applied:
        bpy.ops.object.transform_apply(location=False, rotation=True, scale=False)
    # the offset turns with the surfels
    expected = np.stack([-local[:, 1], local[:, 0], local[:, 2]], axis=1) + made.location
    bpy.context.view_layer.update()
    assert np.abs(drawn()[0] - expected).max() < 1e-6 and np.abs(places(exported()) - expected).max() < 1e-6


def test_modifiers_keep_the_offset(imported):
    made = imported(tile(FAR))
    array = made.modifiers.new("Array", "ARRAY")
    array.use_relative_offset, array.use_constant_offset, array.constant_offset_displace = False, True, (2, 0, 0)
    first, second = np.split(drawn()[0], 2)
    assert np.array_equal(first, places(tile(FAR))) and np.abs(second - first - (2, 0, 0)).max() < 1e-6


def test_a_file_beside_the_blend_keeps_them_too(imported, tmp_path):
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    kept = imported(tile(FAR), keeps_in_file=True)
    # the coarsest of its surfels is one in the middle of all
    assert np.abs(drawn()[0] - FAR).max() < 1e-8
    bpy.data.objects.remove(kept)
    imported(tile(FAR))
    bpy.ops.object.surfels_to_file()
    assert np.abs(drawn()[0] - FAR).max() < 1e-8


def test_bare_points_of_a_survey_lie_on_their_places(imported, exported, tmp_path):
    points = places(tile(FAR))
    head = ["ply", "format ascii 1.0", "element vertex 9", *(f"property double {n}" for n in "xyz"), "end_header"]
    (tmp_path / "p.ply").write_text("\n".join([*head, *(" ".join(map(repr, map(float, p))) for p in points), ""]))
    bpy.ops.import_scene.surfels_ply(filepath=str(tmp_path / "p.ply"), isolated="KEEP")
    assert np.abs(drawn()[0] + scene_offset(bpy.context.scene) - points).max() < 1e-7
    assert np.abs(places(exported()) - points).max() < 1e-7
    assert np.abs(places(exported(layout_kind="GAUSSIANS")) - points).max() < 1e-7


def test_points_converted_far_out_stay_in_place(add_object):
    """The place of the source and the middle of its points together are no float32."""
    mesh = bpy.data.meshes.new("scan")
    mesh.from_pydata(places(tile((3000.3, 0, 0))).tolist(), [], [])
    source = add_object(mesh)
    source.matrix_world = Matrix.Translation(np.float32(FAR).tolist())
    bpy.ops.object.surfels_from_points(isolated="KEEP")
    for _ in range(2):
        local = np.array([vertex.co for vertex in mesh.vertices], np.float64)
        assert np.abs(drawn()[0] - (local + np.float32(FAR).astype(float))).max() < 1e-6
        mesh.transform(Matrix.Translation((1.37, 0, 0)))
        bpy.ops.object.surfels_update()
