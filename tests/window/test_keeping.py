# SPDX-License-Identifier: GPL-3.0-or-later
"""Esc cancels Keep in a File while it writes, and leaves Blender and the disk as they were."""

import pytest

#: Keys and files are the same with every driver.
pytestmark = pytest.mark.parametrize("in_a_window", ["opengl"], indirect=True)


def test_esc_cancels_keeping_surfels_in_a_file(in_a_window):
    report, _ = in_a_window("keep_in_a_file.py", "--enable-event-simulate", "--window-geometry", "0", "0", "800", "600")
    before = ["Camera", "Cube", "Light"]
    running = ["IMPORT_SCENE_OT_surfels_ply"]
    assert report["cancelled"] == [running, ["scan.ply", "scene.blend"], before, 1]
    assert report["kept"] == [running, ["scan.ply", "scan.surfelblocks", "scene.blend"], [*before, "scan"], 2]
