# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by the scripts inside a Blender window: access to the 3D view, and waiting for what has to happen there.

The scripts find this module because their folder is on the path. They wait for events and never for a time, so that
it does not matter how fast the machine is or what else it does.
"""

import json
import subprocess
import sys
import time
import traceback
from pathlib import Path

import bpy

ROOT = Path(__file__).resolve().parents[2]
#: The report is written as JSON to the file named after `--`.
REPORT = Path(sys.argv[sys.argv.index("--") + 1])
#: Seconds between two looks at whether something has happened.
POLL = 0.05
#: Seconds after which what has not happened never will: a run that hangs ends with an error that says where.
PATIENCE = 300


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


def surfel_objects() -> list[bpy.types.Object]:
    """What conversions made. Look it up each time: undo and opening a file free Python's references."""
    return [made for made in bpy.data.objects if made.name.endswith(" surfels")]


def until(happened, what: str):
    """Wait until happened() is true. Raises TimeoutError with `what` if it never is."""
    end = time.monotonic() + PATIENCE
    while not happened():
        if time.monotonic() > end:
            raise TimeoutError(f"it did not happen: {what}")
        yield POLL


def redrawn():
    """Wait until everything in the window has been drawn, and once more with what the first drawing has changed."""
    drawn = []
    handler = bpy.types.SpaceView3D.draw_handler_add(lambda: drawn.append(True), (), "WINDOW", "POST_PIXEL")
    try:
        for _ in range(2):
            drawn.clear()
            for area in bpy.context.window_manager.windows[0].screen.areas:
                area.tag_redraw()
            yield from until(lambda: drawn, "the window is drawn")
    finally:
        bpy.types.SpaceView3D.draw_handler_remove(handler, "WINDOW")


def is_modal() -> bool:
    """Whether an operator is running in the window."""
    return len(bpy.context.window_manager.windows[0].modal_operators) > 0


def converted():
    """Wait until the conversion that runs in the window has made its surfels and has ended."""
    yield from until(lambda: surfel_objects() and not is_modal(), "the conversion ends")


def draw_at_once() -> None:
    """Draw each sample of the view in one call: in slices, a machine with other work draws the window more often."""
    bpy.context.scene.surfel_splatting.viewport_rate = 0


def watched(draw, drawn: list):
    """A view's function `draw` that also notes, after each call, how many samples its picture has."""

    def noting(engine, *arguments):
        draw(engine, *arguments)
        drawn.append(engine.surfel_state.refinement.samples)

    return noting


def at_rest(drawn: list, samples: int | None = None):
    """Wait until the watched view has been drawn again, has all its samples, and is seen in the window."""
    drawn.clear()
    view3d()[0].tag_redraw()
    all_of_them = samples or bpy.context.scene.surfel_splatting.viewport_samples
    yield from until(lambda: drawn and drawn[-1] == all_of_them, f"the view has {all_of_them} samples")
    yield from redrawn()


def shot(name: str) -> None:
    """Save a picture of the whole screen, because Blender's own picture of its window is black on OpenGL."""
    subprocess.run(["import", "-window", "root", REPORT.with_name(f"{REPORT.stem}_{name}.png")], check=True)


def play(steps) -> None:
    """Run a generator from a timer as soon as the window has been drawn, write the report that it returns, and quit.

    It yields the seconds after which it is to go on.
    """
    bpy.context.preferences.view.show_tooltips = False  # wherever the pointer rests, pictures are the same
    bpy.context.preferences.view.show_splash = False

    def whole():
        yield from redrawn()
        return (yield from steps)

    running = whole()

    def run():
        try:
            return next(running)
        except StopIteration as end:
            report = end.value
        except Exception:
            report = {"error": traceback.format_exc()}
        REPORT.write_text(json.dumps(report), encoding="utf-8")
        bpy.ops.wm.quit_blender()
        return None

    bpy.app.timers.register(run, persistent=True)
