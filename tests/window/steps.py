# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by the scripts inside a Blender window: access to the 3D view, and steps between which the window is redrawn.

The scripts find this module because their folder is on the path.
"""

import json
import sys
import traceback
from pathlib import Path

import bpy

ROOT = Path(__file__).resolve().parents[2]
#: The report is written as JSON to the file named after `--`.
REPORT = Path(sys.argv[sys.argv.index("--") + 1])


def view3d():
    """The 3D view's area and its window region."""
    area = next(a for a in bpy.context.window_manager.windows[0].screen.areas if a.type == "VIEW_3D")
    return area, next(r for r in area.regions if r.type == "WINDOW")


def in_view():
    """A context override as if the mouse were over the 3D view."""
    area, region = view3d()
    return bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=area, region=region)


def open_sidebar() -> None:
    """Open the sidebar; its tabs exist once the window has been drawn."""
    view3d()[0].spaces[0].show_region_ui = True


def show_tab(category: str) -> None:
    area, _ = view3d()
    next(region for region in area.regions if region.type == "UI").active_panel_category = category
    area.tag_redraw()


def smooth_and_red(color: tuple[float, ...]) -> None:
    """Make the active object smooth and red, with four times as many faces."""
    made = bpy.context.object
    made.modifiers.new("Subdivision", "SUBSURF").levels = 2
    bpy.ops.object.shade_smooth()
    material = bpy.data.materials.new("Red")
    material.use_nodes = True
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = color
    made.data.materials.append(material)


def play(steps, and_quit: bool = False) -> None:
    """Run a generator from a timer; it yields the seconds to wait before the next step, and returns the report."""
    bpy.context.preferences.view.show_tooltips = False  # wherever the pointer rests, pictures are the same

    def run():
        try:
            return next(steps)
        except StopIteration as end:
            report = end.value
        except Exception:
            report = {"error": traceback.format_exc()}
        REPORT.write_text(json.dumps(report), encoding="utf-8")
        if and_quit or "error" in report:
            bpy.ops.wm.quit_blender()
        return None

    bpy.context.preferences.view.show_splash = False
    bpy.app.timers.register(run, first_interval=1.0, persistent=True)
