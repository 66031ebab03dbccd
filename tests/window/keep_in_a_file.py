# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: imports a PLY with Keep in a File twice, and presses Esc the first time.

test_keeping.py reads the report.
"""

import sys
import threading
import time
from pathlib import Path

import bpy

sys.path[:0] = [str(Path(__file__).resolve().parents[2]), str(Path(__file__).resolve().parent)]

from steps import REPORT, in_view, is_modal, play, redrawn, until  # noqa: E402

import splat_addon  # noqa: E402
from splat_addon.blender.operators import modal_work  # noqa: E402
from splat_addon.interchange import write_ply  # noqa: E402
from splat_addon.reference import scenes  # noqa: E402

COUNT = 100_000
FOLDER = REPORT.with_suffix("")


may_end = threading.Event()
write_blocks = modal_work.write_blocks


def write_held(path, parts, progress, expected):
    """Write as usual, but the first step lasts until `may_end` or Esc, so that no machine is too fast for the key."""

    def held(share, step):
        while progress(share, step) and not may_end.is_set():
            time.sleep(0.05)
        return progress(share, step)

    write_blocks(path, parts, held, expected=expected)


def press(window, key):
    for value in ("PRESS", "RELEASE"):
        window.event_simulate(type=key, value=value, x=400, y=300)


def files():
    return sorted(path.name for path in FOLDER.iterdir())


def steps():
    """Yields the seconds to wait after each step, and returns the report."""
    FOLDER.mkdir(exist_ok=True)
    for path in FOLDER.iterdir():
        path.unlink()
    report, window = {}, bpy.context.window_manager.windows[0]
    bpy.ops.wm.save_as_mainfile(filepath=str(FOLDER / "scene.blend"))
    write_ply(FOLDER / "scan.ply", scenes.torus(COUNT)[0].surfels[0].surfels)
    modal_work.write_blocks = write_held
    for name in ("cancelled", "kept"):
        may_end.clear()
        with in_view():
            bpy.ops.import_scene.surfels_ply(
                "INVOKE_DEFAULT", True, filepath=str(FOLDER / "scan.ply"), keeps_in_file=True
            )
        yield from redrawn()
        press(window, "RET")  # confirms the dialog
        yield from until(is_modal, "the dialog is confirmed")
        running = [operator.bl_idname for operator in window.modal_operators]
        if name == "cancelled":
            press(window, "ESC")
        else:
            may_end.set()
        yield from until(lambda: not is_modal(), f"the import is {name}")
        may_end.set()
        report[name] = running, files(), [owner.name for owner in bpy.data.objects], len(bpy.data.meshes)
    return report


splat_addon.register()
play(steps())
