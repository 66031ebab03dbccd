# SPDX-License-Identifier: GPL-3.0-or-later
"""`surfels convert` saves a complete file of surfels or none; `surfels info` describes what a file contains."""

import json
import math
import os
from concurrent.futures import ThreadPoolExecutor

import bpy
import numpy as np
import pytest

from splat_addon.whole_files import unfinished


def test_converted_objects_are_in_a_new_file(animation, surfels_command, tmp_path):
    code, said = surfels_command("convert", "--objects", "floor", "--resolution", 10, "--out", tmp_path / "out.blend")
    assert code == 0 and f"wrote {tmp_path / 'out.blend'}" in said
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "out.blend"))
    # one large surfel replaces 9
    assert len(bpy.data.objects["floor surfels"].data.vertices) == 100 - 8
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


@pytest.fixture
def cloud(animation):
    """A mesh of 400 bare points, on a square at the height 2."""
    mesh = bpy.data.meshes.new("cloud")
    mesh.from_pydata([(x / 10, y / 10, 2) for x in range(20) for y in range(20)], [], [])
    bpy.context.scene.collection.objects.link(bpy.data.objects.new("cloud", mesh))


def test_bare_points_are_converted_with_the_operators_settings(cloud, surfels_command, surfels_of, tmp_path):
    out = tmp_path / "out.blend"
    code, said = surfels_command("points", "--out", out, "--splat-size", 2, "--facing", "camera", "--crease-angle", 45)
    assert code == 0 and f"wrote {out}" in said and "400 points -> 400 surfels" in said
    bpy.ops.wm.open_mainfile(filepath=str(out))
    made = bpy.data.objects["cloud surfels"]
    assert bpy.data.objects["cloud"].hide_render and not bpy.data.objects["floor"].hide_render
    record = made.surfel_record
    assert record.kind == "POINTS" and record.points.splat_size == 2 and record.points.facing == "CAMERA"
    assert record.points.crease_angle == pytest.approx(math.radians(45)) and not record.points.finds_creases
    surfels = surfels_of(made)
    assert np.allclose(surfels.normals, (0, 0, 1), atol=1e-3) and np.median(surfels.scales) == pytest.approx(
        0.2, rel=0.2
    )
    assert "there already" in surfels_command("points", "--out", out)[1]


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        (("--objects", "cloud", "walls"), 1, "no object 'walls'"),
        (("--objects", "sun"), 1, "'sun' has no points"),
        (("--neighbours", -1), 2, "-1 is out of range"),
        (("--stray", "eat"), 2, "unrecognized"),
        (("--isolated", "eat"), 2, "EAT"),
    ],
)
def test_what_cannot_be_done_with_points_saves_nothing(cloud, surfels_command, tmp_path, arguments, code, said):
    done, told = surfels_command("points", "--out", tmp_path / "out.blend", *arguments)
    assert done == code and said in told
    assert [path.name for path in tmp_path.iterdir()] == ["anim.blend"]


def test_a_file_is_told_of(animation, surfels_command):
    code, said = surfels_command("info", "--json")
    facts = json.loads(said)
    assert code == 0 and facts["frames"] == "1-4:1" and facts["size"] == "48 x 32" and facts["surfels"] > 1000
    assert "floor" in facts["convertible"] and facts["surfel_objects"] == ["Sphere surfels"]
    assert "surfel objects: Sphere surfels" in surfels_command("info")[1]


def test_blocks_are_the_file_that_one_machine_makes(animation, surfels_command, surfels_of, tmp_path):
    """Two objects are converted in blocks and merged without their options: the file is equal bit by bit. A missing
    block is named."""
    bpy.data.objects["ball"].hide_set(False)
    bpy.ops.wm.save_mainfile()
    made_from, objects = str(tmp_path / "anim.blend"), ("--objects", "ball", "floor", "--resolution", 40)
    assert surfels_command("convert", *objects, "--out", tmp_path / "whole.blend")[0] == 0
    shared = ("--blocks", 3, "--out", tmp_path / "shared.blend")
    for block in (3, 1, 2):
        bpy.ops.wm.open_mainfile(filepath=made_from)
        if block == 2:
            code, said = surfels_command("merge", *shared)
            assert code == 1 and "1 of 3 blocks are missing, first" in said and "block-2-of-3" in said
        code, said = surfels_command("convert", *objects, *shared, "--block", block)
        assert code == 0 and f"block-{block}-of-3.npz" in said
    bpy.ops.wm.open_mainfile(filepath=made_from)
    assert surfels_command("merge", *shared)[0] == 0
    assert sorted(path.name for path in tmp_path.glob("*[!1]")) == ["anim.blend", "shared.blend", "whole.blend"]
    stored = []
    for name in ("whole", "shared"):
        bpy.ops.wm.open_mainfile(filepath=str(tmp_path / f"{name}.blend"))
        stored.append([surfels_of(bpy.data.objects[f"{each} surfels"]).arrays() for each in ("ball", "floor")])
    for whole, joined in zip(*stored, strict=True):
        assert len(whole["positions"]) > 500 and whole.keys() == joined.keys()
        assert all(whole[field].tobytes() == joined[field].tobytes() for field in whole)


@pytest.fixture
def blocks(animation, surfels_command, tmp_path):
    """blocks(*options) converts the floor and a second plane in two blocks; options: of the first block alone."""
    bpy.ops.mesh.primitive_plane_add(location=(0, 0, 3))

    def convert(*options) -> tuple:
        about = ("--blocks", 2, "--out", tmp_path / "out.blend")
        for block in (1, 2):
            given = options if block == 1 else ()
            assert surfels_command("convert", "--resolution", 20, *given, *about, "--block", block)[0] == 0
        return about

    return convert


