# SPDX-License-Identifier: GPL-3.0-or-later
"""Scans become surfels in the scene's coordinates, with what scanners measure as attributes, and go back."""

import bpy
import numpy as np
import pytest
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector

from scan_files.formats import las_file, ptx_scan
from splat_addon.blender import scan_look
from splat_addon.blender.conversion.file_import import FileImport, Reading
from splat_addon.blender.conversion.points_settings import PointsProperties
from splat_addon.blender.geometry.scan_attributes import write_scan_attributes
from splat_addon.blender.geometry.scene_offset import scene_offset
from splat_addon.interchange import ReadingCancelled, read_contents, write_ply
from splat_addon.rendering import SCAN_LOOK
from splat_addon.sampling import SamplingCancelled
from splat_addon.surfels import Surfels

FINE = (0.0001, 0.0001, 0.0001)
ROW = [("X", "<i4"), ("Y", "<i4"), ("Z", "<i4"), ("intensity", "<u2"), ("returns", "u1"), ("class", "u1")]
ROW += [("angle", "i1"), ("user", "u1"), ("source", "<u2"), ("gps_time", "<f8"), ("extra", "V0")]


def tile(corner):
    """A file of 20 by 20 points a metre apart, and (400, 3) their coordinates."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(20), np.arange(20)))
    rows = np.zeros(400, ROW)
    rows["X"], rows["Y"], rows["Z"] = 10000 * x + 1234, 10000 * y + 5, 10000 * np.sin(x)
    rows["intensity"], rows["returns"], rows["class"] = 7 * x, 1 + 8 * 2, 2 + x % 3
    rows["gps_time"] = 3e8 + 0.25 * y
    places = np.stack([rows[axis] * 0.0001 + start for axis, start in zip("XYZ", corner, strict=True)], 1)
    return las_file(rows, 1, 2, scale=FINE, offset=corner), places


CORNERS = (403000.0, 5604000.0, 90.0), (403020.0, 5604000.0, 90.0)


@pytest.fixture
def imported(tmp_path):
    """imported(corner) -> the object that the import of a tile makes, and its coordinates in the file."""

    def make(corner, **settings):
        data, places = tile(corner)
        (tmp_path / "tile").write_bytes(data)
        bpy.ops.import_scene.surfels_ply(filepath=str(tmp_path / "tile"), isolated="KEEP", **settings)
        return bpy.context.object, places

    return make


def test_two_tiles_meet_and_leave_as_they_came(imported, world_positions, tmp_path):
    made = [imported(corner) for corner in CORNERS]
    offset = scene_offset(bpy.context.scene)
    assert offset.tolist() == [403000, 5604000, 100]
    for each, places in made:
        assert np.abs(world_positions(each) + offset - places).max() < 1e-5
    bpy.ops.export_scene.surfels_ply(filepath=str(tmp_path / "out.ply"))
    left = read_contents(tmp_path / "out.ply").surfels
    assert np.abs(left.positions + left.origin - np.concatenate([places for _, places in made])).max() < 1e-5
    # what was exported comes back to its place, in this scene
    bpy.ops.import_scene.surfels_ply(filepath=str(tmp_path / "out.ply"))
    assert np.abs(world_positions(bpy.context.object)[:400] - world_positions(made[0][0])).max() < 1e-5


def test_a_file_near_the_origin_stays_there_in_a_scene_with_an_offset(imported, world_positions):
    imported(CORNERS[0])
    made, places = imported((3.0, 2.0, 1.0))
    assert np.abs(world_positions(made) - places).max() < 1e-5


def test_a_few_points_of_a_survey_meet_all_of_them(imported, world_positions):
    few, places = imported(CORNERS[0], most_points=20)
    made, all_places = imported(CORNERS[0])
    offset = scene_offset(bpy.context.scene)
    assert offset.any() and np.abs(world_positions(made) + offset - all_places).max() < 1e-5
    assert np.isclose(world_positions(few)[0] + offset, places, atol=1e-5).all(axis=1).any()


def test_several_files_come_in_at_once_and_those_that_cannot_be_read_are_named(world_positions, tmp_path):
    places = {}
    for name, corner in zip(("a.las", "b.las"), CORNERS, strict=True):
        data, places[name] = tile(corner)
        (tmp_path / name).write_bytes(data)
    (tmp_path / "c.las").write_bytes(b"LASF")
    files = [{"name": name} for name in ("a.las", "c.las", "b.las")]
    kept = {"directory": str(tmp_path), "isolated": "KEEP"}
    assert bpy.ops.import_scene.surfels_ply(files=files, **kept) == {"FINISHED"}
    made, offset = [bpy.data.objects[name] for name in ("a", "b")], scene_offset(bpy.context.scene)
    for each in made:
        assert np.abs(world_positions(each) + offset - places[f"{each.name}.las"]).max() < 1e-5
    with pytest.raises(RuntimeError, match=r"c\.las: The LAS file ends"):
        bpy.ops.import_scene.surfels_ply(files=files[1:2], **kept)


def test_of_a_series_whose_files_are_all_chosen_one_object_is_made(tmp_path):
    for number in (1, 2, 3):
        (tmp_path / f"walk{number}.las").write_bytes(tile(CORNERS[0])[0])
    files = [{"name": f"walk{number}.las"} for number in (1, 2, 3)]
    bpy.ops.import_scene.surfels_ply(directory=str(tmp_path), files=files, is_series=True, isolated="KEEP")
    assert [each.name for each in bpy.data.objects if each.type == "MESH"] == ["walk1"]


def test_a_survey_beside_surfels_that_have_no_offset_meets_them(imported, world_positions, tmp_path):
    there = Surfels(
        origin=np.array(CORNERS[0]), positions=np.zeros((1, 3), np.float32), rotations=np.float32([[1, 0, 0, 0]]),
        scales=np.ones((1, 2), np.float32), normals=np.float32([[0, 0, 1]]), colors=np.ones((1, 4), np.float32),
        materials=np.zeros(1, np.int32),
    )  # fmt: skip
    write_ply(tmp_path / "there.ply", there)
    bpy.ops.import_scene.surfels_ply(filepath=str(tmp_path / "there.ply"))
    made, places = imported(CORNERS[1])
    assert not scene_offset(bpy.context.scene).any()
    assert np.abs(world_positions(made) - places).max() < 1e-5


def test_a_scan_near_the_origin_gives_the_scene_no_offset(imported, world_positions):
    made, places = imported((300.0, 2.0, 1.0))
    assert not scene_offset(bpy.context.scene).any() and np.abs(world_positions(made) - places).max() < 1e-4


def values_of(mesh, name, dtype):
    attribute = mesh.attributes[name]
    values = np.empty(len(attribute.data), dtype)
    attribute.data.foreach_get("value", values)
    return attribute.data_type, values


def test_what_the_scanner_measured_arrives_as_attributes(imported):
    made, places = imported(CORNERS[0])
    x, y = np.rint(places[:, :2] - CORNERS[0][:2]).astype(int).T
    expected = {"intensity": 7 * x, "classification": 2 + x % 3, "return_number": 1 + 0 * x}
    for name, values in (expected | {"number_of_returns": 2 + 0 * x}).items():
        kind, found = values_of(made.data, name, np.int32)
        assert kind == "INT" and np.array_equal(found, values), name
    kind, times = values_of(made.data, "gps_time", np.float32)
    assert kind == "FLOAT" and np.array_equal(made.data["gps_time_start"] + times.astype(float), 3e8 + 0.25 * y)


def test_normals_face_the_scanner_that_the_file_names(surfels_of, tmp_path):
    """From inside, where they would face outward without its place."""
    random = np.random.default_rng(0)
    points = random.normal(size=(600, 3))
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    matrix = np.eye(4)
    matrix[:3, 3] = 4e5, 5e6, 0
    (tmp_path / "scan").write_text(ptx_scan(points, 20, matrix))
    bpy.ops.import_scene.surfels_ply(filepath=str(tmp_path / "scan"))
    surfels = surfels_of(bpy.context.object)
    inward = matrix[:3, 3] - scene_offset(bpy.context.scene) - bpy.context.object.location - surfels.positions
    assert (np.einsum("ij,ij->i", surfels.normals, inward) > 0.5).all()
    # and the camera stands where the scanner did
    camera = bpy.context.scene.camera
    assert np.abs(scene_offset(bpy.context.scene) + camera.location - matrix[:3, 3]).max() < 1e-4
    assert abs(camera.matrix_basis.to_3x3().col[2].z) < 1e-6


def test_the_first_scan_of_a_scene_gets_the_look_of_scans_and_a_camera_that_sees_it(imported):
    """The next one leaves all this as the user changed it."""
    scene = bpy.context.scene
    made, places = imported(CORNERS[0])
    settings = scene.surfel_splatting
    assert scene.render.engine == "SURFEL_SPLATTING" and scene.view_settings.view_transform == "Standard"
    assert settings.shading == SCAN_LOOK["shading"] and settings.use_eye_dome
    assert settings.eye_dome_radius == SCAN_LOOK["eye_dome"].radius
    bpy.context.view_layer.update()
    corners = [camera_places(scene, Vector(place - scene_offset(scene))) for place in places[:: len(places) - 1]]
    assert all(0 < x < 1 and 0 < y < 1 and z > 0 for x, y, z in corners)
    assert made.surfel_splatting.color_by == "INTENSITY"
    settings.shading, scene.camera = "phong", None
    imported(CORNERS[1])
    assert settings.shading == "phong" and scene.camera is not None


def test_the_camera_shows_thin_ends_of_a_scan_but_no_place_far_from_it(camera):
    x, y = (axis.ravel() for axis in np.meshgrid(np.linspace(-10, 10, 50), np.linspace(-10, 10, 50)))
    ends = [(-11.5, 0, 0), (11.5, 0, 0), (0, -11.5, 0)]
    some = np.concatenate([np.stack([x, y, 0 * x], axis=1), ends, [(500, 0, 0)]])
    scan_look._stand_in_front(bpy.context.scene, camera, some)
    bpy.context.view_layer.update()
    assert all(0 < x < 1 and 0 < y < 1 for x, y, _ in (camera_places(bpy.context.scene, Vector(end)) for end in ends))
    assert camera.location.length < 100


@pytest.mark.parametrize("middle", [(0, 0, 0), (300, 0, 0)])
def test_the_first_scan_keeps_a_camera_that_sees_it_and_gets_one_otherwise(camera, middle, tmp_path):
    camera.location = 0, 0, 20
    rows = (f"{middle[0] + x} {middle[1] + y} {middle[2]}" for x in range(-2, 3) for y in range(-2, 3))
    (tmp_path / "scan.xyz").write_text("\n".join(rows))
    bpy.ops.import_scene.surfels_ply(filepath=str(tmp_path / "scan.xyz"), isolated="KEEP")
    scene = bpy.context.scene
    assert (scene.camera == camera) == (middle == (0, 0, 0))
    bpy.context.view_layer.update()
    x, y, depth = camera_places(scene, Vector(middle))
    assert 0 < x < 1 and 0 < y < 1 and depth > 0


def camera_places(scene, place):
    """Where a place lies in the camera's picture: 0 to 1 across and up, and its depth."""
    return world_to_camera_view(scene, scene.camera, place)


