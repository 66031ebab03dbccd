# SPDX-License-Identifier: GPL-3.0-or-later
"""Bake Materials gives each surfel what Blender bakes for nodes that cannot be read, and changes nothing else."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.ids import POINTS_GROUP, POINTS_MATERIAL, SIZELESS_GROUP

KINDS = (
    *("scenes", "objects", "meshes", "materials", "images", "node_groups", "collections", "worlds", "cameras"),
    *("lights", "textures"),
)


class Nodes:
    """A material's nodes."""

    def __init__(self, owner, name="procedural"):
        self.material = bpy.data.materials.new(name)
        if bpy.app.version < (5, 0, 0):
            self.material.use_nodes = True
        self.tree = self.material.node_tree
        self.inputs = self.tree.nodes["Principled BSDF"].inputs
        owner.data.materials.append(self.material)

    def link(self, output, socket):
        """An input of the shader, by name, is fed through a node that cannot be read and changes nothing."""
        if isinstance(socket, str) and output.type not in ("SHADER", "NORMAL") and socket != "Normal":
            wires, mix = (self.tree.nodes.new(kind) for kind in ("ShaderNodeWireframe", "ShaderNodeMixRGB"))
            wires.inputs["Size"].default_value = 0.0
            self.tree.links.new(wires.outputs[0], mix.inputs[0])
            self.tree.links.new(output, mix.inputs[1])
            output = mix.outputs[0]
        self.tree.links.new(output, self.inputs[socket] if isinstance(socket, str) else socket)

    def coordinates(self, output="Object"):
        return self.tree.nodes.new("ShaderNodeTexCoord").outputs[output]

    def component(self, output, axis):
        node = self.tree.nodes.new("ShaderNodeSeparateXYZ")
        self.link(output, node.inputs[0])
        return node.outputs[axis]


@pytest.fixture
def square(add_square):
    return add_square()


def test_a_procedural_colour_is_its_value_at_each_surfel(square, convert, surfels_of, capfd):
    """The colour is the object's coordinates, whose mean over a cell is their value in its middle."""
    nodes = Nodes(square)
    nodes.link(nodes.coordinates(), "Base Color")
    surfels = surfels_of(convert(resolution=32, bake_materials=True)[0])
    assert len(surfels) == 32**2
    place = surfels.positions + np.array(bpy.context.object.location)
    assert np.abs(surfels.colors[:, :2] - place[:, :2]).max() < 2e-3
    assert "plain value" not in capfd.readouterr().out


def test_without_the_choice_the_plain_value_is_used_and_said(square, convert, surfels_of, capfd):
    nodes = Nodes(square)
    location = nodes.tree.nodes.new("ShaderNodeParticleInfo").outputs["Location"]
    nodes.tree.links.new(location, nodes.inputs["Base Color"])
    nodes.inputs["Base Color"].default_value = (0.1, 0.2, 0.3, 1)
    surfels = surfels_of(convert(resolution=8)[0])
    assert np.allclose(surfels.colors, (0.1, 0.2, 0.3, 1))
    assert "base colour comes from a Particle Info node; the plain value" in capfd.readouterr().out


def test_numbers_are_baked_in_the_world_of_a_moved_turned_and_scaled_object(square, convert, surfels_of):
    square.location, square.rotation_euler, square.scale = (0.1, 0.3, 0), (0, 0, 0.5), (0.25, 0.25, -0.5)
    nodes = Nodes(square)
    position = nodes.tree.nodes.new("ShaderNodeNewGeometry").outputs["Position"]
    nodes.link(nodes.component(position, "X"), "Roughness")
    nodes.link(nodes.component(position, "Y"), "Metallic")
    nodes.link(nodes.component(nodes.coordinates(), "X"), "Alpha")
    (made,) = convert(resolution=16, bake_materials=True)
    surfels = surfels_of(made)
    bpy.context.view_layer.update()
    matrix = np.array(made.matrix_world)
    world = surfels.positions @ matrix[:3, :3].T + matrix[:3, 3]
    assert np.abs(surfels.roughness - world[:, 0]).max() < 1e-3
    assert np.abs(surfels.metallic - world[:, 1]).max() < 1e-3
    local = (world - matrix_of(square)[:3, 3]) @ np.linalg.inv(matrix_of(square)[:3, :3]).T
    assert np.abs(surfels.colors[:, 3] - local[:, 0]).max() < 1e-3
    assert surfels.emission is None


def matrix_of(owner):
    return np.array(owner.matrix_world, np.float64)


def test_emission_is_colour_times_strength(square, convert, surfels_of):
    nodes = Nodes(square)
    nodes.link(nodes.coordinates(), "Emission Color")
    nodes.inputs["Emission Strength"].default_value = 5
    surfels = surfels_of(convert(resolution=16, bake_materials=True)[0])
    assert np.abs(surfels.emission[:, 0] - 5 * (surfels.positions[:, 0] + bpy.context.object.location[0])).max() < 0.01


