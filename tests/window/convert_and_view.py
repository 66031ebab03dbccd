# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: converts Suzanne with the sidebar's operator, and shows its tab and the rendered view.

test_window.py reads the report and the screenshot.
"""

import sys
from pathlib import Path

import bpy

sys.path[:0] = [str(Path(__file__).resolve().parents[2]), str(Path(__file__).resolve().parent)]

from steps import in_view, open_sidebar, play, show_tab, smooth_and_red, view3d  # noqa: E402

import splat_addon  # noqa: E402

POLL_SECONDS = 0.2


def prepare():
    """Put a smooth, red Suzanne alone in the view, selected, and open the sidebar."""
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    with in_view():
        bpy.ops.mesh.primitive_monkey_add(size=3)
        smooth_and_red((0.8, 0.05, 0.03, 1))
        bpy.ops.view3d.view_selected()
        bpy.ops.ed.undo_push(message="Suzanne")
    open_sidebar()


def convert():
    """Call the operator as its button does: it runs modally while Blender's window stays responsive."""
    with in_view():
        result = bpy.ops.object.surfels_from_mesh("INVOKE_DEFAULT", True, resolution=80, source="HIDE")
    return list(result)


def adjust():
    """Change a setting of the operator as Adjust Last Operation does."""
    bpy.context.window_manager.operators[-1].properties.resolution = 160
    with in_view():
        bpy.ops.ed.undo_redo()


def made():
    return [owner for owner in bpy.data.objects if owner.name.endswith(" surfels")]


def look():
    """Show the rendered view with our engine, and our tab in the sidebar."""
    bpy.context.scene.render.engine = "SURFEL_SPLATTING"
    area, _ = view3d()
    area.spaces[0].overlay.show_overlays = False
    area.spaces[0].shading.type = "RENDERED"
    show_tab("Surfels")


def steps():
    """Yields the seconds to wait after each step, and returns the report."""
    prepare()
    yield 1.0
    result = convert()
    while not made():
        yield POLL_SECONDS
    yield 1.0
    first = len(made()[0].data.vertices)
    adjust()
    yield 2.0
    look()
    yield 4.0
    source_hidden = bpy.data.objects["Suzanne"].hide_get()
    report = {"operator": result, "first": first, "source_hidden": source_hidden}
    report["surfels"] = [len(owner.data.vertices) for owner in made()]
    return report


splat_addon.register()
play(steps())
