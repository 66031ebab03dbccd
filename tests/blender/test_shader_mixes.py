# SPDX-License-Identifier: GPL-3.0-or-later
"""What Cycles bakes for mixed, added and colourless shaders looks like the shader and is never black."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.materials.graphs.channels import constant_of
from splat_addon.blender.materials.shader_mixes import emitted
from splat_addon.blender.materials.surface_shaders import Shader, shader_at

RED, BLUE = (0.8, 0.1, 0.1, 1), (0.1, 0.2, 0.9, 1)


@pytest.fixture
def tree(add_square):
    """The node tree of a square's material, which has an output node only."""
    material = bpy.data.materials.new("made")
    if material.node_tree is None:
        material.use_nodes = True
    for node in list(material.node_tree.nodes):
        if node.type != "OUTPUT_MATERIAL":
            material.node_tree.nodes.remove(node)
    add_square().data.materials.append(material)
    return material.node_tree


@pytest.fixture
def baked(tree, convert, surfels_of):
    """baked(shader) -> the surfels of a square with that shader connected to the material's output."""

    def bake(shader):
        tree.links.new(shader.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
        (made,) = convert(resolution=4, bake_materials=True)
        return surfels_of(made)

    return bake


def add(tree, kind, color=None, **values):
    node = tree.nodes.new(kind)
    if color is not None:
        tree.links.new(varying(tree, color), node.inputs["Color"])
    for name, value in values.items():
        node.inputs[name].default_value = value
    return node


def varying(tree, color):
    """A colour that nodes make, so that it counts as one that varies."""
    node = tree.nodes.new("ShaderNodeMix")
    node.data_type = "RGBA"
    tree.links.new(tree.nodes.new("ShaderNodeTexNoise").outputs[0], node.inputs[0])
    for socket in node.inputs:
        if socket.type == "RGBA":
            socket.default_value = color
    return next(socket for socket in node.outputs if socket.type == "RGBA")


def joined(tree, kind, first, second, factor=None):
    node = tree.nodes.new(kind)
    sockets = [socket for socket in node.inputs if socket.type == "SHADER"]
    for shader, socket in zip((first, second), sockets, strict=True):
        tree.links.new(shader.outputs[0], socket)
    if factor is not None:
        node.inputs[0].default_value = factor
    return node


@pytest.mark.parametrize("kind", ["ShaderNodeBsdfGlass", "ShaderNodeBsdfGlossy", "ShaderNodeBsdfTranslucent"])
def test_a_shader_without_a_diffuse_part_has_its_colour(kind, tree, baked):
    assert np.abs(baked(add(tree, kind, RED)).colors - RED).max() < 2e-3


def test_a_mix_mixes(tree, baked):
    mix = joined(tree, "ShaderNodeMixShader", *(add(tree, "ShaderNodeBsdfDiffuse", c) for c in (RED, BLUE)), 0.25)
    expected = 0.75 * np.array(RED) + 0.25 * np.array(BLUE)
    assert np.abs(baked(mix).colors - expected).max() < 2e-3


def test_a_mix_with_transparent_keeps_transparency_and_colour(tree, baked):
    clear, red = add(tree, "ShaderNodeBsdfTransparent"), add(tree, "ShaderNodeBsdfGlossy", RED)
    surfels = baked(joined(tree, "ShaderNodeMixShader", clear, red, 0.75))
    assert np.abs(surfels.colors - (*RED[:3], 0.75)).max() < 3e-3


def test_a_mixed_holdout_is_clear(tree, baked):
    holdout, red = add(tree, "ShaderNodeHoldout"), add(tree, "ShaderNodeBsdfDiffuse", RED)
    assert np.abs(baked(joined(tree, "ShaderNodeMixShader", holdout, red, 0.0)).colors[:, 3]).max() < 1e-3


def test_an_added_emission_is_kept(tree, baked):
    light = add(tree, "ShaderNodeEmission", BLUE, Strength=3.0)
    surfels = baked(joined(tree, "ShaderNodeAddShader", add(tree, "ShaderNodeBsdfDiffuse", RED), light))
    assert np.abs(surfels.colors - RED).max() < 2e-3
    assert np.abs(surfels.emission - 3 * np.array(BLUE[:3])).max() < 1e-2


def test_a_lamp_mixed_with_transparent_keeps_its_brightness(tree, baked):
    """Where it covers a surfel, its whole radiance is emitted."""
    clear, light = add(tree, "ShaderNodeBsdfTransparent"), add(tree, "ShaderNodeEmission", BLUE, Strength=3.0)
    surfels = baked(joined(tree, "ShaderNodeMixShader", clear, light, 0.5))
    assert np.abs(surfels.colors[:, 3] - 0.5).max() < 2e-3
    assert np.abs(surfels.emission - 3 * np.array(BLUE[:3])).max() < 2e-2


def test_alpha_fades_emission_in_a_mix(tree, baked):
    glow = add(tree, "ShaderNodeBsdfPrincipled", Alpha=0.5)
    glow.inputs["Emission Strength"].default_value = 2.0
    tree.links.new(varying(tree, BLUE), glow.inputs["Emission Color"])
    surfels = baked(joined(tree, "ShaderNodeMixShader", glow, add(tree, "ShaderNodeBsdfDiffuse", RED), 0.5))
    assert np.abs(surfels.colors[:, 3] - 0.75).max() < 2e-3
    assert np.abs(0.75 * surfels.emission - 0.5 * 0.5 * 2 * np.array(BLUE[:3])).max() < 1e-2


def test_shaders_that_are_mixed_in_many_ways_are_each_baked_once(tree, baked):
    first, second = (add(tree, "ShaderNodeBsdfDiffuse", color) for color in (RED, BLUE))
    for _ in range(5):
        first, second = (joined(tree, "ShaderNodeMixShader", first, second, factor) for factor in (0.25, 0.5))
    shares = np.linalg.matrix_power([[0.75, 0.25], [0.5, 0.5]], 5)[0]
    assert np.abs(baked(first).colors - shares @ (RED, BLUE)).max() < 2e-3
    nodes = len(tree.nodes)
    emitted(shader_at(tree.get_output_node("ALL").inputs["Surface"]), "color")
    assert len(tree.nodes) == nodes + 9


def test_shaders_in_groups_and_handed_into_them_are_mixed(tree):
    """A group that mixes one of its own with one that it is given; what it is given comes from another group."""
    inner, outer = (bpy.data.node_groups.new(name, "ShaderNodeTree") for name in ("inner", "outer"))
    for group in (inner, outer):
        group.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
    outer.interface.new_socket("Given", in_out="INPUT", socket_type="NodeSocketShader")
    ends = [group.nodes.new("NodeGroupOutput") for group in (inner, outer)]
    own = [group.nodes.new("ShaderNodeBsdfDiffuse") for group in (inner, outer)]
    for shader, color in zip(own, (RED, BLUE), strict=True):
        rgb = shader.id_data.nodes.new("ShaderNodeRGB")
        rgb.outputs[0].default_value = color
        shader.id_data.links.new(rgb.outputs[0], shader.inputs["Color"])
    inner.links.new(own[0].outputs[0], ends[0].inputs[0])
    mix = joined(outer, "ShaderNodeMixShader", outer.nodes.new("NodeGroupInput"), own[1], 0.25)
    outer.links.new(mix.outputs[0], ends[1].inputs[0])
    nodes = [tree.nodes.new("ShaderNodeGroup") for _ in range(2)]
    for node, group in zip(nodes, (inner, outer), strict=True):
        node.node_tree = group
    tree.links.new(nodes[0].outputs[0], nodes[1].inputs[0])
    surface = tree.get_output_node("ALL").inputs["Surface"]
    tree.links.new(nodes[1].outputs[0], surface)
    made = emitted(shader_at(surface), "color")
    end = made.node.id_data.nodes.new("ShaderNodeEmission")
    made.node.id_data.links.new(made, end.inputs["Color"])
    read = Shader(end, surface, shader_at(surface).groups)
    assert np.allclose(constant_of(read, "Color"), 0.75 * np.array(RED[:3]) + 0.25 * np.array(BLUE[:3]))


def test_a_muted_mix_hands_on_its_first_shader(tree, baked):
    mix = joined(tree, "ShaderNodeMixShader", *(add(tree, "ShaderNodeBsdfDiffuse", c) for c in (RED, BLUE)), 1.0)
    mix.mute = True
    assert np.abs(baked(mix).colors - RED).max() < 2e-3
