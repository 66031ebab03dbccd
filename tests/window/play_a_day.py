# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: a user's day with the installed extension, from the default scene to reopening a file.

test_a_day.py reads the report. Pictures of the window are saved on the way, and docs/guide.md shows some of them.
"""

import os
import subprocess
import sys
from pathlib import Path

import bpy
from mathutils import Quaternion

sys.path.insert(0, str(Path(__file__).resolve().parent))

from steps import REPORT, in_view, open_sidebar, play, show_tab, smooth_and_red, view3d

MODULE = "bl_ext.user_default.surfel_splatting"
PACKAGE = os.environ["SURFEL_PACKAGE"]
FILE = REPORT.with_suffix(".blend")
PATIENCE = 120  # polls of half a second
#: Samples of the pictures that are compared with each other; the guide's has those of a new scene.
FEW = 2

drawn = []


def watch_drawing():
    """Record a view's number of samples whenever the installed extension has drawn it."""
    viewport = sys.modules[f"{MODULE}.splat_addon.blender.engine.viewport"]
    draw = viewport.draw

    def noting(engine, *arguments):
        draw(engine, *arguments)
        drawn.append(engine.surfel_state.refinement.samples)

    viewport.draw = noting


def at_rest():
    """Wait until the view has been drawn again and has all its samples."""
    drawn.clear()
    view3d()[0].tag_redraw()

    def is_at_rest():
        return drawn and drawn[-1] == bpy.context.scene.surfel_splatting.viewport_samples

    yield from until(is_at_rest)
    yield 0.5


def shot(name: str) -> None:
    """Save a picture of the whole screen, because Blender's own picture of its window is black on OpenGL."""
    subprocess.run(["import", "-window", "root", REPORT.with_name(f"{REPORT.stem}_{name}.png")], check=True)


def surfel_object():
    """Look up the surfel object each time, because undo and opening a file free Python's references."""
    return next((o for o in bpy.data.objects if o.name.endswith(" surfels")), None)


def until(condition):
    for _ in range(PATIENCE):
        yield 0.5
        if condition():
            return
    raise TimeoutError(f"it did not happen: {condition.__name__}")


def build_scene():
    """Replace the cube with Suzanne on a floor, a large lamp, and a camera."""
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    with in_view():
        bpy.ops.mesh.primitive_plane_add(size=8, location=(0, 0, -1))
        bpy.ops.mesh.primitive_monkey_add(size=2)
        smooth_and_red((0.8, 0.1, 0.05, 1))
    lamp = bpy.data.objects["Light"]
    lamp.location, lamp.data.energy, lamp.data.shadow_soft_size = (3, -3, 4), 600, 0.5
    camera = bpy.context.scene.camera
    camera.location, camera.rotation_euler = (3.2, -4.2, 2.2), (1.15, 0, 0.65)
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y = 320, 240


def is_converted():
    return surfel_object() is not None


def convert():
    """Convert the selection as a press of the button does."""
    with in_view():
        result = bpy.ops.object.surfels_from_mesh("INVOKE_DEFAULT", resolution=128, density="RESOLUTION")
    assert result == {"RUNNING_MODAL"}, result


def look_through_camera():
    view3d()[0].spaces[0].region_3d.view_perspective = "CAMERA"


def show():
    """Press the button that the sidebar offers after a conversion, and after opening a file, which Blender shows as
    Solid.
    """
    view3d()[0].spaces[0].overlay.show_overlays = False
    with in_view():
        bpy.ops.view3d.surfels_show()


def orbit():
    view = view3d()[0].spaces[0].region_3d
    view.view_perspective = "PERSP"
    view.view_rotation = Quaternion((0, 0, 1), 0.4) @ view.view_rotation


def edit():
    """Turn the surfels in edit mode."""
    made = surfel_object()
    bpy.context.view_layer.objects.active = made
    made.select_set(True)
    with in_view():
        bpy.ops.object.mode_set(mode="EDIT")
        bpy.ops.mesh.select_all(action="SELECT")
        bpy.ops.transform.rotate(value=0.6, orient_axis="Z")
        bpy.ops.object.mode_set(mode="OBJECT")
        bpy.ops.ed.undo_push(message="turned")


def undo(times: int):
    with in_view():
        for _ in range(times):
            bpy.ops.ed.undo()


def first_x():
    return round(surfel_object().data.vertices[0].co.x, 4)


def steps():
    """Yields the seconds to wait after each step, and returns the report."""
    facts = {}
    bpy.ops.extensions.package_install_files(repo="user_default", filepath=PACKAGE, enable_on_install=True)
    watch_drawing()
    build_scene()
    open_sidebar()
    yield 1.0
    bpy.ops.ed.undo_push(message="scene")
    show_tab("Surfels")
    yield 3.0  # the panel grows by the prediction
    shot("before")
    convert()
    yield from until(is_converted)
    yield 1.0
    shot("converted")
    look_through_camera()
    show()
    yield from at_rest()
    shot("guide")
    bpy.context.scene.surfel_splatting.samples = bpy.context.scene.surfel_splatting.viewport_samples = FEW
    yield from at_rest()
    shot("shown")

    orbit()
    yield from at_rest()
    shot("orbited")
    look_through_camera()
    yield from at_rest()
    shot("orbited_and_back")

    bpy.ops.ed.undo_push(message="shown")
    facts["x"] = [first_x()]
    edit()
    facts["x"].append(first_x())
    yield from at_rest()
    shot("edited")
    undo(1)
    yield from at_rest()
    facts["x"].append(first_x())
    shot("undone")

    rendered = []
    bpy.app.handlers.render_complete.append(lambda *_: rendered.append(True))
    with in_view():
        bpy.ops.render.render("INVOKE_DEFAULT")

    def is_rendered():
        return bool(rendered)

    yield from until(is_rendered)
    yield 1.0
    picture = REPORT.with_name(f"{REPORT.stem}_f12.png")
    bpy.data.images["Render Result"].save_render(str(picture))
    for window in list(bpy.context.window_manager.windows)[1:]:
        with bpy.context.temp_override(window=window):
            bpy.ops.wm.window_close()
    yield from at_rest()
    shot("after_f12")

    bpy.ops.wm.save_as_mainfile(filepath=str(FILE))
    bpy.ops.wm.open_mainfile(filepath=str(FILE))
    yield 1.0
    show()
    yield from at_rest()
    shot("opened_again")

    bpy.ops.preferences.addon_disable(module=MODULE)
    yield 1.0
    facts["left"] = [name for name in ("surfel_splatting", "surfel_conversion") if hasattr(bpy.types.Scene, name)]
    bpy.ops.preferences.addon_enable(module=MODULE)
    watch_drawing()
    yield 1.0
    show()
    yield from at_rest()
    shot("enabled_again")
    facts["engine"] = bpy.context.scene.render.engine
    return facts


play(steps(), and_quit=True)
