# SPDX-License-Identifier: GPL-3.0-or-later
"""The background shows the world or is transparent, and edges in front of it blend with it correctly."""

import bpy
import numpy as np
import pytest


@pytest.fixture
def add_world(scene):
    """add_world(color, strength) -> the scene's world, with a Background node."""

    def add(color, strength=1.0) -> bpy.types.World:
        scene.world = bpy.data.worlds.new("world")
        scene.world.use_nodes = True
        background = scene.world.node_tree.nodes["Background"].inputs
        background["Color"].default_value, background["Strength"].default_value = (*color, 1), strength
        return scene.world

    return add


@pytest.fixture
def discs(scene, add_camera, add_surfels):
    """A few slanted discs with gaps between them, drawn with nine samples per pixel."""
    scene.surfel_splatting.supersampling = 3
    add_camera()
    random = np.random.default_rng(2)
    add_surfels(random.uniform(-2.5, 2.5, (12, 3)), random.normal(size=(12, 3)), 0.6, (0.9, 0.6, 0.2, 1))


@pytest.fixture
def as_cycles(switch_to_cycles, picture):
    """Whether Cycles draws the same picture if the scene has no surfaces."""

    def same() -> bool:
        ours = picture()
        switch_to_cycles()
        return np.allclose(ours, picture(), rtol=1e-5)

    return same


def test_the_background_is_the_world_s_node_as_in_cycles(scene, add_camera, add_world, as_cycles):
    add_camera()
    add_world((0.2, 0.4, 0.8), 2.5)
    scene.render.film_transparent = False
    assert as_cycles()


@pytest.mark.skipif(bpy.app.version >= (5, 0, 0), reason="from Blender 5.0 every world has nodes")
def test_the_background_is_the_world_s_colour_without_nodes_as_in_cycles(scene, add_camera, add_world, as_cycles):
    add_camera()
    add_world((0.2, 0.4, 0.8)).use_nodes = False
    scene.world.color = (0.3, 0.1, 0.7)
    scene.render.film_transparent = False
    assert as_cycles()


def test_the_background_is_black_without_a_world_as_in_cycles(scene, add_camera, as_cycles):
    add_camera()
    scene.render.film_transparent = False
    assert as_cycles()


def test_the_background_fills_the_picture_of_a_scene_with_other_things_only(scene, add_camera, add_world, picture):
    add_camera()
    add_world((0.2, 0.4, 0.8))
    bpy.ops.mesh.primitive_cube_add()
    scene.surfel_splatting.render_meshes = "HIDDEN"
    scene.render.film_transparent = False
    assert np.allclose(picture(), (0.2, 0.4, 0.8, 1))


def test_a_transparent_film_leaves_the_world_out(scene, add_camera, add_world, as_cycles, picture):
    add_camera()
    add_world((0.2, 0.4, 0.8))
    assert not picture().any()
    assert as_cycles()


def test_edges_are_premultiplied(discs, picture):
    drawn = picture()
    assert ((drawn[..., 3] > 0.1) & (drawn[..., 3] < 0.9)).sum() > 30
    assert np.allclose(drawn[..., :3], drawn[..., 3:] * (0.9, 0.6, 0.2), atol=1e-5)


def test_over_the_world_s_colour_a_transparent_picture_is_the_opaque_one(scene, discs, add_world, picture):
    """So the compositor's Alpha Over gives no dark rim, and no rim in the world's colour."""
    add_world((1, 1, 1))
    transparent = picture()
    scene.render.film_transparent = False
    opaque = picture()
    over = transparent[..., :3] + (1 - transparent[..., 3:]) * np.ones(3)
    assert np.allclose(over, opaque[..., :3], atol=1e-5)
    assert np.array_equal(opaque[..., 3], np.ones_like(opaque[..., 3]))


def test_a_textured_world_is_said_to_be_used_plainly(scene, add_camera, add_world, picture, said):
    add_camera()
    tree = add_world((0.2, 0.4, 0.8)).node_tree
    sky = tree.nodes.new("ShaderNodeTexNoise")
    tree.links.new(sky.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    picture()
    assert "The world 'world' is textured; its Background node's plain colour and strength are used" in said()
