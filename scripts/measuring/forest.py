# SPDX-License-Identifier: GPL-3.0-or-later
"""Cards with leaves in Blender: a stack of them, and a forest of trees that Geometry Nodes place."""

from __future__ import annotations

import math

import bpy
import numpy as np
from mathutils import Vector

from demonstration.scene import with_nodes
from measuring.blender_scene import lit_scene

#: Surfaces behind one another that a ray of Cycles passes.
TRANSPARENT_BOUNCES = 512
CARDS = 32
#: Cards of a crown, and their edge; the crown's half-axes, and the height of its middle.
CROWN_CARDS, CARD_EDGE, CROWN, CROWN_HEIGHT = 60, 0.8, (1.0, 1.0, 1.3), 2.4
TRUNK_RADIUS, TRUNK_SIDES = 0.09, 6
#: The square that trees stand on, and the rise of its ground.
FIELD, SLOPE = 120.0, 0.3
#: The camera's place, from the middle of the field's near edge.
EYE = (0.0, -25.0, 14.0)
LEAVES_ACROSS, TEXELS = 10, 128


def leaf_image() -> bpy.types.Image:
    """Elliptical leaves that cover about half of it, transparent between."""
    random, texels = np.random.default_rng(3), np.zeros((TEXELS, TEXELS, 4), np.float32)
    y, x = (np.mgrid[0:TEXELS, 0:TEXELS] + 0.5) / TEXELS
    for _leaf in range(LEAVES_ACROSS**2 // 2):
        place, turn = random.uniform(0.08, 0.92, 2), random.uniform(0, math.pi)
        along = (x - place[0]) * math.cos(turn) + (y - place[1]) * math.sin(turn)
        beside = (y - place[1]) * math.cos(turn) - (x - place[0]) * math.sin(turn)
        is_leaf = (along / 0.085) ** 2 + (beside / 0.04) ** 2 < 1
        texels[is_leaf] = *(np.array((0.28, 0.42, 0.12)) * random.uniform(0.7, 1.3)), 1.0
        texels[..., :3] = np.where(texels[..., 3:] > 0, texels[..., :3], (0.28, 0.42, 0.12))
    image = bpy.data.images.new("leaves", TEXELS, TEXELS, alpha=True)
    image.pixels.foreach_set(texels.ravel())
    image.pack()
    return image


def material(name: str, color, image: bpy.types.Image | None = None) -> bpy.types.Material:
    """Matt; with an image, whose alpha cuts holes."""
    made = bpy.data.materials.new(name)
    with_nodes(made)
    tree = made.node_tree
    surface = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    surface.inputs["Base Color"].default_value = (*color, 1.0)
    surface.inputs["Roughness"].default_value, surface.inputs["Specular IOR Level"].default_value = 1.0, 0.0
    if image is not None:
        texture = tree.nodes.new("ShaderNodeTexImage")
        texture.image = image
        tree.links.new(texture.outputs["Color"], surface.inputs["Base Color"])
        tree.links.new(texture.outputs["Alpha"], surface.inputs["Alpha"])
    return made


def linked(name: str, places, faces, *materials, slots=None, uvs=None) -> bpy.types.Object:
    """An object of the scene. slots: of each face. uvs: (loops, 2)."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(np.asarray(places).tolist(), [], faces)
    for own in materials:
        mesh.materials.append(own)
    if slots is not None:
        mesh.polygons.foreach_set("material_index", slots)
    if uvs is not None:
        mesh.uv_layers.new(name="UVMap").data.foreach_set("uv", np.asarray(uvs, np.float32).ravel())
    made = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(made)
    return made


UNIT = np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)])


def cards(places, across, up, edge: float, uvs=UNIT + 0.5):
    """Corners, faces and coordinates of squares. places, across, up: (n, 3)."""
    corners = places[:, None] + edge * (UNIT[:, :1] * across[:, None] + UNIT[:, 1:] * up[:, None])
    faces = np.arange(4 * len(places)).reshape(-1, 4)
    return corners.reshape(-1, 3), faces.tolist(), np.tile(uvs, (len(places), 1))


def new_scene(size, world, sun: float) -> bpy.types.Scene:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = lit_scene(size, world, (math.radians(40), math.radians(25), 0.5), sun)
    scene.cycles.transparent_max_bounces = TRANSPARENT_BOUNCES
    scene.render.film_transparent = False
    return scene


def looking(scene: bpy.types.Scene, eye, target, lens: float) -> None:
    scene.camera.location, scene.camera.data.lens = eye, lens
    scene.camera.rotation_euler = (Vector(target) - Vector(eye)).to_track_quat("-Z", "Y").to_euler()
    scene.camera.data.clip_end = 1000


def stack(size, pixels: int) -> tuple[bpy.types.Scene, list[bpy.types.Object]]:
    """Black cards, each turned by itself, before a plane that glows red, and the cards. Half of each is clear.

    pixels: their edge in the picture.
    """
    scene = new_scene(size, (0, 0, 0), 0.0)
    distance = 100.0
    scene.camera.data.sensor_width, scene.camera.data.lens = 36, 50
    edge = pixels * distance * 36 / 50 / size[0]
    looking(scene, (0, 0, distance), (0, 0, 0), 50)
    red = material("red", (0, 0, 0))
    shader = next(node for node in red.node_tree.nodes if node.type == "BSDF_PRINCIPLED").inputs
    shader["Emission Color"].default_value, shader["Emission Strength"].default_value = (1, 0, 0, 1), 1.0
    corners, faces, _ = cards(np.array([(0, 0, -3.0)]), np.eye(3)[:1], np.eye(3)[1:2], 200.0)
    linked("plane", corners, faces, red)
    leaves, random, made = material("leaves", (0, 0, 0), leaf_image()), np.random.default_rng(1), []
    for number in range(CARDS):
        turned = np.roll(UNIT + 0.5, random.integers(4), axis=0)
        shift = random.uniform(-0.02, 0.02, 2) * edge
        place = np.array([(*shift, -0.05 * number * edge)])
        corners, faces, uvs = cards(place, np.eye(3)[:1], np.eye(3)[1:2], edge, turned)
        made.append(linked(f"card {number}", corners, faces, leaves, uvs=uvs))
    return scene, made


def tree() -> bpy.types.Object:
    """A trunk, and a crown of cards."""
    random = np.random.default_rng(2)
    within = random.normal(size=(CROWN_CARDS, 3))
    within *= (random.uniform(0, 1, (CROWN_CARDS, 1)) ** (1 / 3)) / np.linalg.norm(within, axis=1, keepdims=True)
    frames = np.linalg.qr(random.normal(size=(CROWN_CARDS, 3, 3)))[0]
    places = within * CROWN + (0, 0, CROWN_HEIGHT)
    corners, faces, uvs = cards(places, frames[:, 0], frames[:, 1], CARD_EDGE)
    around = np.arange(TRUNK_SIDES) * 2 * math.pi / TRUNK_SIDES
    ring = TRUNK_RADIUS * np.stack([np.cos(around), np.sin(around)], axis=1)
    trunk = np.concatenate([np.pad(ring, ((0, 0), (0, 1)), constant_values=z) for z in (0, CROWN_HEIGHT)])
    first, n = len(corners), TRUNK_SIDES
    sides = [(first + k, first + (k + 1) % n, first + n + (k + 1) % n, first + n + k) for k in range(n)]
    slots = [0] * len(faces) + [1] * n
    uvs = np.concatenate([uvs, np.zeros((4 * n, 2))])
    leaves, bark = material("leaves", (0, 0, 0), leaf_image()), material("bark", (0.2, 0.1, 0.05))
    return linked("tree", np.concatenate([corners, trunk]), [*faces, *sides], leaves, bark, slots=slots, uvs=uvs)


def forest(size, count: int, world=(0.5, 0.65, 0.9)):
    """Trees that Geometry Nodes place on a hillside without ground, the tree, and the node that hands it on."""
    scene = new_scene(size, world, 3.0)
    scene.render.film_transparent = True
    looking(scene, EYE, (0, FIELD * 0.6, FIELD * 0.6 * SLOPE), 40)
    made, random = tree(), np.random.default_rng(0)
    made.location = 0, 0, -500
    places = random.uniform((-FIELD / 2, 0), (FIELD / 2, FIELD), (count, 2))
    ground = linked("places", np.column_stack([places, SLOPE * places[:, 1]]), [])
    nodes = bpy.data.node_groups.new("forest", "GeometryNodeTree")
    for way in ("INPUT", "OUTPUT"):
        nodes.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    types = "NodeGroupInput", "GeometryNodeInstanceOnPoints", "GeometryNodeObjectInfo", "NodeGroupOutput"
    begin, placing, source, end = (nodes.nodes.new(kind) for kind in types)
    turn = nodes.nodes.new("FunctionNodeRandomValue")
    turn.data_type = "FLOAT_VECTOR"
    turn.inputs["Max"].default_value = (0, 0, 2 * math.pi)
    source.inputs["Object"].default_value, source.inputs["As Instance"].default_value = made, True
    nodes.links.new(turn.outputs["Value"], placing.inputs["Rotation"])
    nodes.links.new(begin.outputs[0], placing.inputs["Points"])
    nodes.links.new(source.outputs["Geometry"], placing.inputs["Instance"])
    nodes.links.new(placing.outputs[0], end.inputs[0])
    ground.modifiers.new("forest", "NODES").node_group = nodes
    return scene, made, source


def far_rows(scene: bpy.types.Scene) -> slice:
    """The rows of a picture in which only trees of the field's far third are seen."""
    bpy.context.view_layer.update()
    matrix = scene.camera.matrix_world.inverted()
    start = FIELD * 2 / 3
    top = matrix @ Vector((0, start, SLOPE * start + CROWN_HEIGHT + CROWN[2] + CARD_EDGE))
    camera, height = scene.camera.data, scene.render.resolution_y
    pixels = camera.lens / camera.sensor_width * scene.render.resolution_x
    return slice(math.ceil(height / 2 + pixels * top.y / -top.z), height)
