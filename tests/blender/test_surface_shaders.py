# SPDX-License-Identifier: GPL-3.0-or-later
"""Shaders other than Principled, also in groups and mixes, keep their colour and shine, or are said to be left out."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.export.notes import Notes
from splat_addon.blender.export.shading import shading_material
from splat_addon.blender.materials.graphs.channels import mix_factor
from splat_addon.blender.materials.material_surfaces import MeshLayers, material_surface
from splat_addon.blender.materials.surface_shaders import parts, surface_shader

RED, BLUE = (0.8, 0.1, 0.1, 1), (0.1, 0.2, 0.9, 1)


class Made:
    """A square's material, which has an output node only, and what the add-on reads from it."""

    def __init__(self, square):
        self.square = square
        self.material = bpy.data.materials.new("made")
        if self.material.node_tree is None:
            self.material.use_nodes = True
        self.tree = self.material.node_tree
        for node in list(self.tree.nodes):
            if node.type != "OUTPUT_MATERIAL":
                self.tree.nodes.remove(node)
        square.data.materials.append(self.material)
        self.notes = Notes()

    def add(self, kind, tree=None, **values):
        node = (tree or self.tree).nodes.new(kind)
        for name, value in values.items():
            node.inputs[name.replace("_", " ")].default_value = value
        return node

    def mix(self, kind, first, second, factor=None, tree=None):
        node = (tree or self.tree).nodes.new(kind)
        sockets = [socket for socket in node.inputs if socket.type == "SHADER"]
        for shader, socket in zip((first, second), sockets, strict=True):
            node.id_data.links.new(shader.outputs[0], socket)
        if factor is not None:
            node.inputs[0].default_value = factor
        return node

    def show(self, shader, output="Surface"):
        self.tree.links.new(shader.outputs[0], self.tree.get_output_node("ALL").inputs[output])
        return self

    def group(self, fill):
        """Add a group with a colour and a roughness as inputs; fill(tree, colour, roughness) returns its shader."""
        inner = bpy.data.node_groups.new("paint", "ShaderNodeTree")
        for name, kind in (("Tint", "Color"), ("Gloss", "Float")):
            inner.interface.new_socket(name, in_out="INPUT", socket_type=f"NodeSocket{kind}")
        inner.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
        start, end = inner.nodes.new("NodeGroupInput"), inner.nodes.new("NodeGroupOutput")
        inner.links.new(fill(inner, start.outputs[0], start.outputs[1]).outputs[0], end.inputs[0])
        node = self.tree.nodes.new("ShaderNodeGroup")
        node.node_tree = inner
        node.inputs["Tint"].default_value, node.inputs["Gloss"].default_value = RED, 0.25
        return node

    @property
    def surface(self):
        return material_surface(self.material, MeshLayers(self.square.data))

    @property
    def color(self):
        surface, unread = self.surface
        assert not unread
        return surface.color.value

    @property
    def shaded(self):
        return shading_material(self.material, self.notes)

    @property
    def said(self):
        self.notes = Notes()
        shading_material(self.material, self.notes)
        return self.notes.sentences()


@pytest.fixture
def made(add_square):
    return Made(add_square())


def painted(tree, color, roughness):
    node = tree.nodes.new("ShaderNodeBsdfPrincipled")
    tree.links.new(color, node.inputs["Base Color"])
    tree.links.new(roughness, node.inputs["Roughness"])
    return node


@pytest.mark.parametrize(
    ("kind", "roughness", "metallic", "said"),
    [
        ("Glossy", 0.3, 1, None),
        ("Metallic", 0.3, 1, "a metal"),
        ("Glass", 0.3, 0, None),
        ("Refraction", 0.3, 0, None),
        ("Translucent", 1, 0, None),
        ("Toon", 1, 0, "a matt"),
    ],
)
def test_a_shader_has_its_colour_and_shine_and_says_what_it_lacks(kind, roughness, metallic, said, made):
    made.show(made.add(f"ShaderNodeBsdf{kind}"))
    inputs = made.tree.get_output_node("ALL").inputs["Surface"].links[0].from_node.inputs
    inputs[0].default_value = RED
    if "Roughness" in inputs:
        inputs["Roughness"].default_value = 0.3
    assert np.allclose(made.color, RED)
    assert np.allclose((made.shaded.roughness, made.shaded.metallic), (roughness, metallic))
    assert [sentence.partition(" draws as ")[2][: len(said or "")] for sentence in made.said] == (
        [said] if said else []
    )


def test_a_shader_in_a_group_takes_the_group_s_values(made):
    made.show(made.group(painted))
    assert np.allclose(made.color, RED)
    assert made.shaded.roughness == 0.25 and made.said == []