def test_without_intensity_a_scan_without_colors_shows_its_height_and_with_colors_these(tmp_path):
    rows = [(x, y, 0.1 * x) for x in range(9) for y in range(9)]
    for name, color in (("bare.xyz", ""), ("red.xyz", " 200 10 10")):
        (tmp_path / name).write_text("".join(f"{x} {y} {z}{color}\n" for x, y, z in rows))
        bpy.ops.import_scene.surfels_ply(filepath=str(tmp_path / name), isolated="KEEP")
    assert [each.surfel_splatting.color_by for each in bpy.data.objects if each.type == "MESH"] == ["HEIGHT", "COLOR"]


@pytest.mark.parametrize("is_kept", [False, True])
def test_an_import_shows_the_height_that_was_chosen(is_kept, tmp_path):
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    (tmp_path / "a.xyz").write_text("".join(f"{k % 20} {k // 20} {k % 3} {k % 5}\n" for k in range(400)))
    choices = {"color_by": "HEIGHT", "keeps_in_file": is_kept, "isolated": "KEEP"}
    bpy.ops.import_scene.surfels_ply(filepath=str(tmp_path / "a.xyz"), text_columns="x y z intensity", **choices)
    made = bpy.context.object
    assert made.surfel_splatting.color_by == "HEIGHT" and bool(made.data.surfel_splatting.file) == is_kept


