# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: while surfels are on their way to a view, undoes, removes, opens a file, hides the
view, renders, unregisters and quits.

test_slices.py reads the report.
"""

import sys
from pathlib import Path

import bpy

sys.path[:0] = [str(Path(__file__).resolve().parents[2]), str(Path(__file__).resolve().parent)]

from steps import REPORT, in_view, play, redrawn, until, view3d  # noqa: E402

import splat_addon  # noqa: E402
from splat_addon.blender.engine import viewport  # noqa: E402
from splat_addon.blender.geometry.attributes import write_surfels  # noqa: E402
from splat_addon.reference import scenes  # noqa: E402

COUNT = 1_000_000
FILE = REPORT.with_suffix(".blend")

draws = []


def watch(draw):
    def watching(engine, context, depsgraph):
        draw(engine, context, depsgraph)
        state = engine.surfel_state
        draws.append((len(state.scene.surfels), state.says, state.arrival.loading.bytes_written))

    return watching


def add():
    made = bpy.data.objects.new("torus", write_surfels("torus", scenes.torus(COUNT)[0].surfels[0].surfels))
    bpy.context.scene.collection.objects.link(made)
    bpy.ops.ed.undo_push(message="torus")


def show(kind="RENDERED"):
    space = view3d()[0].spaces[0]
    space.shading.type, space.overlay.show_overlays = kind, False


def edit():
    mesh = bpy.data.objects["torus"].data
    mesh.attributes["position"].data[0].vector.x += 1
    mesh.update()
    bpy.ops.ed.undo_push(message="edit")


def until_there():
    yield from until(lambda: draws and draws[-1][0] and not draws[-1][1], "the surfels arrive")


def steps():
    """Yields the seconds to wait after each step, and returns the report."""
    scene = bpy.context.scene
    scene.render.engine, scene.surfel_splatting.viewport_samples = "SURFEL_SPLATTING", 1
    scene.surfel_splatting.samples = scene.surfel_splatting.blur_samples = 1
    scene.render.resolution_percentage = 10
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    show()
    yield from redrawn()
    add()
    draws.clear()
    yield from until_there()
    report = {"draws": list(draws)}
    for _ in range(2):
        edit()
        yield from redrawn()
    for _ in range(2):
        bpy.ops.ed.undo()
        yield from redrawn()
    yield from until_there()
    edit()
    yield from redrawn()
    bpy.data.objects.remove(bpy.data.objects["torus"])
    bpy.ops.outliner.orphans_purge(do_recursive=True)
    yield from until(lambda: draws[-1][:2] == (0, ""), "nothing is waited for that is gone")
    report["removed"] = draws[-1][:2]
    add()
    yield from redrawn()
    bpy.ops.wm.save_as_mainfile(filepath=str(FILE))
    for _ in range(2):
        bpy.ops.wm.open_mainfile(filepath=str(FILE))
        yield from redrawn()
    show("SOLID")
    yield from redrawn()
    show()
    yield from redrawn()
    with in_view():
        bpy.ops.render.render()
    yield from until_there()
    report["reopened"] = draws[-1][:2]
    bpy.ops.wm.open_mainfile(filepath=str(FILE))
    yield from redrawn()
    splat_addon.unregister()
    yield from redrawn()
    splat_addon.register()
    bpy.ops.wm.open_mainfile(filepath=str(FILE))
    yield from redrawn()
    return report


viewport.draw = watch(viewport.draw)
splat_addon.register()
play(steps())
