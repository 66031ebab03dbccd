# SPDX-License-Identifier: GPL-3.0-or-later
"""A field of grass that Geometry Nodes place, as polygons and as surfels, beside Cycles."""

from __future__ import annotations

import math
from functools import partial

import bpy
import numpy as np

from measuring.blender_scene import lit_scene, rendered
from measuring.timing import processor

COLUMNS = "blades", "picture", "processor seconds", "times Cycles"
CYCLES_SAMPLES = 8
SIZE = 160, 90


def rows(count: int):
    """The second picture of each kind, for which nothing is compiled."""
    scene, blade, source = field(count)
    seconds = {"Cycles": timed(scene, "CYCLES")}
    seconds["polygons"] = timed(scene, "SURFEL_SPLATTING")
    source.inputs["Object"].default_value = converted(blade)
    seconds["surfels"] = timed(scene, "SURFEL_SPLATTING")
    for name, taken in seconds.items():
        yield f"{count:,}", name, f"{taken:.1f}", f"{taken / seconds['Cycles']:.1f}"


def timed(scene: bpy.types.Scene, engine: str) -> float:
    scene.render.engine = engine
    scene.cycles.samples, scene.cycles.use_denoising = CYCLES_SAMPLES, False
    rendered(scene)
    seconds, _ = processor(partial(rendered, scene))
    return seconds


def field(count: int):
    """The scene, a blade, and the node that hands the blade to the points of a square."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = lit_scene(SIZE, (0.2,) * 3, (0.5, 0.3, 0.0), 3.0)
    scene.camera.location, scene.camera.rotation_euler = (0, -14, 7), (math.radians(63), 0, 0)
    corners = [(-0.02, 0, 0), (0.02, 0, 0), (0.015, 0, 0.3), (-0.015, 0, 0.3), (0, 0.05, 0.5)]
    blade = linked("blade", corners, [(0, 1, 2, 3), (3, 2, 4)])
    blade.location = 0, 0, -50
    places = np.random.default_rng(0).uniform(-8, 8, (count, 2))
    ground = linked("field", np.pad(places, ((0, 0), (0, 1))).tolist(), [])
    tree = bpy.data.node_groups.new("grass", "GeometryNodeTree")
    for way in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    types = "NodeGroupInput", "GeometryNodeInstanceOnPoints", "GeometryNodeObjectInfo", "NodeGroupOutput"
    begin, placing, source, end = (tree.nodes.new(kind) for kind in types)
    source.inputs["Object"].default_value, source.inputs["As Instance"].default_value = blade, True
    tree.links.new(begin.outputs[0], placing.inputs["Points"])
    tree.links.new(source.outputs["Geometry"], placing.inputs["Instance"])
    tree.links.new(placing.outputs[0], end.inputs[0])
    ground.modifiers.new("grass", "NODES").node_group = tree
    return scene, blade, source


def linked(name: str, places, faces) -> bpy.types.Object:
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(places, [], faces)
    made = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(made)
    return made


def converted(blade: bpy.types.Object) -> bpy.types.Object:
    before = set(bpy.data.objects)
    bpy.context.view_layer.objects.active = blade
    blade.select_set(True)
    bpy.ops.object.surfels_from_mesh(resolution=24)
    made = next(iter(set(bpy.data.objects) - before))
    made.location = blade.location
    return made
