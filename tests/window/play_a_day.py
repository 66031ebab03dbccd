# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: a user's day with the installed extension, from the default scene to reopening a file.

test_a_day.py reads the report. Pictures of the window are saved on the way, and docs/guide.md shows some of them.
"""

import os
import sys
from pathlib import Path

import bpy
import gpu
from mathutils import Quaternion

sys.path.insert(0, str(Path(__file__).resolve().parent))

from steps import (
    REPORT,
    at_rest,
    converted,
    draw_at_once,
    in_view,
    open_sidebar,
    play,
    redrawn,
    shot,
    show_tab,
    smooth_and_red,
    surfel_objects,
    until,
    view3d,
    watched,
)

MODULE = "bl_ext.user_default.surfel_splatting"
PACKAGE = os.environ["SURFEL_PACKAGE"]
FILE = REPORT.with_suffix(".blend")
#: Samples of the pictures that are compared with each other; the guide's has those of a new scene.
FEW = 2

drawn = []


def extension(path: str):
    """A module of the installed extension."""
    return sys.modules[f"{MODULE}.splat_addon.blender.{path}"]


def watch_drawing():
    viewport = extension("engine.viewport")
    viewport.draw = watched(viewport.draw, drawn)


def predicted():
    """Wait until the sidebar has the counts that it predicts, and shows them."""
    yield from redrawn()
    yield from until(lambda: not extension("conversion.prediction")._wanted, "the prediction is made")
    yield from redrawn()


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


def convert():
    """Convert the selection as a press of the large button does."""
    with in_view():
        assert extension("ui.chosen").chosen(bpy.context).kind.operator == "object.surfels_from_mesh"
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


def choose(shown: str):
    """Press one of the buttons Source and Surfels. Selecting what is seen draws no outline, as overlays are off."""
    with in_view():
        bpy.ops.object.surfels_or_source(shown=shown)


def update():
    """Press the large button while the source is seen and selected, and sculpted."""
    with in_view():
        bpy.ops.object.mode_set(mode="SCULPT")
        assert extension("ui.chosen").chosen(bpy.context).kind.operator == "object.surfels_update"
        bpy.ops.object.surfels_update()
        bpy.ops.object.mode_set(mode="OBJECT")


def orbit():
    view = view3d()[0].spaces[0].region_3d
    view.view_perspective = "PERSP"
    view.view_rotation = Quaternion((0, 0, 1), 0.4) @ view.view_rotation


def edit():
    """Turn the surfels in edit mode."""
    [made] = surfel_objects()
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
    return round(surfel_objects()[0].data.vertices[0].co.x, 4)


def steps():
    """Yields the seconds to wait after each step, and returns the report."""
    facts = {}
    bpy.ops.extensions.package_install_files(repo="user_default", filepath=PACKAGE, enable_on_install=True)
    watch_drawing()
    build_scene()
    draw_at_once()
    open_sidebar()
    yield from redrawn()
    bpy.ops.ed.undo_push(message="scene")
    show_tab("Surfels")
    yield from predicted()
    shot("before")
    convert()
    yield from converted()
    look_through_camera()
    show()
    if gpu.platform.backend_type_get() == "OPENGL":  # the software Vulkan draws Blender's own grid in blocks
        yield from at_rest(drawn)
        shot("guide")
    bpy.context.scene.surfel_splatting.samples = bpy.context.scene.surfel_splatting.viewport_samples = FEW
    yield from at_rest(drawn)
    shot("shown")

    choose("SOURCE")
    yield from at_rest(drawn)
    shot("source")
    update()
    choose("SURFELS")
    yield from at_rest(drawn)
    shot("updated")

    orbit()
    yield from at_rest(drawn)
    shot("orbited")
    look_through_camera()
    yield from at_rest(drawn)
    shot("orbited_and_back")

    bpy.ops.ed.undo_push(message="shown")
    facts["x"] = [first_x()]
    edit()
    facts["x"].append(first_x())
    yield from at_rest(drawn)
    shot("edited")
    undo(1)
    yield from at_rest(drawn)
    facts["x"].append(first_x())
    shot("undone")

    rendered = []
    bpy.app.handlers.render_complete.append(lambda *_: rendered.append(True))
    with in_view():
        bpy.ops.render.render("INVOKE_DEFAULT")
    yield from until(lambda: rendered, "the render ends")
    yield from redrawn()
    picture = REPORT.with_name(f"{REPORT.stem}_f12.png")
    bpy.data.images["Render Result"].save_render(str(picture))
    for window in list(bpy.context.window_manager.windows)[1:]:
        with bpy.context.temp_override(window=window):
            bpy.ops.wm.window_close()
    yield from at_rest(drawn)
    shot("after_f12")

    bpy.ops.wm.save_as_mainfile(filepath=str(FILE))
    bpy.ops.wm.open_mainfile(filepath=str(FILE))
    yield from redrawn()
    show()
    yield from at_rest(drawn)
    shot("opened_again")

    bpy.ops.preferences.addon_disable(module=MODULE)
    yield from redrawn()
    facts["left"] = [name for name in ("surfel_splatting", "surfel_conversion") if hasattr(bpy.types.Scene, name)]
    bpy.ops.preferences.addon_enable(module=MODULE)
    watch_drawing()
    yield from redrawn()
    show()
    yield from at_rest(drawn)
    shot("enabled_again")
    facts["engine"] = bpy.context.scene.render.engine
    return facts


play(steps())