def test_blocks_that_a_result_lacks_are_not_deleted(blocks, surfels_command, tmp_path):
    about = blocks()
    kept = {path.name: path.read_bytes() for path in tmp_path.glob("*.npz")}
    assert surfels_command("merge", *about)[0] == 0 and not list(tmp_path.glob("*.npz"))
    result = (tmp_path / "out.blend").read_bytes()
    for name, contents in kept.items():
        (tmp_path / name).write_bytes(contents)
        os.utime(tmp_path / name, ns=((tmp_path / "out.blend").stat().st_mtime_ns + 1,) * 2)
    code, said = surfels_command("merge", *about)
    assert code == 1 and "out.blend was there already and is older than" in said
    assert len(list(tmp_path.glob("*.npz"))) == 2 and (tmp_path / "out.blend").read_bytes() == result
    (tmp_path / "out.blend").write_bytes(result[:-40])
    code, said = surfels_command("merge", *about)
    assert code == 1 and "out.blend is there, but it is not whole: The end of the .blend is missing." in said
    assert len(list(tmp_path.glob("*.npz"))) == 2
    (tmp_path / "out.blend").write_bytes(result)
    assert surfels_command("merge", *about)[0] == 0 and not list(tmp_path.glob("*.npz"))


def test_a_block_that_is_cut_off_is_converted_again(animation, surfels_command, tmp_path):
    arguments = ("convert", "--objects", "floor", "--resolution", 8, "--blocks", 1, "--block", 1)
    arguments += ("--out", tmp_path / "out.blend")
    assert surfels_command(*arguments)[0] == 0
    (block,) = tmp_path.glob("*.npz")
    whole = block.read_bytes()
    block.write_bytes(whole[:-100])
    assert "wrote" in surfels_command(*arguments)[1] and len(block.read_bytes()) == len(whole)
    assert "there already" in surfels_command(*arguments)[1]


def test_paths_in_the_new_file_are_relative_to_its_folder(animation, surfels_command, tmp_path):
    image = bpy.data.images.new("picture", 4, 4)
    image.source, image.filepath, image.use_fake_user = "FILE", "//textures/picture.png", True
    for out in (tmp_path / "out.blend", tmp_path / "new" / "out.blend"):
        assert surfels_command("convert", "--objects", "floor", "--resolution", 8, "--out", out)[0] == 0
        with bpy.data.libraries.load(str(out)) as (_, loaded):
            loaded.images = ["picture"]
        (found,) = loaded.images
        assert found.filepath.startswith("//")
        path = bpy.path.abspath(found.filepath, library=found.library)
        assert os.path.normpath(path) == str(tmp_path / "textures" / "picture.png")


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("out.blend", ("convert", "--objects", "floor", "--resolution", 8, "--out", "//out.blend")),
        ("frame_0001.exr", ("render", "--frames", 1)),
        ("frame_0001.exr.tile-1-1-of-1x1.npz", ("render", "--frames", 1, "--tiles", "1x1", "--tile", "1,1")),
        ("out.blend", ("merge", "--blocks", 1, "--out", "//out.blend")),
        ("frame_0001.exr", ("merge", "--frames", 1, "--tiles", "1x1")),
        ("out.surfelblocks", ("store", "--objects", "Sphere surfels", "--out", "//out.surfelblocks")),
        ("out.pot", ("template", "//out.pot")),
    ],
)
def test_what_another_run_makes_is_left_to_it(name, arguments, animation, surfels_command, tmp_path):
    with ThreadPoolExecutor(1) as other:
        claim = unfinished(tmp_path / name, print)
        folder = other.submit(claim.__enter__).result()
        (folder / name).write_text("half")
        code, said = surfels_command(*arguments)
        assert code == 1 and f"Another run is making {tmp_path / name} at this moment" in said
        assert (folder / name).read_text() == "half" and not (tmp_path / name).exists()
        other.submit(claim.__exit__, None, None, None).result()
    assert (tmp_path / name).read_text() == "half"


def test_blocks_with_different_options_are_refused(blocks, surfels_command):
    code, said = surfels_command("merge", *blocks("--objects", "floor"))
    assert code == 1 and "block-2-of-2.npz was not converted with the options of out.blend.block-1-of-2.npz" in said


def test_blocks_of_objects_that_are_hidden_by_now_are_refused(blocks, surfels_command):
    about = blocks()
    bpy.data.objects["Plane"].hide_set(True)
    code, said = surfels_command("merge", *about)
    assert code == 1 and "made from floor, Plane, but what is visible now is floor; convert them again" in said


def test_an_object_edited_between_conversion_and_merge_is_named_once(blocks, surfels_command, tmp_path):
    about = blocks()
    for name in ("floor", "Plane"):
        bpy.data.objects[name].data.vertices[0].co.x -= 1
    code, said = surfels_command("merge", *about)
    assert code == 1 and "error: floor: Block 1 was made from another mesh" in said and said.count("Block") == 1
    assert len(list(tmp_path.glob("*.npz"))) == 2


def test_no_blocks_are_refused(animation, surfels_command, tmp_path):
    code, said = surfels_command("merge", "--blocks", 0, "--out", tmp_path / "out.blend")
    assert code == 2 and "the number of blocks is 1 or more, not '0'" in said


def test_blocks_are_joined_only_in_a_named_file(animation, surfels_command):
    code, said = surfels_command("merge", "--blocks", 2)
    assert code == 1 and "error: Blocks are joined in a new file; give its path with --out" in said