def test_a_group_behind_holes_covers_its_share(made):
    group = made.group(painted)
    made.show(made.mix("ShaderNodeMixShader", made.add("ShaderNodeBsdfTransparent"), group, 0.25))
    assert np.allclose(made.color, (*RED[:3], 0.25))
    assert made.shaded.roughness == 0.25


@pytest.mark.parametrize("is_mixed", [False, True])
def test_a_group_is_baked_and_left_as_it_was(is_mixed, made, convert, surfels_of):
    """The group's colour comes from the object's coordinates, times its input."""

    def fill(tree, color, roughness):
        shader = painted(tree, color, roughness)
        multiply = tree.nodes.new("ShaderNodeVectorMath")
        multiply.operation = "MULTIPLY"
        tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["Object"], multiply.inputs[0])
        tree.links.new(color, multiply.inputs[1])
        tree.links.new(multiply.outputs[0], shader.inputs["Base Color"])
        return shader

    group = made.group(fill)
    shader = made.mix("ShaderNodeMixShader", group, made.add("ShaderNodeBsdfDiffuse", Color=BLUE), 0.5)
    made.show(shader if is_mixed else group)
    nodes, sockets = len(group.node_tree.nodes), len(group.node_tree.interface.items_tree)
    (surfels,) = map(surfels_of, convert(resolution=16, bake_materials=True))
    x = surfels.positions[:, 0] + bpy.context.object.location[0]
    expected = 0.8 * x if not is_mixed else 0.4 * x + 0.05
    assert np.abs(surfels.colors[:, 0] - expected).max() < 3e-3
    assert [g.name for g in bpy.data.node_groups if g.name.startswith("paint")] == ["paint"]
    assert (len(group.node_tree.nodes), len(group.node_tree.interface.items_tree)) == (nodes, sockets)


def test_a_mix_of_plain_shaders_is_their_mean(made):
    glossy = made.add("ShaderNodeBsdfGlossy", Color=RED, Roughness=0.2)
    made.show(made.mix("ShaderNodeMixShader", made.add("ShaderNodeBsdfDiffuse", Color=BLUE), glossy, 0.25))
    assert np.allclose(made.color, 0.75 * np.array(BLUE) + 0.25 * np.array(RED))
    assert np.allclose((made.shaded.roughness, made.shaded.metallic), (0.8, 0.25))
    assert made.said == ["The material 'made' mixes shaders, which this engine draws as one with their mean settings"]


def test_alpha_fades_emission_in_a_mix(made):
    """As in Cycles: of a mix's half, half lets light through, so that a quarter of the radiance is left."""
    glow = made.add("ShaderNodeBsdfPrincipled", Alpha=0.5, Emission_Color=BLUE, Emission_Strength=2.0)
    made.show(made.mix("ShaderNodeMixShader", glow, made.add("ShaderNodeBsdfDiffuse"), 0.5))
    assert np.isclose(made.color[3], 0.75)
    assert np.allclose(0.75 * np.array(made.shaded.emission), 0.5 * 0.5 * 2 * np.array(BLUE[:3]))


def test_an_added_lamp_only_adds_its_light(made):
    paint = made.add("ShaderNodeBsdfPrincipled", Base_Color=RED, Roughness=0.2)
    lamp = made.add("ShaderNodeEmission", Color=BLUE, Strength=3.0)
    made.show(made.mix("ShaderNodeAddShader", paint, lamp))
    assert np.allclose(made.color, RED)
    assert np.allclose(made.shaded.emission, 3 * np.array(BLUE[:3])) and np.isclose(made.shaded.roughness, 0.2)


def test_a_mix_by_a_texture_shows_its_shaders_and_not_grey(made):
    mix = made.mix(
        "ShaderNodeMixShader", *(made.add("ShaderNodeBsdfDiffuse", Color=color) for color in (RED, BLUE)), 0.5
    )
    made.tree.links.new(made.tree.nodes.new("ShaderNodeWireframe").outputs[0], mix.inputs[0])
    made.show(mix)
    surface, unread = made.surface
    assert np.allclose(surface.color.value, (np.array(RED) + BLUE) / 2)
    assert {(what.channel, what.reason) for what in unread} == {("color", "a Wireframe node")}


def test_a_ring_of_shaders_ends(made):
    first, second = made.add("ShaderNodeAddShader"), made.add("ShaderNodeAddShader")
    made.tree.links.new(first.outputs[0], second.inputs[0])
    made.tree.links.new(second.outputs[0], first.inputs[0])
    made.tree.links.new(made.add("ShaderNodeBsdfDiffuse", Color=RED).outputs[0], first.inputs[1])
    made.show(second)
    assert np.allclose(made.color, RED)


