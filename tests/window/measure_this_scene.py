# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: measures the startup file's scene with the button's operator.

test_measuring.py reads the report.
"""

import sys
from pathlib import Path

import bpy

sys.path[:0] = [str(Path(__file__).resolve().parents[2]), str(Path(__file__).resolve().parent)]

from steps import in_view, play, redrawn, until  # noqa: E402

import splat_addon  # noqa: E402
from splat_addon.blender.engine import exchange, measuring  # noqa: E402


def render_properties():
    """Let the properties editor show the render properties of a small picture."""
    scene = bpy.context.scene
    scene.render.engine = "SURFEL_SPLATTING"
    scene.render.resolution_x, scene.render.resolution_y = 96, 64
    bpy.context.preferences.view.render_display_type = "NONE"
    area = next(a for a in bpy.context.window_manager.windows[0].screen.areas if a.type == "PROPERTIES")
    area.spaces[0].context = "RENDER"


def steps():
    """Yields the seconds to wait after each step, and returns the report."""
    render_properties()
    yield from redrawn()
    scene = bpy.context.scene
    with in_view():
        result = bpy.ops.render.surfel_measure("INVOKE_DEFAULT", pictures=8)
    yield from until(lambda: (found := measuring.measured(scene)) and found.is_whole, "everything is measured")
    yield from until(lambda: not bpy.app.is_job_running("RENDER"), "the render has ended")
    yield from redrawn()
    rows = measuring.measured(scene).rows
    bpy.ops.render.surfel_measured_use(row=len(rows) - 1)
    yield from redrawn()
    is_given_back = exchange.exchanged() == exchange.Exchange()
    return {"operator": list(result), "rows": [row.choice.name for row in rows], "is_given_back": is_given_back}


splat_addon.register()
play(steps())
