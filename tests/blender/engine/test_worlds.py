# SPDX-License-Identifier: GPL-3.0-or-later
"""Worlds of any nodes are evaluated in all directions, as Cycles shows them."""

import math

import bpy
import numpy as np
import pytest

from splat_addon.reference.metrics import psnr


@pytest.fixture
def world(scene, add_camera):
    """A world with a Background node, seen in a part of the sky."""
    add_camera()
    scene.camera.rotation_euler, scene.camera.data.angle = (1.3, 0.2, 0.7), math.radians(80)
    scene.render.film_transparent = False
    scene.render.resolution_x = scene.render.resolution_y = 48
    scene.world = bpy.data.worlds.new("world")
    if scene.world.node_tree is None:
        scene.world.use_nodes = True
    return scene.world


def add(world, kind, **properties):
    node = world.node_tree.nodes.new(f"ShaderNode{kind}")
    for name, value in properties.items():
        setattr(node, name, value)
    return node


def link(world, node, socket=0, into="Color"):
    world.node_tree.links.new(node.outputs[socket], world.node_tree.nodes["Background"].inputs[into])


def sky(world, **properties):
    """An Environment Texture of smooth colours."""
    image = bpy.data.images.new("sky", 64, 32, float_buffer=True)
    rows, columns = np.mgrid[:32, :64]
    turn = columns / 64 * 2 * np.pi
    pixels = np.stack([1 + np.sin(turn), rows / 16, 1 + np.cos(2 * turn), np.ones((32, 64))], axis=2)
    image.pixels.foreach_set(pixels.astype(np.float32).ravel())
    return add(world, "TexEnvironment", image=image, **properties)


def pattern_of_any_strength(world):
    """Noise, by a ramp over the height."""
    place, split, ramp = add(world, "TexCoord"), add(world, "SeparateXYZ"), add(world, "ValToRGB")
    world.node_tree.links.new(place.outputs["Generated"], split.inputs[0])
    world.node_tree.links.new(split.outputs["Z"], ramp.inputs[0])
    link(world, ramp, into="Strength")
    link(world, add(world, "TexNoise"), "Color")


def coloured_mirror_ball(world):
    hue = add(world, "HueSaturation")
    hue.inputs["Hue"].default_value = 0.7
    world.node_tree.links.new(sky(world, projection="MIRROR_BALL").outputs[0], hue.inputs["Color"])
    link(world, hue)


def stretched_picture_and_a_colour(world):
    tree, picture, place, mapping = world.node_tree, sky(world), add(world, "TexCoord"), add(world, "Mapping")
    mapping.inputs["Scale"].default_value, mapping.inputs["Rotation"].default_value = (1, 2, 1), (0.3, 0, 0.5)
    tree.links.new(place.outputs["Generated"], mapping.inputs[0])
    tree.links.new(mapping.outputs[0], picture.inputs[0])
    link(world, picture)
    other, total = add(world, "Background"), add(world, "AddShader")
    other.inputs["Color"].default_value = (0.2, 0.4, 0.1, 1)
    for k, node in enumerate((tree.nodes["Background"], other)):
        tree.links.new(node.outputs[0], total.inputs[k])
    output = next(node for node in tree.nodes if node.type == "OUTPUT_WORLD")
    tree.links.new(total.outputs[0], output.inputs["Surface"])


WORLDS = pattern_of_any_strength, coloured_mirror_ball, stretched_picture_and_a_colour


@pytest.mark.parametrize("make", WORLDS, ids=lambda make: make.__name__)
def test_a_world_of_nodes_is_that_of_cycles(make, world, picture, switch_to_cycles, said):
    make(world)
    ours = picture()[..., :3]
    assert "The world" not in said()
    switch_to_cycles()
    truth = picture()[..., :3]
    assert np.ptp(truth) > 0.1
    assert psnr(ours / truth.max(), truth / truth.max()) > 35