def test_a_shader_that_is_mixed_in_many_ways_is_one_part_with_all_its_shares(made):
    """There are twice as many ways after each pair of mixes."""
    ends = [made.add("ShaderNodeBsdfDiffuse", Color=color) for color in (RED, BLUE)]
    first, second = ends
    for _ in range(10):
        first, second = (made.mix("ShaderNodeMixShader", first, second, factor) for factor in (0.25, 0.5))
    made.show(first)
    found = list(parts(surface_shader(made.material), mix_factor))
    assert [part.shader.node for part in found] == ends
    assert np.isclose(sum(part.share for part in found), 1) and all(part.is_sure for part in found)
    shares = np.linalg.matrix_power([[0.75, 0.25], [0.5, 0.5]], 10)[0]
    assert np.allclose([part.share for part in found], shares)
    assert np.allclose(made.color, shares @ (RED, BLUE))


@pytest.mark.parametrize("kind", ["ShaderNodeMixShader", "ShaderNodeAddShader"])
def test_a_lamp_that_is_joined_with_itself_shines_for_both(kind, made):
    lamp = made.add("ShaderNodeEmission", Color=BLUE, Strength=3.0)
    made.show(made.mix(kind, lamp, lamp))
    times = 2 if kind == "ShaderNodeAddShader" else 1
    assert np.allclose(made.shaded.emission, times * 3 * np.array(BLUE[:3]))


UNSEEN = {
    "a volume": ("has no surface but a volume, which is not drawn", "ShaderNodeVolumeScatter", "Volume"),
    "a hole": (None, "ShaderNodeBsdfTransparent", "Surface"),
}


@pytest.mark.parametrize("what", UNSEEN)
def test_what_covers_nothing_becomes_no_surfels_and_is_named(what, made, convert, capfd):
    why, kind, output = UNSEEN[what]
    made.show(made.add(kind), output)
    assert made.said == ([f"The material 'made' {why}"] if why else [])
    with pytest.raises(
        RuntimeError, match=r"None of its faces is seen .*'made'.*; give them a material with a surface"
    ):
        convert(resolution=4)


def test_a_holdout_becomes_opaque_surfels_and_says_nothing_unless_it_is_mixed(made, convert, surfels_of):
    holdout = made.show(made.add("ShaderNodeHoldout")).tree.nodes["Holdout"]
    assert made.said == []
    (surfels,) = map(surfels_of, convert(resolution=4))
    assert (surfels.colors == (0, 0, 0, 1)).all()
    made.show(made.mix("ShaderNodeMixShader", holdout, made.add("ShaderNodeBsdfDiffuse"), 0.5))
    assert "The material 'made' mixes a Holdout, through which this engine shows what lies behind" in made.said


def test_faces_that_are_seen_are_converted_without_the_others(made, add_mesh, convert, surfels_of, capfd):
    pair = add_mesh("pair", [(x, y, 0) for y in (0, 1) for x in (0, 1, 2)], [(0, 1, 4, 3), (1, 2, 5, 4)])
    made.show(made.add("ShaderNodeVolumeScatter"), "Volume")
    pair.data.materials.append(bpy.data.materials.new("plain"))
    pair.data.materials.append(made.material)
    pair.data.polygons[1].material_index = 1
    (surfels,) = map(surfels_of, convert(resolution=8))
    assert (surfels.positions[:, 0] + bpy.context.object.location[0]).max() < 1
    said = capfd.readouterr().out
    assert "Some faces are left out: the material 'made' has no surface but a volume, which is not drawn" in said


@pytest.mark.parametrize(
    ("way", "is_one"), [("alpha", True), ("mix", True), ("tested", True), ("plain", False), ("inverted", False)]
)
def test_a_material_cuts_holes_where_its_image_is_transparent(made, way, is_one):
    """An even transparency, and one of other nodes, are blended."""
    image, leaf = made.add("ShaderNodeTexImage"), made.add("ShaderNodeBsdfPrincipled")
    image.image = bpy.data.images.new("leaf", 4, 4, alpha=True)
    made.tree.links.new(image.outputs["Color"], leaf.inputs["Base Color"])
    if way == "mix":
        leaf = made.mix("ShaderNodeMixShader", made.add("ShaderNodeBsdfTransparent"), leaf)
        made.tree.links.new(image.outputs["Alpha"], leaf.inputs[0])
    elif way == "inverted":
        turned = made.add("ShaderNodeInvert")
        made.tree.links.new(image.outputs["Color"], turned.inputs["Color"])
        made.tree.links.new(turned.outputs["Color"], leaf.inputs["Alpha"])
    elif way == "tested":
        test = made.add("ShaderNodeMath")
        test.operation = "GREATER_THAN"
        made.tree.links.new(image.outputs["Alpha"], test.inputs[0])
        made.tree.links.new(test.outputs[0], leaf.inputs["Alpha"])
    elif way == "alpha":
        made.tree.links.new(image.outputs["Alpha"], leaf.inputs["Alpha"])
    else:
        leaf.inputs["Alpha"].default_value = 0.5
    made.show(leaf)
    assert shading_material(made.material, made.notes).cuts_holes is is_one
