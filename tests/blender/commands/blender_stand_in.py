# SPDX-License-Identifier: GPL-3.0-or-later
"""Stands in for Blender's command line where the tests run on the wheel: it understands what the templates use.

The form is `--background FILE --command NAME ARGUMENTS`.
"""

import runpy
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT))


def run() -> int:
    import bpy

    import splat_addon
    from splat_addon.blender import commands

    background, file, command, name, *arguments = sys.argv[1:]
    assert (background, command, name) == ("--background", "--command", "surfels")
    splat_addon.register()
    bpy.ops.wm.open_mainfile(filepath=file)
    return commands.run(arguments)


leaving = runpy.run_path(str(ROOT / "scripts" / "environment" / "leaving.py"))
leaving["run_and_leave"](run)
