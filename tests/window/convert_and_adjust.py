# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: converts Suzanne with the sidebar's operator, and adjusts it.

test_operator.py reads the report.
"""

import sys
from pathlib import Path

import bpy

sys.path[:0] = [str(Path(__file__).resolve().parents[2]), str(Path(__file__).resolve().parent)]

from steps import (  # noqa: E402
    converted,
    in_view,
    open_sidebar,
    play,
    redrawn,
    smooth_and_red,
    surfel_objects,
)

import splat_addon  # noqa: E402


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


def steps():
    """Yields the seconds to wait after each step, and returns the report."""
    prepare()
    yield from redrawn()
    result = convert()
    yield from converted()
    first = len(surfel_objects()[0].data.vertices)
    adjust()
    yield from redrawn()
    source_hidden = bpy.data.objects["Suzanne"].hide_get()
    report = {"operator": result, "first": first, "source_hidden": source_hidden}
    report["surfels"] = [len(owner.data.vertices) for owner in surfel_objects()]
    return report


splat_addon.register()
play(steps())
