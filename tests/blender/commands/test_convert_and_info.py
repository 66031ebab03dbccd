# SPDX-License-Identifier: GPL-3.0-or-later
"""`surfels convert` saves a complete file of surfels or none; `surfels info` describes what a file contains."""

import json

import bpy


def test_converted_objects_are_in_a_new_file(animation, surfels_command, tmp_path):
    code, said = surfels_command("convert", "--objects", "floor", "--resolution", 10, "--out", tmp_path / "out.blend")
    assert code == 0 and f"wrote {tmp_path / 'out.blend'}" in said
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "out.blend"))
    assert len(bpy.data.objects["floor surfels"].data.vertices) == 100
    assert bpy.data.objects["floor"].hide_render
    assert "there already" in surfels_command("convert", "--out", tmp_path / "out.blend")[1]


def test_a_name_that_is_not_there_saves_nothing(animation, surfels_command, tmp_path):
    code, said = surfels_command("convert", "--objects", "floor", "walls", "--out", tmp_path / "out.blend")
    assert code == 1 and "no object 'walls'" in said
    assert [path.name for path in tmp_path.iterdir()] == ["anim.blend"]


def test_a_density_that_cannot_be_met_saves_nothing(animation, surfels_command, tmp_path):
    code, said = surfels_command("convert", "--objects", "floor", "--spacing", 1e-9, "--out", tmp_path / "out.blend")
    assert code == 1 and "floor: " in said
    assert [path.name for path in tmp_path.iterdir()] == ["anim.blend"]


def test_a_file_is_told_of(animation, surfels_command):
    code, said = surfels_command("info", "--json")
    facts = json.loads(said)
    assert code == 0 and facts["frames"] == "1-4:1" and facts["size"] == "48 x 32" and facts["surfels"] > 1000
    assert "floor" in facts["convertible"] and facts["surfel_objects"] == ["Sphere surfels"]
    assert "surfel objects: Sphere surfels" in surfels_command("info")[1]


def test_blocks_are_the_file_that_one_machine_makes(animation, surfels_command, surfels_of, tmp_path):
    """Two objects are converted in blocks and merged: the file is equal bit by bit, and a missing block is named."""
    bpy.data.objects["ball"].hide_set(False)
    bpy.ops.wm.save_mainfile()
    made_from, objects = str(tmp_path / "anim.blend"), ("--objects", "ball", "floor", "--resolution", 40)
    assert surfels_command("convert", *objects, "--out", tmp_path / "whole.blend")[0] == 0
    shared = (*objects, "--blocks", 3, "--out", tmp_path / "shared.blend")
    for block in (3, 1, 2):
        bpy.ops.wm.open_mainfile(filepath=made_from)
        if block == 2:
            code, said = surfels_command("merge", *shared)
            assert code == 1 and "1 of 3 blocks are missing, first" in said and "block-2-of-3" in said
        code, said = surfels_command("convert", *shared, "--block", block)
        assert code == 0 and f"block-{block}-of-3.npz" in said
    assert surfels_command("merge", *shared)[0] == 0
    assert sorted(path.name for path in tmp_path.glob("*[!1]")) == ["anim.blend", "shared.blend", "whole.blend"]
    stored = []
    for name in ("whole", "shared"):
        bpy.ops.wm.open_mainfile(filepath=str(tmp_path / f"{name}.blend"))
        stored.append([surfels_of(bpy.data.objects[f"{each} surfels"]).arrays() for each in ("ball", "floor")])
    for whole, joined in zip(*stored, strict=True):
        assert len(whole["positions"]) > 1000 and whole.keys() == joined.keys()
        assert all(whole[field].tobytes() == joined[field].tobytes() for field in whole)