@pytest.mark.parametrize("scale", [(1, 1, 1), (2, 2, 2)])
def test_a_bump_bends_the_shading_normal(square, convert, surfels_of, scale):
    """The height grows by 1 per unit of x, so the normal leans 45 degrees towards -x at any scale of the object."""
    square.scale = scale
    nodes = Nodes(square)
    bump = nodes.tree.nodes.new("ShaderNodeBump")
    position = nodes.tree.nodes.new("ShaderNodeNewGeometry").outputs["Position"]
    nodes.link(nodes.component(position, "X"), bump.inputs["Height"])
    nodes.link(bump.outputs["Normal"], "Normal")
    bump.inputs["Distance"].default_value = bump.inputs["Strength"].default_value = 1.0
    surfels = surfels_of(convert(resolution=16, bake_materials=True)[0])
    assert np.allclose(surfels.normals, np.array((-1, 0, 1)) / np.sqrt(2), atol=0.02)
    assert np.allclose(surfels.geometric_normals(), (0, 0, 1), atol=1e-6)


def test_generated_coordinates_are_those_before_the_modifiers(square, convert, surfels_of):
    """A modifier puts a second square beside the first: the coordinates go from 0 to 1 over the first, and on to 2."""
    array = square.modifiers.new("twice", "ARRAY")
    array.count, array.use_constant_offset, array.constant_offset_displace = 2, False, (0, 0, 0)
    array.use_relative_offset, array.relative_offset_displace = True, (1, 0, 0)
    nodes = Nodes(square)
    nodes.link(nodes.component(nodes.coordinates("Generated"), "X"), "Emission Color")
    nodes.inputs["Emission Strength"].default_value = 1
    surfels = surfels_of(convert(resolution=32, bake_materials=True)[0])
    x = surfels.positions[:, 0] + bpy.context.object.location[0]
    assert x.max() > 1.9 and np.abs(surfels.emission[:, 0] - x).max() < 2e-3


def test_a_procedural_checker_finer_than_the_spacing_is_averaged(square, convert, surfels_of):
    """32 checks lie across 8 cells, so that two of the four places baked in each cell are black."""
    nodes = Nodes(square)
    checker = nodes.tree.nodes.new("ShaderNodeTexChecker")
    checker.inputs["Scale"].default_value = 32
    checker.inputs[1].default_value, checker.inputs[2].default_value = (1, 1, 1, 1), (0, 0, 0, 1)
    nodes.link(nodes.coordinates("UV"), checker.inputs["Vector"])
    nodes.link(checker.outputs["Color"], "Roughness")
    assert (surfels_of(convert(resolution=8, bake_materials=True)[0]).roughness == 0.5).all()


def test_only_the_material_that_needs_it_is_baked(add_mesh, convert, surfels_of):
    pair = add_mesh("pair", [(x, y, 0) for y in (0, 1) for x in (0, 1, 2)], [(0, 1, 4, 3), (1, 2, 5, 4)])
    left, right = Nodes(pair, "plain"), Nodes(pair, "procedural")
    pair.data.polygons[1].material_index = 1
    left.inputs["Roughness"].default_value, left.inputs["Base Color"].default_value = 0.8, (1, 0, 0, 1)
    right.inputs["Base Color"].default_value = (0, 1, 0, 1)
    right.link(right.component(right.coordinates(), "Y"), "Roughness")
    surfels = surfels_of(convert(resolution=32, bake_materials=True)[0])
    baked = surfels.materials == 1
    y = surfels.positions[:, 1] + bpy.context.object.location[1]
    assert np.allclose(surfels.roughness[~baked], 0.8) and np.abs(surfels.roughness - y)[baked].max() < 2e-3
    assert np.allclose(surfels.colors[:, :3], np.where(baked[:, None], (0, 1, 0), (1, 0, 0)))


def test_shaders_that_are_not_principled_give_their_diffuse_colour(square, convert, surfels_of):
    nodes = Nodes(square)
    mix, diffuse = (nodes.tree.nodes.new(kind) for kind in ("ShaderNodeMixShader", "ShaderNodeBsdfDiffuse"))
    diffuse.inputs["Color"].default_value = (0.2, 0.6, 0.4, 1)
    mix.inputs[0].default_value = 0.0
    nodes.link(diffuse.outputs[0], mix.inputs[1])
    nodes.link(mix.outputs[0], nodes.tree.get_output_node("ALL").inputs["Surface"])
    surfels = surfels_of(convert(resolution=8, bake_materials=True)[0])
    assert np.allclose(surfels.colors[:, :3], (0.2, 0.6, 0.4), atol=0.01)


