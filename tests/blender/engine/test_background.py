# SPDX-License-Identifier: GPL-3.0-or-later
"""The background shows the world or is transparent, and edges in front of it blend with it correctly."""

from itertools import pairwise

import bpy
import numpy as np
import pytest

from splat_addon.blender.engine import viewport
from splat_addon.blender.export.changes import changes_of
from splat_addon.blender.export.notes import Notes
from splat_addon.blender.export.surfel_store import SurfelStore


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


def test_a_world_of_what_cannot_be_read_is_said_to_be_used_plainly(scene, add_camera, add_world, picture, said):
    add_camera()
    tree = add_world((0.2, 0.4, 0.8)).node_tree
    sky = tree.nodes.new("ShaderNodeTexEnvironment")
    tree.links.new(sky.outputs["Color"], tree.nodes["Background"].inputs["Color"])
    picture()
    assert "The world 'world' is textured; its Background node's plain colour is used" in said()


@pytest.fixture
def add_picture(add_world, saved_image):
    """add_picture(color) -> the image of a file of 4 x 2 pixels, which is the world's picture."""

    def add(color) -> bpy.types.Image:
        tree = add_world((0, 0, 0)).node_tree
        node = tree.nodes.new("ShaderNodeTexEnvironment")
        node.image = bpy.data.images.load(saved_image("sky.png", color))
        tree.links.new(node.outputs["Color"], tree.nodes["Background"].inputs["Color"])
        return node.image

    return add


@pytest.fixture
def read_world(scene):
    """read_world(is_edited) -> what a view has read of the world in its next picture, and what it says."""
    store = SurfelStore()

    def read(is_edited=False):
        notes = Notes()
        store.begin_frame(set(), is_sky_edited=is_edited)
        return store.world.read(scene.world, notes)["environment"], notes.sentences()

    return read


def test_a_world_s_picture_that_stays_is_kept(add_picture, read_world):
    add_picture((1, 0, 0, 1))
    first, _ = read_world()
    assert read_world()[0] is first and read_world(is_edited=True)[0] is first


def test_a_reloaded_picture_of_the_world_is_read_again(add_picture, saved_image, read_world):
    image = add_picture((1, 0, 0, 1))
    read_world()
    saved_image("sky.png", (0, 1, 0, 1))
    image.reload()
    assert np.array_equal(read_world(is_edited=True)[0].pixels[0, 0], (0, 1, 0))


@pytest.mark.parametrize(("edit", "expected"), [("file", 1.0), ("colour space", 0.6), ("alpha mode", 0.318)])
def test_another_reading_of_the_world_s_picture_is_seen(edit, expected, add_picture, saved_image, read_world):
    image = add_picture((0.6, 0.6, 0.6, 0.4))
    before = read_world()[0].pixels[0, 0, 0]
    if edit == "file":
        image.filepath = saved_image("other.png", (1, 1, 1, 1))
    elif edit == "colour space":
        image.colorspace_settings.name = "Non-Color"
    else:
        image.alpha_mode = "NONE"
    after = read_world()[0].pixels[0, 0, 0]
    # Cycles multiplies the encoded bytes by the alpha: 0.6 * 0.4, which is 0.0467
    assert before == pytest.approx(0.0467, abs=2e-3) and after == pytest.approx(expected, abs=2e-3)


def test_what_a_world_s_picture_lacks_is_said_in_each_frame(add_picture, read_world, tmp_path):
    add_picture((1, 0, 0, 1))
    node = bpy.context.scene.world.node_tree.nodes["Environment Texture"]
    image = node.image = bpy.data.images.new("broken", 4, 2, float_buffer=True)
    image.pixels[0] = np.inf
    image.filepath_raw, image.file_format = str(tmp_path / "broken.exr"), "OPEN_EXR"
    image.save()
    first, second = read_world()[1], read_world()[1]
    assert "The image 'broken' has infinite or too large numbers; its pixels that count as 0: 1" in first == second


@pytest.fixture
def told(scene, add_square, add_picture):
    """told(edit) -> whether a view is told that the sky may be another one, and that only objects move. edit: of the
    square, its Principled node, and the world's picture."""
    square, image, found = add_square(), add_picture((1, 0, 0, 1)), []
    square.data.materials.append(bpy.data.materials.new("material"))
    square.active_material.use_nodes = True

    def note(scene, depsgraph):
        found.append((changes_of(depsgraph).is_sky_edited, viewport._only_moves_objects(depsgraph)))

    def tell(edit):
        bpy.context.view_layer.update()
        bpy.app.handlers.depsgraph_update_post.append(note)
        try:
            edit(square, square.active_material.node_tree.nodes["Principled BSDF"], image)
            bpy.context.view_layer.update()
        finally:
            bpy.app.handlers.depsgraph_update_post.remove(note)
        return found[-1]

    return tell


