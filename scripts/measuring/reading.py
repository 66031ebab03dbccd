# SPDX-License-Identifier: GPL-3.0-or-later
"""How long a render reads a scene in which one of many different objects moves, in the first frames of an animation."""

from __future__ import annotations

import tempfile
from time import thread_time

import bpy
import numpy as np

from measuring.blender_scene import lit_scene

COLUMNS = "objects", "frame", "read, processor ms", "meshes read"
FRAMES, MATERIALS = 3, 5


def rows(count: int, subdivisions: int = 5):
    """The frames of an animation of rough balls of 20 * 4 ** (subdivisions - 1) triangles."""
    from splat_addon.blender.engine import final_render

    scene = _balls(count, subdivisions)
    read, found = final_render._read, []

    def timed(depsgraph, resources):
        begun = thread_time()
        made = read(depsgraph, resources)
        found.append((1e3 * (thread_time() - begun), resources.live_meshes.counts["read"]))
        return made

    final_render._read = timed
    try:
        with tempfile.TemporaryDirectory() as folder:
            scene.render.filepath = f"{folder}/frame"
            bpy.ops.render.render(animation=True)
    finally:
        final_render._read = read
    for frame, (taken, meshes) in enumerate(found, start=1):
        yield f"{count:,}", frame, f"{taken:.0f}", f"{meshes:,}"


def _balls(count: int, subdivisions: int) -> bpy.types.Scene:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = lit_scene((64, 64), (0.2,) * 3, (0.5, 0.3, 0.0), 3.0)
    scene.render.engine, scene.frame_end = "SURFEL_SPLATTING", FRAMES
    scene.surfel_splatting.samples = 1
    scene.camera.location = (5, 5, 20)
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=subdivisions, radius=0.4)
    first, random = bpy.context.object, np.random.default_rng(0)
    materials = [_material(number) for number in range(MATERIALS)]
    first.data.materials.append(materials[0])
    for number in range(count):
        ball = first if not number else bpy.data.objects.new("ball", first.data.copy())
        if number:
            scene.collection.objects.link(ball)
        places = np.empty(3 * len(ball.data.vertices), np.float32)
        ball.data.attributes["position"].data.foreach_get("vector", places)
        rough = places.reshape(-1, 3) * random.uniform(0.9, 1.1, (len(places) // 3, 1))
        ball.data.attributes["position"].data.foreach_set("vector", rough.astype(np.float32).ravel())
        ball.data.update()
        ball.data.materials[0] = materials[number % MATERIALS]
        ball.location = (number % 10, number // 10, 0)
    for frame, height in ((1, 0.0), (FRAMES, 2.0)):
        first.location.z = height
        first.keyframe_insert("location", frame=frame)
    return scene


def _material(number: int) -> bpy.types.Material:
    made = bpy.data.materials.new(f"paint {number}")
    if made.node_tree is None:  # before Blender 5.0
        made.use_nodes = True
    made.node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = number / MATERIALS
    return made
