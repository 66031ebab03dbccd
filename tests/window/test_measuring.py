# SPDX-License-Identifier: GPL-3.0-or-later
"""In a real Blender window a scene is measured while the interface goes on."""

import pytest


@pytest.mark.parametrize("in_a_window", ["opengl"], indirect=True)
def test_a_scene_is_measured_in_a_render_job(in_a_window):
    report, _ = in_a_window("measure_this_scene.py", "--window-geometry", "0", "0", "1200", "800")
    assert report["operator"] == ["FINISHED"] and report["is_given_back"]
    assert report["rows"][0] == "As set" and "Final, 4 x 4" in report["rows"]
