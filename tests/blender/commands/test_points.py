# SPDX-License-Identifier: GPL-3.0-or-later
"""`surfels points` makes a new .blend of files, without one that is open."""

import argparse

import bpy
import numpy as np
import pytest

from splat_addon.blender.commands.points import add_points_arguments
from splat_addon.blender.conversion.points_settings import PointsProperties
from splat_addon.blender.conversion.source_record import SurfelPointsSettings
from splat_addon.blender.geometry.stored_surfels import read_surfels


def plane(path, start):
    """A PLY file of 15 by 15 points."""
    points = [(start + x, y, 0) for x in range(15) for y in range(15)]
    head = ["ply", "format ascii 1.0", "element vertex 225", *(f"property double {n}" for n in "xyz"), "end_header"]
    path.write_text("\n".join([*head, *(" ".join(map(str, point)) for point in points), ""]))


def test_files_become_surfels_in_a_new_blend(surfels_command, tmp_path):
    bpy.ops.wm.read_factory_settings(use_empty=False)
    for name, start in (("a.xyz", 0), ("b.ply", 20)):
        plane(tmp_path / name, start)
    files = [tmp_path / "a.xyz", tmp_path / "b.ply"]
    code, said = surfels_command("points", *files, "--neighbours", 8, "--out", tmp_path / "scan.blend")
    assert code == 0 and "a.xyz: 225 surfels" in said and "b.ply: Estimated normals" in said
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "scan.blend"))
    objects = sorted((made for made in bpy.data.objects if made.type == "MESH"), key=lambda made: made.name)
    assert [made.name for made in objects] == ["a", "b"]
    scene = bpy.context.scene
    assert scene.render.engine == "SURFEL_SPLATTING" and scene.surfel_splatting.use_eye_dome and scene.camera
    assert [made.surfel_splatting.color_by for made in objects] == ["HEIGHT", "HEIGHT"]
    found = [read_surfels(made.data)[0] for made in objects]
    assert [len(surfels) for surfels in found] == [225, 225]
    assert np.abs(found[0].geometric_normals()[:, 2]).min() > 0.99


def test_plain_files_are_surfels_alone_and_their_colors_may_be_chosen(surfels_command, tmp_path):
    plane(tmp_path / "a.xyz", 0)
    options = "--plain", "--color-by", "height", "--out", tmp_path / "plain.blend"
    assert surfels_command("points", tmp_path / "a.xyz", *options)[0] == 0
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "plain.blend"))
    assert [made.surfel_splatting.color_by for made in bpy.data.objects] == ["HEIGHT"]
    assert not bpy.context.scene.surfel_splatting.use_eye_dome


def test_a_file_of_blocks_is_read_as_views_need_it(surfels_command, tmp_path):
    plane(tmp_path / "a.xyz", 0)
    blocks = tmp_path / "a.surfelblocks"
    assert surfels_command("store", "--file", tmp_path / "a.xyz", "--out", blocks)[0] == 0
    code, said = surfels_command("points", blocks, "--color-by", "height", "--out", f"{tmp_path}/")
    assert code == 0 and "a.surfelblocks: 225 surfels" in said
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
    made = bpy.data.objects["a"]
    assert made.data.surfel_splatting.file == str(blocks) and bpy.context.scene.camera
    assert made.surfel_splatting.color_by == "HEIGHT"
    code, said = surfels_command("points", blocks, "--most", 9, "--out", tmp_path / "b.blend")
    assert code == 1 and "leave out --series, --most" in said


def test_columns_of_text_may_be_said_and_points_be_fewer(surfels_command, tmp_path):
    (tmp_path / "a.xyz").write_text("".join(f"{k % 40} 7 {k // 40} 0\n" for k in range(1600)))
    options = "--columns", "y - x z", "--most", 400, "--isolated", "keep", "--plain", "--out", tmp_path / "a.blend"
    code, said = surfels_command("points", tmp_path / "a.xyz", *options)
    assert code == 0 and "Took 400 of 1,600 points" in said
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "a.blend"))
    surfels, _ = read_surfels(bpy.data.objects[0].data)
    assert len(surfels) == 400 and np.ptp(surfels.positions, axis=0).round(2).tolist() == [39, 36, 0]


def test_a_file_that_cannot_be_read_is_named_and_nothing_is_saved(surfels_command, tmp_path):
    (tmp_path / "bad.las").write_bytes(b"LASF")
    code, said = surfels_command("points", tmp_path / "bad.las", "--out", tmp_path / "scan.blend")
    assert code == 1 and "bad.las: The LAS file ends in its header" in said and not (tmp_path / "scan.blend").exists()
    code, said = surfels_command("points", tmp_path / "none.las", "--out", tmp_path / "scan.blend")
    assert code == 1 and "none.las: No such file" in said


def test_what_is_not_said_is_as_in_the_interface(add_on):
    parser = argparse.ArgumentParser()
    add_points_arguments(parser)
    taken, settings = parser.parse_args([]), SurfelPointsSettings.bl_rna.properties
    names = PointsProperties.__annotations__
    assert {name: getattr(taken, name) for name in names} == {name: settings[name].default for name in names}
    assert not parser.parse_args(["--no-thins-overlaps"]).thins_overlaps


def test_a_series_locks_the_interface_while_it_is_rendered(surfels_command, tmp_path):
    plane(tmp_path / "walk1.ply", 0)
    assert surfels_command("points", tmp_path / "walk1.ply", "--series", "--out", tmp_path / "walk.blend")[0] == 0
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "walk.blend"))
    assert bpy.context.scene.render.use_lock_interface


@pytest.mark.parametrize(
    "given", [("--most", 9), ("--series",), ("--plain",), ("--columns", "x y z"), ("--color-by", "height")]
)
def test_what_is_about_files_is_refused_for_objects(given, surfels_command, animation, tmp_path):
    code, said = surfels_command("points", "--objects", "floor", *given, "--out", tmp_path / "a.blend")
    assert code == 1 and f"{given[0]} is about files" in said and not [*tmp_path.glob("a.blend*")]
