# SPDX-License-Identifier: GPL-3.0-or-later
"""A camera goes where the scanner went, as far as the file tells it."""

import bpy
import numpy as np
from mathutils import Matrix, Vector

from scan_files.formats import las_file, ptx_scan
from splat_addon.blender.geometry.scene_offset import scene_offset

CORNER = np.array([4e5, 5e6, 100.0])
FLIGHT = np.dtype(
    [
        *((axis, "<i4") for axis in "XYZ"),
        ("intensity", "<u2"),
        ("returns", "u1"),
        ("class", "u1"),
        ("angle", "i1"),
        ("user", "u1"),
        ("source", "<u2"),
        ("gps_time", "<f8"),
        ("extra", "V0"),
    ]
)


def seen(frame: float) -> tuple[np.ndarray, np.ndarray]:
    """The place of the scene's camera in the file's coordinates, and where it looks."""
    scene = bpy.context.scene
    scene.frame_set(int(frame), subframe=frame % 1)
    matrix = scene.camera.matrix_world
    return np.array(matrix.translation) + scene_offset(scene), -np.array(matrix.col[2].to_3d())


def read_ptx(path, places):
    """Import a file of scans from places, each of 400 points around it."""
    points = np.random.default_rng(0).normal(size=(400, 3))
    matrices = [np.array(Matrix.Translation(place)) for place in places]
    path.write_text("".join(ptx_scan(points, 20, matrix) for matrix in matrices))
    for matrix, place in zip(matrices, places, strict=True):
        matrix[:3, 3] = place
    bpy.ops.import_scene.surfels_ply(filepath=str(path), isolated="KEEP")


def test_it_goes_from_place_to_place_and_looks_ahead(tmp_path):
    places = CORNER + np.array([(0, 0, 1), (3, 0, 1), (3, 1, 2)])
    read_ptx(tmp_path / "rooms", places)
    bpy.context.scene.frame_start, bpy.context.scene.frame_end = 10, 50
    assert bpy.ops.object.surfels_scanner_camera() == {"FINISHED"}
    way = 3 + 2**0.5
    for frame, place, ahead in ((10, 0, (1, 0, 0)), (50, 2, (0, 1, 0)), (10 + 40 * 3 / way, 1, (0, 1, 0))):
        where, towards = seen(frame)
        assert np.abs(where - places[place]).max() < 0.1 and np.abs(towards - ahead).max() < 1e-3


def test_at_a_single_place_it_turns_around_once(tmp_path):
    read_ptx(tmp_path / "room", CORNER[None])
    bpy.context.object.location.z += 1  # it moves with the scan
    bpy.context.view_layer.update()
    bpy.ops.object.surfels_scanner_camera()
    found, quarter = [], (bpy.context.scene.frame_end - 1) / 4
    for k in range(5):
        where, towards = seen(1 + k * quarter)
        assert np.abs(where - CORNER - (0, 0, 1)).max() < 0.05 and abs(towards[2]) < 1e-4
        found.append(towards)
    assert np.abs(np.array(found) - [(0, 1, 0), (-1, 0, 0), (0, -1, 0), (1, 0, 0), (0, 1, 0)]).max() < 0.02


def test_a_flight_is_estimated_and_looks_at_the_scan(tmp_path):
    random = np.random.default_rng(1)
    times = np.sort(random.uniform(0, 6, 6000))
    places = np.array([0, 0, 500.0]) + times[:, None] * (40, 0, 0)
    angles = 0.3 * np.sin(300 * times)
    rows = np.zeros(12000, FLIGHT)
    for number, height in enumerate((random.uniform(5, 25, 6000), random.uniform(0, 5, 6000))):
        fall = places[:, 2] - height
        some = rows[number * 6000 : number * 6000 + 6000]
        for name, values in (("X", places[:, 0]), ("Y", fall * np.tan(angles)), ("Z", height)):
            some[name] = np.rint(1000 * values)
        some["returns"], some["gps_time"] = number + 1 + 8 * 2, 3e8 + times
    (tmp_path / "flight").write_bytes(las_file(rows, 1, 2, scale=(0.001,) * 3, offset=tuple(CORNER)))
    bpy.ops.import_scene.surfels_ply(filepath=str(tmp_path / "flight"), neighbours=6)
    bpy.ops.object.surfels_scanner_camera()
    for frame, x in ((1, 10), (bpy.context.scene.frame_end, 230)):
        where, towards = seen(frame)
        assert np.abs(where - CORNER - (x, 0, 500)).max() < 15
        to_middle = Vector(CORNER - where + (120, 0, 5)).normalized()
        assert np.abs(towards - to_middle).max() < 0.05
    # the scan reaches 240 x 300, and fills the picture from 500 above
    assert 170 < 500 * np.tan(bpy.context.scene.camera.data.angle / 2) * 9 / 16 < 230


def test_scans_whose_file_tells_no_place_or_that_are_empty_have_none(tmp_path):
    read_ptx(tmp_path / "room", CORNER[None])
    assert bpy.ops.object.surfels_scanner_camera.poll()
    bpy.context.object.data.clear_geometry()
    assert not bpy.ops.object.surfels_scanner_camera.poll()
    (tmp_path / "bare.xyz").write_text("".join(f"{x} {y} 0\n" for x in range(9) for y in range(9)))
    bpy.ops.import_scene.surfels_ply(filepath=str(tmp_path / "bare.xyz"))
    assert not bpy.ops.object.surfels_scanner_camera.poll()
