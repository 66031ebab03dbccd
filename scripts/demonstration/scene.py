# SPDX-License-Identifier: GPL-3.0-or-later
"""The surroundings of the surfels in the demo: a painted Suzanne if no model is given, lights, world, camera."""

from __future__ import annotations

import math

import bpy
import mathutils
import numpy as np

#: Direction from the model to the camera: in front, to the right and slightly above.
VIEW_FROM = mathutils.Vector((0.55, -1.0, 0.22)).normalized()
#: The share of the picture that the model may fill.
FILL = 0.86


def painted_suzanne() -> list:
    """A subdivided Suzanne with an image texture on its Principled material."""
    bpy.ops.mesh.primitive_monkey_add(calc_uvs=True)
    suzanne = bpy.context.object
    suzanne.modifiers.new("Subdivision", "SUBSURF").levels = 3
    suzanne.data.polygons.foreach_set("use_smooth", np.ones(len(suzanne.data.polygons), bool))
    suzanne.data.materials.append(painted_material())
    return [suzanne]


def painted_material():
    """A Principled material with the painted image as base colour."""
    image = bpy.data.images.new("Painted", 1024, 1024)
    image.pixels.foreach_set(painted_pixels(1024).ravel())
    image.pack()
    material = bpy.data.materials.new("Painted")
    with_nodes(material)
    nodes = material.node_tree.nodes
    texture = nodes.new("ShaderNodeTexImage")
    texture.image = image
    surface = next(node for node in nodes if node.type == "BSDF_PRINCIPLED")
    surface.inputs["Roughness"].default_value = 0.35
    material.node_tree.links.new(texture.outputs["Color"], surface.inputs["Base Color"])
    return material


def painted_pixels(size: int) -> np.ndarray:
    """(size, size, 4) float32 in sRGB: wavy warm and cool bands, with fine checks in every other one."""
    v, u = np.mgrid[0:size, 0:size].astype(np.float32) / size
    # The halves of Suzanne are mirrored in the image.
    u = np.abs(u - 0.5)
    wave = 14 * v + 0.8 * np.sin(2 * math.pi * 3 * u) + 0.4 * np.sin(2 * math.pi * (7 * u + 2 * v))
    warm, cool, ink = (np.array(c, np.float32) for c in ((0.95, 0.52, 0.20), (0.13, 0.55, 0.62), (0.98, 0.90, 0.74)))
    blend = (0.5 + 0.5 * np.clip(6 * np.sin(wave * math.pi / 2), -1, 1))[..., None]
    color = cool + (warm - cool) * blend
    checks = (np.floor(u * 64) + np.floor(v * 64)) % 2 * (np.floor(wave) % 2 == 0)
    color = color + (ink - color) * (0.55 * checks[..., None])
    return np.concatenate([color, np.ones_like(v)[..., None]], axis=2).astype(np.float32)


def dress(surfel_objects: list, size: tuple[int, int]) -> None:
    """Add lights, a mid-grey world, and a camera that frames all surfels; `size` is the picture's, in pixels."""
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.view_settings.view_transform = "Standard"
    points = world_positions(surfel_objects)
    low, high = points.min(axis=0), points.max(axis=0)
    reach = float(np.linalg.norm(high - low)) / 2
    middle = mathutils.Vector((low + high) / 2)
    scene.world = even_world((0.2, 0.2, 0.2))
    key = add_light("SUN", 2.2, (1.0, 0.95, 0.88))
    key.rotation_euler = mathutils.Vector((-0.5, -0.7, 0.9)).to_track_quat("Z", "Y").to_euler()
    # The power of the cool fill light grows with the square of the model's size, so that models of all sizes are lit
    # alike.
    fill = add_light("POINT", 30 * reach**2, (0.75, 0.87, 1.0))
    fill.location = middle + reach * mathutils.Vector((1.6, -0.9, 0.6))
    scene.camera = framing_camera(points, reach, size)


def world_positions(surfel_objects: list) -> np.ndarray:
    """(N, 3) float64 world positions of all surfels."""
    parts = []
    for surfel_object in surfel_objects:
        local = np.empty(3 * len(surfel_object.data.vertices), np.float32)
        surfel_object.data.attributes["position"].data.foreach_get("vector", local)
        matrix = np.array(surfel_object.matrix_world)
        parts.append(local.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3])
    return np.concatenate(parts)


def framing_camera(points: np.ndarray, reach: float, size: tuple[int, int]):
    """A camera in three-quarter view, close enough that `points`, (N, 3), fill FILL of the picture."""
    data = bpy.data.cameras.new("Camera")
    camera = bpy.data.objects.new("Camera", data)
    bpy.context.collection.objects.link(camera)
    rotation = VIEW_FROM.to_track_quat("Z", "Y")
    axes = np.array(rotation.to_matrix())
    seen = points @ axes
    center = (seen.min(axis=0) + seen.max(axis=0)) / 2
    across = np.abs(seen - center)
    width_to_height = size[0] / size[1]
    half = data.sensor_width / 2 / data.lens
    slopes = FILL * half * np.array([min(width_to_height, 1), min(1 / width_to_height, 1)])
    distance = float(((across[:, :2] / slopes).max(axis=1) + seen[:, 2] - center[2]).max())
    distance = max(distance, reach * 1e-3)
    camera.rotation_euler = rotation.to_euler()
    camera.location = axes @ (center + np.array((0, 0, distance)))
    data.clip_start, data.clip_end = max(distance - 2 * reach, distance * 1e-3), distance + 2 * reach
    return camera


def add_light(kind: str, energy: float, color: tuple[float, float, float]) -> bpy.types.Object:
    """A lamp at the origin."""
    data = bpy.data.lights.new(kind.title(), kind)
    data.energy, data.color = energy, color
    lamp = bpy.data.objects.new(kind.title(), data)
    bpy.context.collection.objects.link(lamp)
    return lamp


def even_world(color: tuple[float, float, float]):
    """A world of one linear colour."""
    world = bpy.data.worlds.new("Even")
    with_nodes(world)
    background = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (*color, 1.0)
    return world


def with_nodes(owner) -> None:
    """Give a material or world its default nodes; Blender 5 creates them itself and warns if asked to."""
    if bpy.app.version < (5, 0):
        owner.use_nodes = True
