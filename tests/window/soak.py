# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs inside a Blender window: renders many frames, makes many edits, and records memory on the way.

test_soak.py reads the figures. SURFEL_SOAK contains the numbers of frames and of edits.
"""

import gc
import os
import sys
from itertools import cycle
from pathlib import Path

import bpy
import gpu

sys.path[:0] = [str(Path(__file__).resolve().parents[2]), str(Path(__file__).resolve().parent)]

from steps import in_view, play, redrawn, view3d  # noqa: E402

import splat_addon  # noqa: E402
from splat_addon.blender.engine import final_render  # noqa: E402

FRAMES, EDITS = map(int, os.environ["SURFEL_SOAK"].split(","))


def resident() -> float:
    """The resident memory of this process, in megabytes."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def figures() -> dict:
    gc.collect()
    held = final_render.last_frame_stats["texture_bytes"] / 1e6
    return {"resident": resident(), "objects": len(gc.get_objects()), "textures": held, "meshes": len(bpy.data.meshes)}


def build_scene():
    """Make a turning Suzanne, as surfels that follow her, on a floor of polygons."""
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    with in_view():
        bpy.ops.mesh.primitive_plane_add(size=8, location=(0, 0, -1))
        bpy.context.object.name = "Floor"
        bpy.ops.mesh.primitive_monkey_add(size=2)
        suzanne = bpy.context.object
        for frame, angle in ((1, 0.0), (100, 6.28)):
            suzanne.rotation_euler.z = angle
            suzanne.keyframe_insert("rotation_euler", frame=frame)
        material = bpy.data.materials.new("Red")
        material.use_nodes = True
        suzanne.data.materials.append(material)
        bpy.ops.object.surfels_from_mesh(resolution=40, source="HIDE")
    scene = bpy.context.scene
    scene.render.engine = "SURFEL_SPLATTING"
    scene.render.resolution_x, scene.render.resolution_y = 160, 120
    scene.surfel_splatting.samples, scene.surfel_splatting.viewport_samples = 1, 2
    space = view3d()[0].spaces[0]
    space.shading.type, space.overlay.show_overlays = "RENDERED", False
    bpy.context.preferences.edit.undo_steps = 8


def surfels():
    return next(o for o in bpy.data.objects if o.name.startswith("Suzanne") and o.name.endswith("surfels"))


def only(thing):
    bpy.ops.object.select_all(action="DESELECT")
    thing.select_set(True)
    bpy.context.view_layer.objects.active = thing


def move():
    surfels().location.x += 0.01


def paint():
    color = bpy.data.materials["Red"].node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value
    color[0] = (color[0] + 0.1) % 1


def light():
    bpy.data.objects["Light"].data.energy += 1


def turn_points():
    only(surfels())
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.transform.rotate(value=0.1, orient_axis="Z")
    bpy.ops.object.mode_set(mode="OBJECT")


def update():
    only(surfels())
    bpy.ops.object.surfels_update()


def undo_a_move():
    bpy.ops.ed.undo_push(message="before")
    move()
    bpy.ops.ed.undo_push(message="moved")
    bpy.ops.ed.undo()


def add_and_delete():
    bpy.ops.mesh.primitive_uv_sphere_add(segments=12, ring_count=6, location=(2, 0, 0))
    bpy.ops.object.surfels_from_mesh(resolution=20)
    bpy.ops.render.render()
    for name in [o.name for o in bpy.data.objects if o.name.startswith("Sphere")]:
        bpy.data.objects.remove(bpy.data.objects[name])
    bpy.ops.outliner.orphans_purge(do_recursive=True)


def change_method():
    settings = bpy.context.scene.surfel_splatting
    settings.method = "quad" if settings.method == "mip" else "mip"


def deform_floor():
    bpy.data.objects["Floor"].data.vertices[0].co.z += 0.01
    bpy.data.objects["Floor"].data.update()


EDIT_KINDS = (move, paint, light, turn_points, update, undo_a_move, add_and_delete, change_method, deform_floor)


def steps():
    """Yields the seconds to wait after each step, and returns the report."""
    build_scene()
    yield from redrawn()
    scene, series, kinds = bpy.context.scene, [], cycle(EDIT_KINDS)
    every = max(FRAMES // EDITS, 1)
    for frame in range(FRAMES):
        with in_view():
            scene.frame_set(frame % 100 + 1)
            if frame % every == 0 and frame // every < EDITS:
                next(kinds)()
                scene = bpy.context.scene
            bpy.ops.render.render()
        if frame % max(FRAMES // 30, 1) == 0:
            series.append({"frame": frame, **figures()})
        yield 0.001
    series.append({"frame": FRAMES, **figures()})
    backend = gpu.platform.backend_type_get()
    return {"frames": FRAMES, "edits": min(EDITS, FRAMES), "series": series, "backend": backend}


splat_addon.register()
play(steps())
