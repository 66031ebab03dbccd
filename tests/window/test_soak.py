# SPDX-License-Identifier: GPL-3.0-or-later
"""Memory stays constant over many frames and edits in a window.

SURFEL_SOAK=1000,200 plays the full count, about six minutes.
"""

import os
import statistics

import pytest

FRAMES = os.environ.get("SURFEL_SOAK", "90,45")

#: Megabytes by which the last third may exceed the middle one; the textures of one frame take 13.
GROWTH = 40
#: Megabytes that Blender 5.2 itself keeps after each render on Vulkan; a render by Workbench keeps 1.5 too.
VULKAN_KEEPS = 2.0
#: Blender keeps a wrapper of each geometry instance, here the surfels' points, whenever a script looks at it: in the
#: view and in the render. One texture, plan or mesh that stayed would be dozens of objects a frame.
OBJECTS_A_FRAME = 10


@pytest.fixture(scope="module")
def series(in_a_window):
    """The figures of a run of soak.py, one dictionary for each moment, without the memory that Blender itself keeps."""
    geometry = "--window-geometry", "0", "0", "520", "400"
    report, _ = in_a_window("soak.py", *geometry, SURFEL_SOAK=FRAMES)
    kept = VULKAN_KEEPS if report["backend"] == "VULKAN" else 0.0
    assert [report["frames"], report["edits"]] == [*map(int, FRAMES.split(","))]
    return [{**moment, "resident": moment["resident"] - kept * moment["frame"]} for moment in report["series"]]


def thirds(series, name):
    """The medians in the middle and in the last third; in the first, Blender still fills its caches."""
    values = [moment[name] for moment in series]
    third = len(values) // 3
    return statistics.median(values[third : 2 * third]), statistics.median(values[2 * third :])


@pytest.mark.parametrize(("name", "growth"), [("resident", GROWTH), ("textures", 3), ("meshes", 1)])
def test_memory_is_flat(series, name, growth):
    middle, last = thirds(series, name)
    assert last <= middle + growth


def test_python_s_objects_do_not_pile_up(series):
    middle, last = thirds(series, "objects")
    frames = (series[-1]["frame"] - series[0]["frame"]) / 3
    assert last - middle <= OBJECTS_A_FRAME * frames
