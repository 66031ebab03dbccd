# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: clicks from the file of a scan to a rendered picture, in the default scene.

test_first_picture.py reads the report: the clicks, and what they made.
"""

import sys
from pathlib import Path

import bpy
import numpy as np

sys.path[:0] = [str(Path(__file__).resolve().parents[2]), str(Path(__file__).resolve().parent)]

from steps import REPORT, in_view, is_modal, play, redrawn, until, view3d  # noqa: E402

import splat_addon  # noqa: E402
from splat_addon.blender.engine import final_render  # noqa: E402

#: The height of the pointer in the window: the dialog is as high as the window, and its buttons are at the lower edge.
OVER_THE_BUTTON = 27


def scan() -> Path:
    """A file of points on a sphere where no camera of the default scene sees it, with bright and dark sides."""
    points = np.random.default_rng(2).normal(size=(4000, 3))
    points *= 30 / np.linalg.norm(points, axis=1, keepdims=True)
    colors = np.clip(128 + 4 * points, 0, 255)
    file = REPORT.with_name("scan.xyz")
    np.savetxt(file, np.hstack([points + np.array((200, 100, 0)), colors]), "%.3f %.3f %.3f %d %d %d")
    return file


def steps():
    """Yields the seconds to wait after each step, and returns the report."""
    bpy.context.scene.render.resolution_percentage = 15
    file, window, area = scan(), bpy.context.window_manager.windows[0], view3d()[0]
    pointer = {"x": area.x + area.width // 2, "y": OVER_THE_BUTTON}
    window.event_simulate("MOUSEMOVE", "NOTHING", **pointer)
    yield from redrawn()
    clicks = ["the file, dropped on the view", "Import", "F12"]
    with in_view():
        bpy.ops.wm.drop_import_file("INVOKE_DEFAULT", directory=str(file.parent), files=[{"name": file.name}])
    yield from redrawn()
    for kind, value in (("MOUSEMOVE", "NOTHING"), ("LEFTMOUSE", "PRESS"), ("LEFTMOUSE", "RELEASE")):
        window.event_simulate(kind, value, **pointer)
        yield from redrawn()
    yield from until(lambda: "scan" in bpy.data.objects and not is_modal(), "the file is imported")
    with in_view():
        bpy.ops.render.render()
    shown = REPORT.with_name(f"{REPORT.stem}_file.png")
    bpy.data.images["Render Result"].save_render(str(shown))
    return {"clicks": clicks, "surfels": final_render.last_frame_stats["splats"], "picture": str(shown)}


splat_addon.register()
play(steps())