def test_views_show_all_of_a_large_scan(tmp_path):
    """Views of what is small keep what they have."""
    (view,) = (a.spaces.active for a in bpy.context.window.screen.areas if a.type == "VIEW_3D")
    before = view.clip_end
    for name, size in (("small.xyz", 1.0), ("large.xyz", 3000.0)):
        rows = (f"{x * size} {y * size} 0" for x in range(5) for y in range(5))
        (tmp_path / name).write_text("\n".join(rows))
        bpy.ops.import_scene.surfels_ply(filepath=str(tmp_path / name), isolated="KEEP")
        assert (view.clip_end == before) == (name == "small.xyz")
    assert view.clip_end > 2 * 12000


def test_without_the_look_an_import_changes_nothing_of_the_scene(imported):
    before = bpy.context.scene.render.engine
    made, _ = imported(CORNERS[0], has_scan_look=False)
    scene = bpy.context.scene
    assert scene.camera is None and scene.render.engine == before and not scene.surfel_splatting.use_eye_dome
    assert made.surfel_splatting.color_by == "COLOR"
    assert bpy.ops.render.surfel_scan_look() == {"FINISHED"} and scene.surfel_splatting.use_eye_dome


class Settings(PointsProperties):
    """The settings of an import as they are by default."""

    facing, neighbours, splat_size, isolated, finds_creases, flatness = "OUTWARD", 16, 1.25, "KEEP", False, 0.25
    flattens_noise, thins_overlaps = False, True


@pytest.mark.parametrize(("stage", "error"), [("Reading 400 points", ReadingCancelled), ("0%", SamplingCancelled)])
def test_esc_ends_reading_and_converting(stage, error, tmp_path):
    (tmp_path / "tile").write_bytes(tile(CORNERS[0])[0])
    work = FileImport(str(tmp_path / "tile"), Settings(), bpy.context.scene, Reading())

    def press(share):
        work.is_cancelled |= stage in work.status()

    with pytest.raises(error):
        work.run(press)
    assert not bpy.data.meshes and "cancelled" in work.cancelled()


def test_attributes_follow_the_points_that_became_surfels():
    mesh = bpy.data.meshes.new("scan")
    mesh.vertices.add(2)
    write_scan_attributes(mesh, {"intensity": np.array([0.5, 1.5, np.nan])}, np.array([0, 2]))
    kind, found = values_of(mesh, "intensity", np.float32)
    assert kind == "FLOAT" and found[0] == 0.5 and np.isnan(found[1])
