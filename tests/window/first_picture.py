# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: clicks from the default scene to a rendered picture, and measures how wide labels are.

test_first_picture.py reads the report: the clicks, what they made, and the widths.
"""

import sys
from pathlib import Path

import blf
import bpy

sys.path[:0] = [str(Path(__file__).resolve().parents[2]), str(Path(__file__).resolve().parent)]

from steps import REPORT, converted, in_view, open_sidebar, play, redrawn, show_tab, view3d  # noqa: E402

import splat_addon  # noqa: E402
from splat_addon.blender.conversion.mesh_settings import PROPERTY_NAMES  # noqa: E402
from splat_addon.blender.engine import final_render  # noqa: E402
from splat_addon.blender.translations import GERMAN  # noqa: E402

clicks = []


def click(what: str, press):
    clicks.append(what)
    return press()


def widths(texts, region) -> dict:
    """text -> its width in the interface's font, as a share of a panel's width in a region."""
    blf.size(0, 11 * bpy.context.preferences.system.ui_scale)
    return {text: blf.dimensions(0, text)[0] / region.width for text in texts}


def steps():
    """Yields the seconds to wait after each step, and returns the report."""
    scene = bpy.context.scene
    scene.render.resolution_percentage = 15
    click("N: the sidebar", open_sidebar)
    yield from redrawn()
    click("the tab Surfels", lambda: show_tab("Surfels"))
    yield from redrawn()
    with in_view():
        click("Convert to Surfels", lambda: bpy.ops.object.surfels_from_mesh("INVOKE_DEFAULT", True))
    yield from converted()
    with in_view():
        click("Show with Surfel Splatting", bpy.ops.view3d.surfels_show)
    yield from redrawn()
    with in_view():
        click("F12", bpy.ops.render.render)
    picture = REPORT.with_name(f"{REPORT.stem}_f12.png")
    bpy.data.images["Render Result"].save_render(str(picture))
    settings = scene.surfel_conversion
    # Settings with their name at the left; a switch has it at the right of its box.
    names = [
        settings.bl_rna.properties[name].name
        for name in PROPERTY_NAMES
        if settings.bl_rna.properties[name].type != "BOOLEAN"
    ]
    sidebar = next(region for region in view3d()[0].regions if region.type == "UI")
    return {
        "clicks": clicks,
        "surfels": final_render.last_frame_stats["splats"],
        "picture": str(picture),
        "labels": {"English": widths(names, sidebar), "German": widths([GERMAN[name] for name in names], sidebar)},
        "font": widths(["iiii", "WWWW"], sidebar),
    }


splat_addon.register()
play(steps())
