# SPDX-License-Identifier: GPL-3.0-or-later
"""An object whose surfels are in a file is rendered from the file; where that is missing, its coarsest surfels are
drawn and a warning says so.
"""

from dataclasses import replace

import bpy
import numpy as np
import pytest

from splat_addon.blender import preferences
from splat_addon.blender.engine import final_render
from splat_addon.blender.geometry import surfel_files
from splat_addon.rendering.presets import SCAN_LOOK
from splat_addon.streaming import Stream, write_blocks


@pytest.fixture
def stored(scene, add_surfels, add_camera, tmp_path, monkeypatch):
    """An object of a wavy sheet of 6,400 surfels in a file; it keeps some hundred of them."""
    monkeypatch.setattr(surfel_files, "KEPT", 200)
    add_camera((0, 0, 6))
    x, y = (axis.ravel() for axis in np.meshgrid(*[np.linspace(-1, 1, 80)] * 2))
    colors = np.stack([(np.floor(4 * x) + np.floor(4 * y)) % 2, 0 * x + 0.5, 0.5 + 0.5 * y, 0 * x + 1], axis=1)
    made = add_surfels(np.stack([x, y, 0.2 * np.sin(3 * x)], axis=1), size=0.03, colors=colors, name="sheet")
    scene.surfel_splatting.detail_tolerance = 0.0
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    return made


def test_it_looks_as_it_did_in_the_blend(stored, picture):
    before = picture()
    bpy.ops.object.surfels_to_file()
    after = picture()
    assert len(stored.data.vertices) <= 200
    assert final_render.last_frame_stats["splats"] == 6400 and not final_render.last_frame_stats["notes"]
    assert before[..., 3].max() > 0.99 and np.abs(after - before).max() < 1e-3


def test_a_moved_object_whose_file_has_an_origin(stored, picture, surfels_of, tmp_path):
    far = replace(surfels_of(stored), origin=(1e4, 2e4, -5e3))
    stored.location, stored.rotation_euler.z, stored.scale.x = (0.3, 0.2, 0.5), 0.4, 0.8
    before = picture()
    write_blocks(tmp_path / "far.surfelblocks", [far])
    bpy.ops.import_scene.surfels_ply(filepath=str(tmp_path / "far.surfelblocks"))
    assert tuple(bpy.context.object.location) == (1e4, 2e4, -5e3)
    bpy.context.object.matrix_world = stored.matrix_world
    stored.hide_render = True
    after = picture()
    assert final_render.last_frame_stats["splats"] == 6400 and np.abs(after - before).max() < 1e-3


@pytest.mark.parametrize("ends", [None, (0.2, 0.8)])
def test_it_is_coloured_by_height_as_in_the_blend(ends, stored, picture):
    stored.location, stored.rotation_euler.x = (0.1, 0.2, 0.5), 0.4
    settings = stored.surfel_splatting
    settings.color_by, settings.color_is_automatic = "HEIGHT", ends is None
    settings.color_from, settings.color_to = ends or (0, 1)
    before = picture()
    bpy.ops.object.surfels_to_file()
    after = picture()
    assert final_render.last_frame_stats["splats"] == 6400 and not final_render.last_frame_stats["notes"]
    assert np.ptp(before[..., :3], axis=2).max() > 0.1
    assert np.abs(after - before).max() < (1e-3 if ends else 0.1)  # the 49 that are kept give an automatic range
    settings.color_by = "CLASSIFICATION"
    picture()
    (note,) = final_render.last_frame_stats["notes"]
    assert "its file holds no classification" in note


@pytest.mark.parametrize("kind", ["INTENSITY", "CLASSIFICATION", "ATTRIBUTE", "COLOR"])
def test_a_scan_is_coloured_by_what_was_measured_as_in_the_blend(kind, scene, add_camera, picture, tmp_path):
    """The file that an import kept it in has its own colours, intensity and classes."""
    add_camera((0, 0, 6))
    scene.surfel_splatting.shading, scene.surfel_splatting.detail_tolerance = SCAN_LOOK["shading"], 0.0
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    x, y = (axis.ravel() for axis in np.meshgrid(*[np.linspace(-1, 1, 30)] * 2))
    rows = [x, y, 0 * x, 200 + 50 * x, 90 + 0 * x, 100 - 90 * y, 1000 * x * x + 7, np.where(y > 0.3, 2, 6)]
    np.savetxt(tmp_path / "a.xyz", np.stack(rows, axis=1), fmt="%.4f")
    names, pictures = "x y z red green blue intensity classification", []
    for is_kept in (False, True):
        given = {"text_columns": names, "keeps_in_file": is_kept, "isolated": "KEEP", "has_scan_look": False}
        given["color_by"] = "COLOR" if kind == "ATTRIBUTE" else kind
        bpy.ops.import_scene.surfels_ply(filepath=str(tmp_path / "a.xyz"), **given)
        made = bpy.context.object
        if kind == "ATTRIBUTE":
            made.surfel_splatting.color_by, made.surfel_splatting.color_attribute = kind, "intensity"
        assert bool(made.data.surfel_splatting.file) == is_kept and made.surfel_splatting.color_by == kind
        pictures.append(picture())
        assert final_render.last_frame_stats["splats"] == 900 and not final_render.last_frame_stats["notes"]
        made.hide_render = True
    before, after = pictures
    assert np.ptp(before[before[..., 3] > 0.9][:, :3], axis=0).max() > 0.3
    assert np.abs(after - before).max() < 0.02
    if kind == "ATTRIBUTE":
        made.hide_render, settings = False, made.surfel_splatting
        settings.color_is_automatic, settings.color_to = False, 5000
        picture()
        (note,) = final_render.last_frame_stats["notes"]
        assert "its file holds intensity from 8.1" in note


