# SPDX-License-Identifier: GPL-3.0-or-later
"""`surfels store` makes a complete file of surfels in blocks or none, and `surfels info` tells what it holds."""

import json

import bpy
import numpy as np
import pytest

from splat_addon.blender.geometry.world_surfels import world_surfels
from splat_addon.hierarchy import Sight
from splat_addon.interchange import write_ply
from splat_addon.streaming import Stream, described


def every_surfel(path):
    """The surfels of a file, without merged ones."""
    stream = Stream(path, 0)
    surfels = stream.at_most(10**9)
    assert len(surfels) == len(stream)
    stream.close()
    return surfels


def sorted_places(surfels):
    places = surfels.positions + surfels.origin
    return places[np.lexsort(places.T)]


@pytest.mark.parametrize("name", ["Sphere surfels", "floor"])
def test_objects_are_stored_in_world_space_and_converted_if_they_are_no_surfels(
    name, animation, surfels_command, tmp_path
):
    bpy.data.objects[name].location.z += 3
    bpy.context.view_layer.update()
    out = tmp_path / "new.surfelblocks"
    code, said = surfels_command("store", "--objects", name, "--resolution", 40, "--out", out)
    assert code == 0 and f"wrote {out}" in said and "Merging: 100%" in said
    made = bpy.data.objects[name if name.endswith("surfels") else f"{name} surfels"]
    (whole,), _ = world_surfels([made], bpy.context.evaluated_depsgraph_get())
    found = every_surfel(out)
    assert f"{len(found):,} surfels" in said and len(found) == len(whole) > 500
    assert found.positions[:, 2].max() + found.origin[2] >= 3 and sorted(tmp_path.iterdir())[-1] == out
    np.testing.assert_allclose(sorted_places(found), sorted_places(whole), atol=1e-5)
    assert "there already" in surfels_command("store", "--objects", name, "--out", out)[1]
    code, said = surfels_command("store", "--objects", name, "--color-by", "height", "--out", out)
    assert code == 1 and "--color-by is about files" in said


def test_a_ply_file_is_stored_and_told_of_without_a_blend(animation, surfels_command, surfels_of, tmp_path):
    surfels = surfels_of(bpy.data.objects["Sphere surfels"])
    write_ply(tmp_path / "scan.ply", surfels)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    out = tmp_path / "scan.surfelblocks"
    code, said = surfels_command("store", "--ply", tmp_path / "scan.ply", "--color-by", "height", "--out", out)
    assert code == 1 and "keep their colours" in said and not out.exists()
    assert surfels_command("store", "--ply", tmp_path / "scan.ply", "--out", out)[0] == 0
    code, said = surfels_command("info", out, "--json")
    facts = json.loads(said)
    assert code == 0 and facts == described(out) and facts["surfels"] == len(surfels) < facts["rows"]
    low, high = surfels.local_bounds
    assert (np.array(facts["low"]) <= low + surfels.origin).all()
    assert (np.array(facts["high"]) >= high + surfels.origin).all()
    assert f"surfels: {len(surfels)}" in surfels_command("info", out)[1]
    stream = Stream(out, 0)
    assert len(stream) == len(surfels)
    stream.close()


def test_a_scan_is_stored_without_a_blend_in_the_colors_that_are_chosen(surfels_command, tmp_path):
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(20.0), np.arange(20.0)))
    np.savetxt(tmp_path / "scan.xyz", np.stack([x, y, x / 10], axis=1), fmt="%.3f")
    bpy.ops.wm.read_factory_settings(use_empty=True)
    out = tmp_path / "scan.surfelblocks"
    options = "--color-by", "height", "--neighbours", 8
    code, said = surfels_command("store", "--file", tmp_path / "scan.xyz", "--out", out, *options)
    assert code == 0 and "400 surfels" in said and "normals to face up" in said
    found = every_surfel(out)
    height = found.positions[:, 2]
    assert (found.normals[:, 2] > 0.9).all() and len(np.unique(np.round(found.colors, 3), axis=0)) > 10
    low, high = found.colors[height.argmin(), :3], found.colors[height.argmax(), :3]
    assert low.sum() < high.sum()


def test_classes_of_a_scan_are_stored_and_those_that_are_none_are_counted(surfels_command, tmp_path):
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(20.0), np.arange(20.0)))
    classes = np.where(x < 10, 2, 6)
    classes[:3] = 300, -1, 256
    np.savetxt(tmp_path / "scan.xyz", np.stack([x, y, 0 * x, classes], axis=1), fmt="%g")
    out, columns = tmp_path / "scan.surfelblocks", "x y z classification"
    code, said = surfels_command("store", "--file", tmp_path / "scan.xyz", "--out", out, "--columns", columns)
    assert code == 0 and "Took 0 as the classification of 3 points that have none" in said
    stream = Stream(out, 0)
    found = stream.seen(Sight(np.array([[0, 0, 0, 1.0]]), np.zeros(4), 1.0, 0.0, np.array([0, 0, 1.0, 0]), False, 0.0))
    assert stream.file.scan == {"classification": (0, 255)}
    assert np.bincount(found.gathered.scan["classification"]).tolist() == [3, 0, 197, 0, 0, 0, 200]


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (("--objects", "walls"), "no object 'walls'"),
        (("--objects", "camera"), "'camera' has no surface to convert"),
        (("--objects", "floor", "--spacing", 1e-9), "floor: "),
        (("--ply", "nowhere.ply"), "nowhere.ply: No such file"),
        (("--file", "bare.ply"), "1 usable points are too few"),
        (("--file", "bare.ply", "--resolution", 64), "--resolution is about objects and changes nothing of a file"),
    ],
)
def test_what_cannot_be_stored_leaves_nothing(arguments, sentence, animation, surfels_command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bare.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n"
        "0 0 0\n"
    )
    code, said = surfels_command("store", *arguments, "--out", "new.surfelblocks")
    assert code == 1 and sentence in said
    assert sorted(path.name for path in tmp_path.iterdir()) == ["anim.blend", "bare.ply"]


def test_a_wrong_name_and_surfels_in_a_file_are_refused(animation, surfels_command, tmp_path):
    assert (
        "is a .surfelblocks file, not 'new.ply'"
        in surfels_command("store", "--objects", "floor", "--out", tmp_path / "new.ply")[1]
    )
    bpy.context.view_layer.objects.active = bpy.data.objects["Sphere surfels"]
    bpy.ops.object.surfels_to_file()
    out = tmp_path / "new.surfelblocks"
    assert "in a file already" in surfels_command("store", "--objects", "Sphere surfels", "--out", out)[1]
    assert surfels_command("info", tmp_path / "anim.blend")[0] == 1
