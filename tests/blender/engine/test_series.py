# SPDX-License-Identifier: GPL-3.0-or-later
"""A series of numbered files is an animation: each is read when its frame is shown, in memory one at a time."""

from pathlib import Path

import bpy
import numpy as np
import pytest

from splat_addon.blender.conversion.series import series_of

OFFSET = (403000.0, 5604000.0, 0.0)


@pytest.fixture
def series(scene, tmp_path, add_camera):
    """An object that shows the files 1, 2 and 4: squares of points at x = 0, 2 and 6 with survey coordinates."""
    add_camera(location=(3, 0, 12))
    scene.frame_start, scene.frame_end = 1, 5
    for number in (1, 2, 4):
        write(tmp_path / f"scan_{number:03}.xyz", 2 * number - 2, 12 + number)
    scene["surfels_scene_offset"] = OFFSET
    scene.frame_set(1)
    bpy.ops.import_scene.surfels_ply(filepath=str(tmp_path / "scan_004.xyz"), is_series=True, has_scan_look=False)
    return bpy.context.object


def write(path: Path, start: float, count: int) -> None:
    """A square of count x count points whose sides are 1."""
    x, y = (axis.ravel() for axis in np.meshgrid(*[np.linspace(0, 1, count)] * 2))
    np.savetxt(path, np.stack([x + start, y, 0 * x], 1) + OFFSET, fmt="%.4f")


def span(owner, world_positions):
    """The number of surfels, and their least world x."""
    positions = world_positions(owner)
    return len(positions), round(float(positions[:, 0].min()), 3) if len(positions) else None


@pytest.fixture
def world_positions():
    def read(owner) -> np.ndarray:
        values = np.empty(3 * len(owner.data.vertices), np.float32)
        if len(values):
            owner.data.attributes["position"].data.foreach_get("vector", values)
        return values.reshape(-1, 3) + np.array(owner.matrix_world.translation)

    return read


def test_each_frame_shows_its_file_and_the_ends_stay(series, scene, world_positions):
    assert span(series, world_positions) == (13 * 13, 0)
    for frame, expected in ((2, (14 * 14, 2)), (4, (16 * 16, 6)), (5, (16 * 16, 6)), (0, (13 * 13, 0))):
        scene.frame_set(frame)
        assert span(series, world_positions) == expected


def test_moments_around_a_frame_are_its_own(series, scene, world_positions):
    for frame, subframe in ((1, 0.75), (2, 0.25)):
        scene.frame_set(frame, subframe=subframe)
        assert span(series, world_positions) == (14 * 14, 2)


def test_an_object_that_moves_keeps_its_motion(series, scene, world_positions):
    series.location.x += 10
    scene.frame_set(2)
    bpy.context.view_layer.update()
    assert span(series, world_positions) == (14 * 14, 12)


def test_renders_show_each_frame_and_stop_where_a_file_is_missing(series, scene, picture):
    left = []
    for frame in (2, 4):
        scene.frame_set(1)
        scene.frame_current = frame  # a render reads it by itself, as the command line's do
        alpha = picture()[..., 3]
        left.append(np.flatnonzero(alpha.max(axis=0) > 0.5).min() / alpha.shape[1])
    assert left[1] > left[0] + 0.1
    scene.frame_set(3)
    assert not len(series.data.vertices)
    scene.surfel_splatting.broken_objects = "STOP"
    with pytest.raises(RuntimeError, match="no file number 3, though there are 1 to 4"):
        bpy.ops.render.render()
    scene.frame_set(4)
    assert len(series.data.vertices) == 16 * 16 and not series_of(series.data).why_not


def test_a_file_that_changed_and_an_offset_are_read_again(series, scene, tmp_path, world_positions):
    write(tmp_path / "scan_001.xyz", 0, 20)
    scene.frame_set(1)
    assert span(series, world_positions) == (400, 0)
    series_of(series.data).frame_offset = -1
    assert span(series, world_positions) == (14 * 14, 2)


def test_numbers_that_are_no_frames_begin_with_the_first_one(scene, tmp_path):
    for number in (901, 902):
        write(tmp_path / f"{number}.xyz", 0, 12)
    scene.frame_set(1)
    bpy.ops.import_scene.surfels_ply(filepath=str(tmp_path / "902.xyz"), is_series=True)
    made = series_of(bpy.context.object.data)
    assert (made.frame_offset, made.why_not) == (-900, "") and scene.render.use_lock_interface


def test_what_cannot_be_a_series_is_told(scene, tmp_path):
    write(tmp_path / "room.xyz", 0, 12)
    with pytest.raises(RuntimeError, match="no number that counts"):
        bpy.ops.import_scene.surfels_ply(filepath=str(tmp_path / "room.xyz"), is_series=True)
    with pytest.raises(RuntimeError, match="cannot be files of blocks"):
        bpy.ops.import_scene.surfels_ply(filepath=str(tmp_path / "r1.surfelblocks"), is_series=True)
