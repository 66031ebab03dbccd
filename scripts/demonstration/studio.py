# SPDX-License-Identifier: GPL-3.0-or-later
"""The demo's default scene: each model twice, as a mesh and as surfels, on a studio floor in soft light."""

from __future__ import annotations

import math

import bmesh
import bpy
import mathutils
import numpy as np

from .scene import add_light, even_world, painted_suzanne, with_nodes

#: Offset from a mesh to its surfels.
APART = mathutils.Vector((2.7, 0, 0))
FLOOR_COLOR, STEEL_COLOR, LABEL_COLOR = (0.50, 0.49, 0.47), (0.55, 0.57, 0.60), (0.03, 0.03, 0.035)


def models() -> list:
    """The models to convert: a painted Suzanne tilted upwards, and a nut in front of her."""
    (suzanne,) = painted_suzanne()
    suzanne.location, suzanne.rotation_euler = (-APART.x / 2, 0.35, 0), (-0.42, 0, 0.12)
    part = nut()
    part.location, part.rotation_euler = (-APART.x / 2 + 0.6, -1.45, 0), (0, 0, 0.35)
    for made in (suzanne, part):
        put_down(made)
    return [suzanne, part]


def put_down(made: bpy.types.Object) -> None:
    """Place an object on the floor, taking its modifiers into account."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    evaluated = made.evaluated_get(depsgraph)
    made.location.z -= min((evaluated.matrix_world @ vertex.co).z for vertex in evaluated.data.vertices)


def copies(meshes: list) -> list:
    """Copies of the meshes, which remain meshes."""
    made = [mesh.copy() for mesh in meshes]
    for one in made:
        bpy.context.collection.objects.link(one)
    return made


def set_up(surfels: list, size: tuple[int, int]) -> None:
    """Place surfels beside their meshes; add floor, labels, lights and camera. size: of the picture, in pixels."""
    for one in surfels:
        one.location += APART
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    scene.view_settings.view_transform = "Standard"
    scene.world = even_world((0.16, 0.17, 0.19))
    backdrop()
    for text, x in (("mesh", -APART.x / 2), ("surfels", APART.x / 2)):
        label(text, (x - 0.55, -1.8, 0.002))
    lamp(3.2, 1250, (1.0, 0.95, 0.88), (-5.0, -4.5, 9.0)).data.shape = "DISK"
    lamp(3.0, 220, (0.80, 0.89, 1.0), (7.0, -4.0, 4.0)).data.use_shadow = False
    # half of the default, so that it takes half a minute without a graphics card
    scene.surfel_splatting.samples = 8
    scene.camera = camera(size)


def nut() -> bpy.types.Object:
    """A hexagonal nut with bevelled edges, flat sides and a round hole."""
    around = [k * math.pi / 48 for k in range(96)]
    outer = [0.42 / math.cos((a + math.pi / 6) % (math.pi / 3) - math.pi / 6) for a in around]
    #: radius relative to the outer one, or to the hole, and height
    rings = (
        [(0.97, 0.16), (1.0, 0.13), (1.0, -0.13), (0.97, -0.16)],
        [(1.12, -0.16), (1.0, -0.13), (1.0, 0.13), (1.12, 0.16)],
    )
    points = [
        (r * math.cos(a), r * math.sin(a), z)
        for kind, radii in zip(rings, (outer, [0.22] * 96), strict=True)
        for share, z in kind
        for a, r in zip(around, [share * radius for radius in radii], strict=True)
    ]
    corners = (0, 0), (1, 0), (1, 1), (0, 1)
    faces = [[96 * ((ring + a) % 8) + (k + b) % 96 for a, b in corners] for ring in range(8) for k in range(96)]
    return _object("Nut", points, faces, plain_material("Steel", STEEL_COLOR, 0.32))


def backdrop() -> bpy.types.Object:
    """A floor that curves up into a wall."""
    turn = np.linspace(0, math.pi / 2, 25)
    profile = [(-14.0, 0.0), *zip(4 + 3 * np.sin(turn), 3 - 3 * np.cos(turn), strict=True), (7.0, 14.0)]
    points = [(x, y, z) for y, z in profile for x in (-16.0, 16.0)]
    faces = [(2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2) for k in range(len(profile) - 1)]
    made = _object("Floor", points, faces, plain_material("Floor", FLOOR_COLOR, 0.9))
    made.data.polygons.foreach_set("use_smooth", np.ones(len(faces), bool))
    return made


def _object(name: str, points, faces, material) -> bpy.types.Object:
    data = bpy.data.meshes.new(name)
    data.from_pydata(points, [], faces)
    made = bmesh.new()
    made.from_mesh(data)
    bmesh.ops.recalc_face_normals(made, faces=made.faces)
    made.to_mesh(data)
    made.free()
    data.materials.append(material)
    made = bpy.data.objects.new(name, data)
    bpy.context.collection.objects.link(made)
    return made


def label(text: str, location) -> None:
    """Text that lies on the floor."""
    data = bpy.data.curves.new(text, "FONT")
    data.body, data.size, data.align_x = text, 0.40, "CENTER"
    data.materials.append(plain_material("Label", LABEL_COLOR, 0.8))
    made = bpy.data.objects.new(text, data)
    made.location = location
    bpy.context.collection.objects.link(made)


def plain_material(name: str, color, roughness: float):
    """A Principled material of one linear colour."""
    material = bpy.data.materials.new(name)
    with_nodes(material)
    inputs = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED").inputs
    inputs["Base Color"].default_value, inputs["Roughness"].default_value = (*color, 1.0), roughness
    return material


def lamp(size: float, energy: float, color, location) -> bpy.types.Object:
    """An area light that points at the models."""
    made = add_light("AREA", energy, color)
    made.data.size, made.location = size, location
    made.rotation_euler = (
        (mathutils.Vector(location) - mathutils.Vector((0, 0, 0.6))).to_track_quat("Z", "Y").to_euler()
    )
    return made


def camera(size: tuple[int, int]) -> bpy.types.Object:
    """A camera in front of the models and slightly above; it moves back if the picture is narrow."""
    data = bpy.data.cameras.new("Camera")
    data.sensor_fit, data.lens = "HORIZONTAL", 63
    made = bpy.data.objects.new("Camera", data)
    bpy.context.collection.objects.link(made)
    middle, back = mathutils.Vector((0, -0.45, 0.62)), mathutils.Vector((0, -1.0, 0.40)).normalized()
    made.location = middle + 10.0 * max(1.0, 1.25 * size[1] / size[0]) * back
    made.rotation_euler = back.to_track_quat("Z", "Y").to_euler()
    return made
