# SPDX-License-Identifier: GPL-3.0-or-later
"""What tests of unconverted meshes share: materials, a sun, counts of what was drawn, and a comparison with Cycles."""

import bpy
import numpy as np

from splat_addon.blender.engine import final_render


def counts():
    """What the last frame drew of meshes, and not how many it read."""
    return {name: count for name, count in final_render.last_frame_stats["live_meshes"].items() if name != "read"}


def principled(**inputs) -> bpy.types.Material:
    material = bpy.data.materials.new("material")
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    shader = material.node_tree.nodes["Principled BSDF"]
    for name, value in inputs.items():
        shader.inputs[name.replace("_", " ")].default_value = value
    return material


def add_sun(scene, rotation=(0.5, 0.3, 0), energy=3.0, **properties):
    data = bpy.data.lights.new("sun", "SUN")
    data.energy, data.angle = energy, 0
    for name, value in properties.items():
        setattr(data, name, value)
    sun = bpy.data.objects.new("sun", data)
    sun.rotation_euler = rotation
    scene.collection.objects.link(sun)
    return sun


def as_cycles_has_it(ours, truth, share):
    """Compare brightness where both pictures are covered: in the mean, and in all but a few pixels, within that
    share.
    """
    inside = (ours[..., 3] == 1) & (truth[..., 3] > 0.999)
    mine, other = ours[inside][:, :3], truth[inside][:, :3]
    assert inside.sum() > 100
    assert abs(mine.mean() - other.mean()) < share * other.mean()
    off = np.abs(mine - other).max(axis=1) > share * other.max()
    return np.count_nonzero(off) <= 0.05 * len(off)