def test_without_its_file_the_coarsest_are_drawn_with_a_warning(stored, picture, tmp_path):
    bpy.ops.object.surfels_to_file()
    (tmp_path / "sheet.surfelblocks").unlink()
    shown = picture()
    (note,) = final_render.last_frame_stats["notes"]
    assert "sheet is drawn with its coarsest surfels only" in note and "No such file" in note
    assert shown[16, 16, 3] > 0.5 and final_render.last_frame_stats["splats"] == len(stored.data.vertices)


def damage(path):
    """Change what is in the middle of a file, where no roots are."""
    data = bytearray(path.read_bytes())
    data[100_000:200_000] = bytes(100_000)
    path.write_bytes(data)


def test_what_is_damaged_in_a_file_is_drawn_coarser_with_a_warning(stored, picture, tmp_path):
    bpy.ops.object.surfels_to_file()
    damage(tmp_path / "sheet.surfelblocks")
    shown = picture()
    assert final_render.last_frame_stats["notes"] == [
        "sheet is coarser than it should be. sheet.surfelblocks is damaged: some of its blocks have wrong checksums or "
        "numbers; copy or store it again."
    ]
    assert shown[13:19, 13:19, 3].min() > 0.5 and 1000 < final_render.last_frame_stats["splats"] < 6400


def test_a_file_that_is_cut_off_while_it_is_read_is_drawn_coarsely_with_a_warning(
    stored, picture, tmp_path, monkeypatch
):
    bpy.ops.object.surfels_to_file()
    path = tmp_path / "sheet.surfelblocks"

    def begin(stream):
        path.write_bytes(b"")
        original(stream)

    original = Stream.begin_frame
    monkeypatch.setattr(Stream, "begin_frame", begin)
    shown = picture()
    (note,) = final_render.last_frame_stats["notes"]
    assert "sheet.surfelblocks was changed while it was read" in note and shown[16, 16, 3] > 0.5


def test_a_background_render_stops_where_a_file_is_damaged(scene, stored, tmp_path):
    bpy.ops.object.surfels_to_file()
    damage(tmp_path / "sheet.surfelblocks")
    scene.surfel_splatting.broken_objects = "STOP"
    with pytest.raises(RuntimeError, match=r"sheet is coarser than it should be\. sheet\.surfelblocks is damaged"):
        bpy.ops.render.render()


def test_a_background_render_stops_where_the_file_is_missing(scene, stored, tmp_path):
    bpy.ops.object.surfels_to_file()
    (tmp_path / "sheet.surfelblocks").write_bytes(b"damaged")
    scene.surfel_splatting.broken_objects = "STOP"
    with pytest.raises(RuntimeError, match="not a file of surfels in blocks"):
        bpy.ops.render.render()


def test_too_little_memory_is_said(stored, picture, monkeypatch):
    bpy.ops.object.surfels_to_file()
    monkeypatch.setattr("splat_addon.blender.export.streams.stream_bytes", lambda: 0)
    monkeypatch.setattr("splat_addon.streaming.pages._FEWEST", 1)
    picture()
    assert final_render.last_frame_stats["notes"] == [
        "sheet is coarser than it should be; raise Memory of a Surfel File in the preferences"
    ]


def test_modifiers_are_not_followed_and_a_note_says_so(stored, picture):
    bpy.ops.object.surfels_to_file()
    stored.modifiers.new("Wave", "WAVE")
    picture()
    assert any("do not follow Wave" in note for note in final_render.last_frame_stats["notes"])


@pytest.mark.parametrize("is_whole", [True, False])
def test_it_is_held_out_as_a_whole_or_a_note_says_that_it_is_not(stored, picture, is_whole):
    """Both slots are in use; both or the second are a Holdout."""
    numbers = np.arange(6400, dtype=np.int32) % 2
    stored.data.attributes["material"].data.foreach_set("value", numbers)
    plain, hole = (bpy.data.materials.new(name) for name in ("plain", "hole"))
    if bpy.app.version < (5, 0, 0):
        plain.use_nodes = hole.use_nodes = True
    tree = hole.node_tree
    tree.links.new(tree.nodes.new("ShaderNodeHoldout").outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    for material in (hole if is_whole else plain, hole):
        stored.data.materials.append(material)
    bpy.ops.object.surfels_to_file()
    shown = picture()
    assert final_render.last_frame_stats["splats"] == 6400 and shown[16, 16, 3] == (0 if is_whole else 1)
    said = "sheet cuts no hole, as its surfels come from a file and only some of its materials are a Holdout"
    assert final_render.last_frame_stats["notes"] == ([] if is_whole else [said])


def test_the_budget_is_the_preference():
    assert preferences.stream_bytes() == 512_000_000
