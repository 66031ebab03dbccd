# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: clicks from the default scene to a rendered picture, the same with a scan in place of
the cube, and measures how wide labels are.

test_first_picture.py reads the report: the clicks, what they made, and the widths.
"""

import sys
from pathlib import Path

import blf
import bpy
import numpy as np

sys.path[:0] = [str(Path(__file__).resolve().parents[2]), str(Path(__file__).resolve().parent)]

from steps import REPORT, in_view, is_modal, open_sidebar, play, redrawn, show_tab, until, view3d  # noqa: E402

import splat_addon  # noqa: E402
from splat_addon.blender.conversion.made_of import converted  # noqa: E402
from splat_addon.blender.conversion.mesh_settings import PROPERTY_NAMES  # noqa: E402
from splat_addon.blender.conversion.points_settings import POINTS_NAMES  # noqa: E402
from splat_addon.blender.engine import final_render  # noqa: E402
from splat_addon.blender.translations import GERMAN  # noqa: E402
from splat_addon.blender.ui.chosen import chosen  # noqa: E402


def press_large_button():
    """Call the operator of the tab's large button as a click does."""
    with in_view():
        module, _, name = chosen(bpy.context).kind.operator.partition(".")
        getattr(getattr(bpy.ops, module), name)("INVOKE_DEFAULT", True)


def picture(name: str):
    """From the view to a picture: what a user does, one click at a time. Returns what it was, and what came of it."""
    clicks = []

    def click(what, press):
        clicks.append(what)
        return press()

    click("N: the sidebar", open_sidebar)
    yield from redrawn()
    click("the tab Surfels", lambda: show_tab("Surfels"))
    yield from redrawn()
    before = len(converted())
    click("the large button", press_large_button)
    yield from until(lambda: len(converted()) > before and not is_modal(), "the conversion ends")
    with in_view():
        click("Show with Surfel Splatting", bpy.ops.view3d.surfels_show)
    yield from redrawn()
    with in_view():
        click("F12", bpy.ops.render.render)
    file = REPORT.with_name(f"{REPORT.stem}_{name}.png")
    bpy.data.images["Render Result"].save_render(str(file))
    return {"clicks": clicks, "surfels": final_render.last_frame_stats["splats"], "picture": str(file)}


def as_in_a_new_file():
    """Put away what the first picture needed, and select a scan of a sphere in place of the cube."""
    view3d()[0].spaces[0].show_region_ui = False
    view3d()[0].spaces[0].shading.type = "SOLID"
    bpy.context.scene.render.engine = "BLENDER_WORKBENCH"
    for made in [each for each in bpy.data.objects if each.type == "MESH"]:
        bpy.data.objects.remove(made)
    points = np.random.default_rng(1).normal(size=(4000, 3))
    mesh = bpy.data.meshes.new("scan")
    mesh.from_pydata((points / np.linalg.norm(points, axis=1, keepdims=True)).tolist(), [], [])
    scan = bpy.data.objects.new("scan", mesh)
    bpy.context.scene.collection.objects.link(scan)
    scan.select_set(True)
    bpy.context.view_layer.objects.active = scan


def widths(texts, region) -> dict:
    """text -> its width in the interface's font, as a share of a panel's width in a region."""
    blf.size(0, 11 * bpy.context.preferences.system.ui_scale)
    return {text: blf.dimensions(0, text)[0] / region.width for text in texts}


def steps():
    """Yields the seconds to wait after each step, and returns the report."""
    scene = bpy.context.scene
    scene.render.resolution_percentage = 15
    report = {"mesh": (yield from picture("mesh"))}
    as_in_a_new_file()
    yield from redrawn()
    report["scan"] = yield from picture("scan")
    groups = (scene.surfel_conversion, PROPERTY_NAMES), (scene.surfel_points_conversion, POINTS_NAMES)
    properties = [settings.bl_rna.properties[name] for settings, names in groups for name in names]
    # Settings with their name at the left; a switch has it at the right of its box.
    names = [each.name for each in properties if each.type != "BOOLEAN"]
    sidebar = next(region for region in view3d()[0].regions if region.type == "UI")
    return {
        **report,
        "labels": {"English": widths(names, sidebar), "German": widths([GERMAN[name] for name in names], sidebar)},
        "font": widths(["iiii", "WWWW"], sidebar),
    }


splat_addon.register()
play(steps())
