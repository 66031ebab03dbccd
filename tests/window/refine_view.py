# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: a view through a camera out of focus, in small tiles, at rest and while it changes.

test_refinement.py reads the report.
"""

import sys
from importlib import import_module
from pathlib import Path

import bpy

sys.path[:0] = [str(Path(__file__).resolve().parents[2]), str(Path(__file__).resolve().parent)]

from steps import play, until, view3d, watched  # noqa: E402

import splat_addon  # noqa: E402
from splat_addon.blender.engine import viewport  # noqa: E402

SAMPLES = 6
#: Seconds in which a view that has come to rest is to draw nothing.
IDLE = 1.0

draws = []


def prepare():
    """Make a row of balls with the middle one in focus."""
    scene = bpy.context.scene
    cube = bpy.data.objects["Cube"]
    bpy.data.objects.remove(cube)
    for number in range(5):
        bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=8, radius=0.6, location=(0, 2 * number - 4, 0))
    camera = scene.camera
    camera.location, camera.rotation_euler = (3, -8, 2), (1.35, 0, 0.35)
    camera.data.dof.use_dof, camera.data.dof.aperture_fstop = True, 0.1
    camera.data.dof.focus_object = bpy.data.objects["Sphere.002"]
    scene.render.engine = "SURFEL_SPLATTING"
    scene.render.film_transparent = True
    scene.surfel_splatting.render_meshes, scene.surfel_splatting.mesh_resolution = "SURFELS", 24
    scene.surfel_splatting.viewport_samples = SAMPLES
    area, _ = view3d()
    area.spaces[0].region_3d.view_perspective = "CAMERA"
    area.spaces[0].overlay.show_overlays = False
    area.spaces[0].shading.type = "RENDERED"


def refined():
    """Wait until the view is complete, without asking for another drawing."""
    yield from until(lambda: draws and draws[-1] == SAMPLES, "the view is complete")


def steps():
    """Yields the seconds to wait after each step, and returns the report."""
    report = {"samples": SAMPLES}
    prepare()
    yield from refined()
    yield IDLE  # the window may be drawn once more for another reason
    report["first"] = list(draws)
    yield IDLE
    report["idle"] = len(draws) - len(report["first"])
    draws.clear()
    bpy.data.objects["Sphere"].location.z += 0.5
    yield from refined()
    report["changed"] = list(draws)
    draws.clear()
    bpy.context.scene.camera.location.x += 0.2
    yield from refined()
    report["moved"] = list(draws)
    return report


import_module("splat_addon.rendering.plan.tiles").MAX_TARGET_EDGE = 400
viewport.draw = watched(viewport.draw, draws)
splat_addon.register()
play(steps())