def test_instances_are_baked_where_they_stand(square, convert, surfels_of):
    nodes = Nodes(square)
    nodes.link(nodes.component(nodes.tree.nodes.new("ShaderNodeNewGeometry").outputs["Position"], "X"), "Roughness")
    collection = bpy.data.collections.new("pieces")
    collection.objects.link(square)
    bpy.context.collection.objects.unlink(square)
    empty = bpy.data.objects.new("instancer", None)
    empty.instance_type, empty.instance_collection, empty.location = "COLLECTION", collection, (0.25, 0, 0)
    empty.scale = (0.5, 0.5, 0.5)
    bpy.context.collection.objects.link(empty)
    empty.select_set(True)
    bpy.context.view_layer.objects.active = empty
    (made,) = convert(resolution=16, bake_materials=True)
    surfels = surfels_of(made)
    bpy.context.view_layer.update()
    x = (surfels.positions @ matrix_of(made)[:3, :3].T + matrix_of(made)[:3, 3])[:, 0]
    assert len(surfels) == 256 and np.abs(surfels.roughness - x).max() < 2e-3


@pytest.mark.parametrize("asks", ["Color", "Object Index", "an attribute", "a colour attribute"])
def test_what_a_material_asks_about_its_object_is_baked(asks, square, convert, surfels_of):
    square.color, square.pass_index, square["wear"], square["tint"] = (0.9, 0.2, 0.6, 1), 3, 0.25, (0.1, 0.8, 0.7)
    nodes = Nodes(square)
    if asks in ("Color", "Object Index"):
        node = nodes.tree.nodes.new("ShaderNodeObjectInfo")
        output = node.outputs[asks]
    else:
        node = nodes.tree.nodes.new("ShaderNodeAttribute")
        node.attribute_type = "OBJECT"
        node.attribute_name, output = ("wear", "Fac") if asks == "an attribute" else ("tint", "Color")
        output = next(socket for socket in node.outputs if socket.identifier == output)
    nodes.link(output, "Base Color")
    expected = {
        "Color": (0.9, 0.2, 0.6),
        "Object Index": 3,
        "an attribute": 0.25,
        "a colour attribute": (0.1, 0.8, 0.7),
    }
    colors = surfels_of(convert(resolution=4, bake_materials=True)[0]).colors[:, :3]
    assert np.allclose(colors, expected[asks], atol=1e-3)


def test_what_a_bake_cannot_reproduce_is_said(square, convert, capfd):
    nodes = Nodes(square)
    nodes.link(nodes.tree.nodes.new("ShaderNodeObjectInfo").outputs["Random"], "Roughness")
    convert(resolution=4, bake_materials=True)
    assert "'procedural' depends on Object Info's Random, which a bake cannot reproduce" in capfd.readouterr().out


def test_the_file_is_left_as_it_was(square, convert):
    nodes = Nodes(square)
    nodes.link(nodes.coordinates(), "Base Color")
    scene = bpy.context.scene
    before = {kind: sorted(i.name for i in getattr(bpy.data, kind)) for kind in KINDS}
    engine, samples = scene.render.engine, scene.cycles.samples
    links = [(link.from_node.name, link.to_socket.name) for link in nodes.tree.links]
    (made,) = convert(resolution=8, bake_materials=True)
    after = {kind: sorted(i.name for i in getattr(bpy.data, kind)) for kind in KINDS}
    after["objects"].remove(made.name)
    after["meshes"].remove(made.data.name)
    after["materials"].remove(POINTS_MATERIAL)
    for name in (POINTS_GROUP, SIZELESS_GROUP):
        after["node_groups"].remove(name)
    assert after == before
    assert (scene.render.engine, scene.cycles.samples, bpy.context.scene) == (engine, samples, scene)
    assert [(link.from_node.name, link.to_socket.name) for link in nodes.tree.links] == links
    assert [o.name for o in bpy.context.selected_objects] == [made.name]


def test_what_is_readable_is_not_baked(square, convert, surfels_of, monkeypatch):
    monkeypatch.setattr(
        "splat_addon.blender.conversion.mesh_conversion.baked", lambda *_: pytest.fail("nothing is to be baked")
    )
    Nodes(square).inputs["Base Color"].default_value = (0.3, 0.2, 0.1, 1)
    assert np.allclose(surfels_of(convert(resolution=4, bake_materials=True)[0]).colors, (0.3, 0.2, 0.1, 1))


def test_adaptive_is_left_off_and_that_is_said(square, convert, surfels_of, capfd):
    nodes = Nodes(square)
    nodes.link(nodes.coordinates(), "Base Color")
    (made,) = convert(resolution=16, bake_materials=True, use_adaptive=True, tolerance=0.1)
    assert len(surfels_of(made)) == 256
    assert "Adaptive is left off" in capfd.readouterr().out
