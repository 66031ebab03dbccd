# SPDX-License-Identifier: GPL-3.0-or-later
"""Worlds of any nodes are evaluated in all directions, as Cycles shows them."""

import math

import bpy
import numpy as np
import pytest

from splat_addon.blender.export.notes import Notes
from splat_addon.blender.export.world import WorldStore
from splat_addon.blender.working_space import to_xyz
from splat_addon.reference.metrics import psnr
from splat_addon.shading_nodes.skies import Air, once_scattered


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


def sky_node(world, kind, **properties):
    """A Sky Texture node. kind: as Blender 5 names it; in 4.5 some are absent."""
    node = add(world, "TexSky")
    known = [item.identifier for item in node.bl_rna.properties["sky_type"].enum_items]
    node.sky_type = kind if kind in known else "NISHITA" if "SCATTERING" in kind else pytest.skip(f"no {kind} here")
    for name, value in properties.items():
        setattr(node, name, value)
    return node


def sky_of_light_scattered_once(world):
    at = {"altitude": 800, "air_density": 1.5, "ozone_density": 2}
    link(world, sky_node(world, "SINGLE_SCATTERING", sun_disc=False, sun_elevation=2.6, sun_rotation=0.9, **at))


def turned_and_tinted_sky_of_light_scattered_often(world):
    made = sky_node(world, "MULTIPLE_SCATTERING", sun_disc=False, sun_elevation=0.2, sun_rotation=2.0)
    place, mapping, mix = (add(world, kind) for kind in ("TexCoord", "Mapping", "MixRGB"))
    mapping.inputs["Rotation"].default_value, mix.inputs[0].default_value = (0.5, 0.3, 1.0), 0.3
    world.node_tree.links.new(place.outputs["Generated"], mapping.inputs[0])
    world.node_tree.links.new(mapping.outputs[0], made.inputs[0])
    world.node_tree.links.new(made.outputs[0], mix.inputs[1])
    link(world, mix)


def sun_of_a_sky(world):
    """Wide, so that pixels show its shape."""
    made = sky_node(world, "SINGLE_SCATTERING", sun_size=0.3, sun_intensity=0.5, sun_elevation=0.4, sun_rotation=-0.6)
    link(world, made)


def sky_of_preetham(world):
    link(world, sky_node(world, "PREETHAM", turbidity=4.0, sun_direction=(0.3, -0.5, 0.4)))


def sky_mixed_with_a_colour_by_a_pattern(world):
    tree, mix = world.node_tree, add(world, "MixShader")
    sides = tree.nodes["Background"], add(world, "Emission")
    link(world, sky(world))
    sides[1].inputs["Color"].default_value = (0.9, 0.1, 0.3, 1)
    tree.links.new(add(world, "TexWave").outputs["Color"], mix.inputs[0])
    for k, node in enumerate(sides):
        tree.links.new(node.outputs[0], mix.inputs[k + 1])
    output = next(node for node in tree.nodes if node.type == "OUTPUT_WORLD")
    tree.links.new(mix.outputs[0], output.inputs["Surface"])


WORLDS = (
    sky_mixed_with_a_colour_by_a_pattern,
    pattern_of_any_strength,
    coloured_mirror_ball,
    stretched_picture_and_a_colour,
    sky_of_light_scattered_once,
    turned_and_tinted_sky_of_light_scattered_often,
    sun_of_a_sky,
    sky_of_preetham,
)


@pytest.mark.parametrize("make", WORLDS, ids=lambda make: make.__name__)
def test_a_world_of_nodes_is_that_of_cycles(make, world, picture, switch_to_cycles, said):
    make(world)
    ours = picture()[..., :3]
    assert "The world" not in said()
    switch_to_cycles()
    world.cycles.sampling_method = "NONE"  # it lights nothing here, and to find where it is bright takes seconds
    truth = picture()[..., :3]
    assert np.ptp(truth) > 0.1
    assert psnr(ours / truth.max(), truth / truth.max()) > 35


@pytest.mark.parametrize("output", ["Location", "Color", "Random", None])
def test_what_a_world_reads_of_an_object_is_unreadable(output, world):
    """It has none. output: of an Object Info node, or None for an Attribute node of the object."""
    node = add(world, "ObjectInfo") if output else add(world, "Attribute", attribute_type="OBJECT", attribute_name="it")
    link(world, node, output or "Color")
    notes = Notes()
    assert WorldStore().read(world, notes)["environment"] is None
    (sentence,) = notes.sentences()
    assert "The world 'world' is textured; its Background node's plain colour is used" in sentence


def test_a_sky_of_hosek_and_wilkie_is_named_and_about_as_bright(world, picture, switch_to_cycles, said):
    link(world, sky_node(world, "HOSEK_WILKIE", ground_albedo=0.3, turbidity=3.0, sun_direction=(0.3, -0.5, 0.4)))
    ours = picture()[..., :3]
    words = said()
    assert "Hosek / Wilkie" in words and "Preetham's sky is used" in words
    switch_to_cycles()
    assert 1 / 3 < ours.mean() / picture()[..., :3].mean() < 3


def test_the_sun_of_a_sky_lights_as_its_irradiance_says(world):
    node = sky_node(world, "SINGLE_SCATTERING", sun_elevation=1.2, sun_rotation=0.4)
    link(world, node)
    environment = WorldStore().read(world, Notes())["environment"]
    sun = environment.sun_above(10.0)
    air = Air(False, 1.2, node.altitude, 1.0, 1.0, 1.0)
    # A disc that is darker to its rim has 0.8 of an even one's light; the sky around it adds a little.
    expected = 0.8 * np.linalg.inv(to_xyz()) @ once_scattered.sunlight(air, 1.2)
    np.testing.assert_allclose(sun.irradiance, expected, rtol=0.04)
    assert sun.angle < 2 * node.sun_size
    toward = np.cos(1.2) * np.sin(0.4), np.cos(1.2) * np.cos(0.4), np.sin(1.2)
    np.testing.assert_allclose(sun.toward, toward, atol=0.01)
