# SPDX-License-Identifier: GPL-3.0-or-later
"""A conversion says where Geometry Nodes take the source: copies that they place are still the mesh."""

import bpy
import pytest


@pytest.fixture
def source():
    bpy.ops.mesh.primitive_cube_add()
    bpy.context.object.name = "Tuft"
    return bpy.context.object


def scatter(taken, place):
    """An object whose nodes take another: by a node, by a node in a group, or by an input of the modifier."""
    tree = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    inner = bpy.data.node_groups.new("Inner", "GeometryNodeTree") if place == "group" else tree
    info = inner.nodes.new("GeometryNodeObjectInfo")
    ground = bpy.data.objects.new("Ground", bpy.data.meshes.new("Ground"))
    bpy.context.collection.objects.link(ground)
    if place == "modifier":
        socket = tree.interface.new_socket("Taken", in_out="INPUT", socket_type="NodeSocketObject")
        tree.links.new(tree.nodes.new("NodeGroupInput").outputs["Taken"], info.inputs["Object"])
    elif place:
        info.inputs["Object"].default_value = taken
    if place == "group":
        tree.nodes.new("GeometryNodeGroup").node_tree = inner
    modifier = ground.modifiers.new("Scatter", "NODES")
    modifier.node_group = tree
    if place == "modifier" and hasattr(modifier, "properties"):
        getattr(modifier.properties.inputs, socket.identifier).value = taken
    elif place == "modifier":
        modifier[socket.identifier] = taken


@pytest.mark.parametrize("place", ["node", "group", "modifier", ""])
def test_a_conversion_names_objects_whose_nodes_take_the_source(place, source, convert, capfd):
    scatter(source, place)
    convert(resolution=8)
    told = "The Geometry Nodes of 'Ground' still take the mesh of 'Tuft'; choose 'Tuft surfels' there"
    assert (told in capfd.readouterr().out) == bool(place)


def test_surfels_that_bend_with_the_source_are_none_of_them(source, convert, capfd):
    """Their own nodes take the source, too."""
    source.shape_key_add(name="Basis")
    convert(resolution=8)
    source.select_set(True)
    bpy.context.view_layer.objects.active = source
    convert(resolution=8)
    assert sum(any(m.type == "NODES" for m in each.modifiers) for each in bpy.data.objects) >= 1
    assert "still take the mesh" not in capfd.readouterr().out
