# SPDX-License-Identifier: GPL-3.0-or-later
"""A square whose material reads its inputs from one image: its surfels are compared with the mesh in Cycles."""

import bpy
import numpy as np
import pytest

#: The colours of the image's left and right half.
HALVES = np.array([(0.2, 0.25, 0.0), (0.9, 0.8, 1.0)])
NORMALS = (np.array([(0.4, 0.0, 0.916), (-0.8, 0.2, 0.566)]) + 1) / 2


@pytest.fixture
def square(scene, add_camera, add_square):
    """The unit square, with a lamp and a camera that sees all of it, and the nodes of its material."""
    scene.surfel_splatting.shading = "principled"
    scene.render.film_transparent = True
    add_camera((0.5, 0.5, 2), type="ORTHO", ortho_scale=1.25)
    lamp = bpy.data.lights.new("lamp", "POINT")
    lamp.energy, lamp.shadow_soft_size = 60, 0.0
    placed = bpy.data.objects.new("lamp", lamp)
    placed.location = (0.3, 0.6, 1.5)
    scene.collection.objects.link(placed)
    made = add_square()
    material = bpy.data.materials.new("material")
    material.use_nodes = True
    made.data.materials.append(material)
    return made


def texture(tree, values):
    """An Image Texture node with two given halves, as raw values."""
    image = bpy.data.images.new("halves", 2, 1, alpha=False, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_set(np.append(values, np.ones((2, 1)), axis=1).astype(np.float32).ravel())
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image, node.interpolation = image, "Closest"
    return node.outputs["Color"]


def wire_roughness_and_metallic(tree, inputs):
    inputs["Base Color"].default_value = (0.8, 0.5, 0.3, 1)
    separate = tree.nodes.new("ShaderNodeSeparateColor")
    tree.links.new(texture(tree, HALVES), separate.inputs[0])
    tree.links.new(separate.outputs["Green"], inputs["Roughness"])
    tree.links.new(separate.outputs["Blue"], inputs["Metallic"])


def wire_emission(tree, inputs):
    inputs["Emission Strength"].default_value = 3.0
    tree.links.new(texture(tree, HALVES), inputs["Emission Color"])


def wire_normal_map(tree, inputs):
    node = tree.nodes.new("ShaderNodeNormalMap")
    tree.links.new(texture(tree, NORMALS), node.inputs["Color"])
    tree.links.new(node.outputs["Normal"], inputs["Normal"])


def wire_plain_emission(tree, inputs):
    inputs["Emission Color"].default_value = (0.2, 0.4, 0.8, 1)
    inputs["Emission Strength"].default_value = 2.0


def at_output(tree, kind):
    shader = tree.nodes.new(kind)
    tree.links.new(shader.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    return shader.inputs


def wire_diffuse_shader(tree, inputs):
    tree.links.new(texture(tree, HALVES), at_output(tree, "ShaderNodeBsdfDiffuse")["Color"])


def wire_emission_shader(tree, inputs):
    sockets = at_output(tree, "ShaderNodeEmission")
    tree.links.new(texture(tree, HALVES), sockets["Color"])
    sockets["Strength"].default_value = 2.5


def wire_no_specular(tree, inputs):
    tree.links.new(texture(tree, HALVES), inputs["Base Color"])
    inputs["Specular IOR Level"].default_value = 0.0


@pytest.mark.parametrize(
    "wire",
    [
        wire_roughness_and_metallic,
        wire_emission,
        wire_normal_map,
        wire_plain_emission,
        wire_diffuse_shader,
        wire_emission_shader,
        wire_no_specular,
    ],
    ids=lambda w: w.__name__,
)
def test_a_textured_square_is_cycles_square(wire, square, convert, picture, switch_to_cycles, capfd):
    tree = square.data.materials[0].node_tree
    wire(tree, tree.nodes["Principled BSDF"].inputs)
    (made,) = convert(resolution=64)
    square.hide_render = True
    ours = picture()
    assert "plain value" not in capfd.readouterr().out
    square.hide_render, made.hide_render = False, True
    switch_to_cycles(samples=16)
    theirs = picture()
    # rows and columns of each half, away from its rim and from the line between the halves
    for columns in (slice(6, 13), slice(19, 26)):
        mine, other = (p[6:26, columns, :3] for p in (ours, theirs))
        assert np.abs(mine - other).max() < 0.06 * other.max()
    middle = [ours[6:26, columns, :3].mean(axis=(0, 1)) for columns in (slice(6, 13), slice(19, 26))]
    assert wire is wire_plain_emission or np.abs(middle[0] - middle[1]).max() > 0.05


def test_surfels_without_their_textures_say_so(square, convert, picture, capfd):
    convert(resolution=16, follow=False)
    tree = square.data.materials[0].node_tree
    wire_emission(tree, tree.nodes["Principled BSDF"].inputs)
    bpy.data.objects.remove(square)  # otherwise the surfels take the texture
    picture()
    said = capfd.readouterr().out
    assert "textures Emission Color" in said and "Convert the mesh again" in said


def test_surfels_take_a_texture_that_came_after_the_conversion(square, convert, picture, capfd):
    convert(resolution=16)
    tree = square.data.materials[0].node_tree
    wire_emission(tree, tree.nodes["Principled BSDF"].inputs)
    square.hide_render = True
    middle = [picture()[6:26, columns, :3].mean(axis=(0, 1)) for columns in (slice(6, 13), slice(19, 26))]
    assert np.abs(middle[0] - middle[1]).max() > 0.05
    assert "Convert the mesh again" not in capfd.readouterr().out
