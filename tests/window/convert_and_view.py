# SPDX-License-Identifier: GPL-3.0-or-later
"""Run inside a Blender window: convert Suzanne with the sidebar's operator, open its tab, look at the rendered view.

What happened is written as JSON to the file named after `--`; test_window.py reads it beside the screenshot.
"""

import json
import sys
import traceback
from pathlib import Path

import bpy

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

import splat_addon  # noqa: E402

REPORT = Path(sys.argv[sys.argv.index("--") + 1])
POLL_SECONDS = 0.2


def view3d():
    """The 3D view's area and its window region."""
    area = next(a for a in bpy.context.window_manager.windows[0].screen.areas if a.type == "VIEW_3D")
    return area, next(r for r in area.regions if r.type == "WINDOW")


def in_view(**more):
    area, region = view3d()
    return bpy.context.temp_override(window=bpy.context.window_manager.windows[0], area=area, region=region, **more)


def prepare():
    """A smooth, red Suzanne, alone and selected, in the middle of the view; the sidebar open."""
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    with in_view():
        bpy.ops.mesh.primitive_monkey_add(size=3)
        suzanne = bpy.context.object
        suzanne.modifiers.new("Subdivision", "SUBSURF").levels = 2
        bpy.ops.object.shade_smooth()
        material = bpy.data.materials.new("Red")
        material.use_nodes = True
        material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.8, 0.05, 0.03, 1)
        suzanne.data.materials.append(material)
        bpy.ops.view3d.view_selected()
    area, _ = view3d()
    area.spaces[0].show_region_ui = True


def convert():
    """As a press of the button: the operator runs modally, and Blender's window lives on."""
    with in_view():
        result = bpy.ops.object.surfels_from_mesh("INVOKE_DEFAULT", resolution=160, source="HIDE")
    return list(result)


def look():
    """Rendered view by our engine; the sidebar on our tab."""
    bpy.context.scene.render.engine = "SURFEL_SPLATTING"
    area, _ = view3d()
    area.spaces[0].overlay.show_overlays = False
    area.spaces[0].shading.type = "RENDERED"
    for region in area.regions:
        if region.type == "UI":
            region.active_panel_category = "Surfels"
    area.tag_redraw()


def steps():
    """Each yields the seconds to wait before the next."""
    prepare()
    yield 1.0
    result = convert()
    while not (made := [o for o in bpy.data.objects if o.name.endswith(" surfels")]):
        yield POLL_SECONDS
    yield 1.0
    look()
    yield 4.0
    source_hidden = bpy.data.objects["Suzanne"].hide_get()
    report = {"operator": result, "surfels": len(made[0].data.vertices), "source_hidden": source_hidden}
    REPORT.write_text(json.dumps(report), encoding="utf-8")


def run():
    try:
        return next(RUNNING)
    except StopIteration:
        return None
    except Exception:
        REPORT.write_text(json.dumps({"error": traceback.format_exc()}), encoding="utf-8")
        return None


RUNNING = steps()
bpy.context.preferences.view.show_splash = False
splat_addon.register()
bpy.app.timers.register(run, first_interval=1.0)