@pytest.mark.parametrize(
    ("edit", "expected"),
    [
        (lambda square, shader, image: square.location.__setitem__(0, 1), (False, True)),
        (lambda square, shader, image: shader.inputs[0].default_value.__setitem__(0, 0.1), (False, False)),
        (lambda square, shader, image: image.reload(), (True, False)),
    ],
    ids=["move", "paint", "reload"],
)
def test_pictures_are_looked_at_again_only_after_edits_of_their_own(edit, expected, told):
    """Looking at 2,048 pixels squared of 8 bits takes 0.2 s, which a drag must not wait for."""
    assert told(edit) == expected


def mixed(world, kind, color, factor=None):
    """Put a shader of that kind between the world's Background node and its output, with a second Background."""
    tree = world.node_tree
    second, both = tree.nodes.new("ShaderNodeBackground"), tree.nodes.new(kind)
    second.inputs["Color"].default_value, second.inputs["Strength"].default_value = (*color, 1), 2
    sockets = [socket for socket in both.inputs if socket.type == "SHADER"]
    for node, socket in zip((tree.nodes["Background"], second), sockets, strict=True):
        tree.links.new(node.outputs[0], socket)
    tree.links.new(both.outputs[0], tree.nodes["World Output"].inputs["Surface"])
    if isinstance(factor, float):
        both.inputs[0].default_value = factor
    elif factor:
        tree.links.new(tree.nodes.new("ShaderNodeLightPath").outputs[factor], both.inputs[0])
    return tree


@pytest.mark.parametrize(("kind", "factor"), [("ShaderNodeMixShader", 0.25), ("ShaderNodeAddShader", None)])
def test_mixed_and_added_backgrounds_are_as_in_cycles(kind, factor, scene, add_camera, add_world, as_cycles):
    add_camera()
    mixed(add_world((0.2, 0.4, 0.8), 1.5), kind, (0.5, 0.1, 0.2), factor)
    scene.render.film_transparent = False
    assert as_cycles()


@pytest.mark.parametrize("has_picture", [False, True])
def test_one_background_lights_and_the_camera_sees_another(
    has_picture, scene, add_camera, add_world, add_sheet, picture
):
    add_camera((0, 0, 4))
    add_sheet(side=1.0, count=8)
    tree = mixed(add_world((0.2, 0.4, 0.8)), "ShaderNodeMixShader", (0.05, 0.1, 0.2), "Is Camera Ray")
    if has_picture:
        image = bpy.data.images.new("sky", 8, 4, float_buffer=True)
        image.pixels.foreach_set(np.tile(np.float32((0.2, 0.4, 0.8, 1)), 32))
        node = tree.nodes.new("ShaderNodeTexEnvironment")
        node.image = image
        tree.links.new(node.outputs[0], tree.nodes["Background"].inputs["Color"])
    scene.render.film_transparent, scene.surfel_splatting.shading = False, "phong"
    drawn = picture()
    assert np.allclose(drawn[0, 0], (0.1, 0.2, 0.4, 1), atol=1e-5)
    middle = drawn[16, 16, :3]
    assert np.allclose(middle / middle[2], (0.25, 0.5, 1), atol=0.02) and middle[2] > 0.6


def test_a_background_in_a_group_is_drawn_with_the_group_s_values(scene, add_camera, add_world, picture):
    add_camera()
    tree, group = add_world((0, 0, 0)).node_tree, bpy.data.node_groups.new("sky", "ShaderNodeTree")
    group.interface.new_socket("Tint", in_out="INPUT", socket_type="NodeSocketColor")
    group.interface.new_socket("Sky", in_out="OUTPUT", socket_type="NodeSocketShader")
    inner = [group.nodes.new(kind) for kind in ("NodeGroupInput", "ShaderNodeBackground", "NodeGroupOutput")]
    for source, target in pairwise(inner):
        group.links.new(source.outputs[0], target.inputs[0])
    node = tree.nodes.new("ShaderNodeGroup")
    node.node_tree, inner[1].inputs["Strength"].default_value = group, 2
    node.inputs["Tint"].default_value = (0.1, 0.2, 0.3, 1)
    tree.links.new(node.outputs[0], tree.nodes["World Output"].inputs["Surface"])
    scene.render.film_transparent = False
    assert np.allclose(picture(), (0.2, 0.4, 0.6, 1))


def test_a_world_s_unknown_shaders_are_named(scene, add_camera, add_world, picture, said):
    add_camera()
    tree = mixed(add_world((0.2, 0.4, 0.8)), "ShaderNodeMixShader", (0.5, 0.1, 0.2))
    mix = tree.get_output_node("ALL").inputs["Surface"].links[0].from_node
    tree.links.new(tree.nodes.new("ShaderNodeBsdfTransparent").outputs[0], mix.inputs[1])
    scene.render.film_transparent = False
    assert np.allclose(picture(), (0.5, 0.1, 0.2, 1))
    words = said()
    assert "The world 'world' has a Transparent BSDF node, which counts as black" in words
    assert "(2 times)" not in words
