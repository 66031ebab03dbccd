# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's own point clouds, which are spheres: "CYCLES" or "BLENDER_EEVEE", one sample for each fine pixel."""

from __future__ import annotations

import bpy
import numpy as np
from mathutils import Matrix
from measured import leave

from measuring.blender_scene import rendered


def prepare(given: dict[str, np.ndarray], kind: str):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene, size = bpy.context.scene, int(given["size"])
    scene.render.engine, scene.render.film_transparent = kind, True
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.cycles.samples, scene.cycles.pixel_filter_type, scene.cycles.filter_width = 1, "BOX", 1.0
    scene.cycles.use_denoising = False
    scene.eevee.taa_render_samples, scene.render.filter_size = 1, 0.0
    scene.eevee.use_shadows = False
    near, far = given["clipping"].tolist()
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit, camera.angle = "VERTICAL", float(given["angle"])
    camera.clip_start, camera.clip_end = near, far
    scene.camera = bpy.data.objects.new("camera", camera)
    scene.collection.objects.link(scene.camera)
    scene.collection.objects.link(bpy.data.objects.new("points", _cloud(given)))

    def draw(view: int) -> np.ndarray:
        scene.camera.matrix_world = Matrix(given["cameras"][view].tolist())
        pixels = rendered(scene)
        return pixels[..., :3] + (1 - pixels[..., 3:]) * given["background"]

    return draw


def _cloud(given: dict[str, np.ndarray]) -> bpy.types.PointCloud:
    cloud, count = bpy.data.pointclouds.new("points"), len(given["positions"])
    cloud.resize(count)
    cloud.attributes["position"].data.foreach_set("vector", given["positions"].astype(np.float32).ravel())
    radius = cloud.attributes.get("radius") or cloud.attributes.new("radius", "FLOAT", "POINT")
    radius.data.foreach_set("value", np.full(count, given["radius"], np.float32))
    colors = cloud.attributes.new("Col", "FLOAT_COLOR", "POINT")
    colors.data.foreach_set("color", given["colors"].astype(np.float32).ravel())
    cloud.materials.append(_emitting("Col"))
    return cloud


def _emitting(attribute: str) -> bpy.types.Material:
    material = bpy.data.materials.new("points")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    kinds = "ShaderNodeAttribute", "ShaderNodeEmission", "ShaderNodeOutputMaterial"
    color, emission, output = (tree.nodes.new(kind) for kind in kinds)
    color.attribute_name = attribute
    tree.links.new(color.outputs["Color"], emission.inputs["Color"])
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    return material


if __name__ == "__main__":
    leave(prepare)
