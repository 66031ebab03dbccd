# SPDX-License-Identifier: GPL-3.0-or-later
"""Node groups are read, muted nodes are passed through, and one click bakes what cannot be read."""

import bpy
import numpy as np
import pytest


@pytest.fixture
def tree(add_square):
    """The node tree of a square's material."""
    material = bpy.data.materials.new("made")
    if material.node_tree is None:
        material.use_nodes = True
    add_square().data.materials.append(material)
    return material.node_tree


@pytest.fixture
def color(convert, surfels_of, capfd):
    """color() -> the single colour of all surfels of the square; fails if a node was not read."""

    def read():
        (made,) = convert(resolution=4)
        assert "plain value" not in capfd.readouterr().out
        colors = surfels_of(made).colors
        assert np.ptp(colors, axis=0).max() < 1e-6
        return tuple(round(float(c), 5) for c in colors[0, :3])

    return read


def principled(tree):
    return next(node for node in tree.nodes if node.bl_idname == "ShaderNodeBsdfPrincipled")


def add_group(tree):
    """Add a group in a group that halves its input colour, (0.8, 0.4, 0.2)."""
    inner = bpy.data.node_groups.new("half", "ShaderNodeTree")
    outer = bpy.data.node_groups.new("outer", "ShaderNodeTree")
    for each in (inner, outer):
        for way in ("INPUT", "OUTPUT"):
            each.interface.new_socket("Color", in_out=way, socket_type="NodeSocketColor")
    start, end, mix = (inner.nodes.new(k) for k in ("NodeGroupInput", "NodeGroupOutput", "ShaderNodeMix"))
    mix.data_type, mix.blend_type = "RGBA", "MULTIPLY"
    sockets = {socket.identifier: socket for socket in mix.inputs}
    sockets["Factor_Float"].default_value = 1.0
    sockets["B_Color"].default_value = (0.5, 0.5, 0.5, 1)
    inner.links.new(start.outputs[0], sockets["A_Color"])
    inner.links.new(next(s for s in mix.outputs if s.identifier == "Result_Color"), end.inputs[0])
    start, end, user = (outer.nodes.new(k) for k in ("NodeGroupInput", "NodeGroupOutput", "ShaderNodeGroup"))
    user.node_tree = inner
    outer.links.new(start.outputs[0], user.inputs[0])
    outer.links.new(user.outputs[0], end.inputs[0])
    group = tree.nodes.new("ShaderNodeGroup")
    group.node_tree = outer
    group.inputs[0].default_value = (0.8, 0.4, 0.2, 1)
    return group


def test_groups_in_groups_are_read_through(tree, color):
    group = add_group(tree)
    tree.links.new(group.outputs[0], principled(tree).inputs["Base Color"])
    assert color() == (0.4, 0.2, 0.1)


def test_one_group_used_twice_has_two_inputs(tree, color):
    first = add_group(tree)
    second = tree.nodes.new("ShaderNodeGroup")
    second.node_tree = first.node_tree
    tree.links.new(first.outputs[0], second.inputs[0])
    tree.links.new(second.outputs[0], principled(tree).inputs["Base Color"])
    assert color() == (0.2, 0.1, 0.05)


def test_a_muted_node_hands_on_what_comes_in(tree, color):
    rgb, ramp = tree.nodes.new("ShaderNodeRGB"), tree.nodes.new("ShaderNodeHueSaturation")
    rgb.outputs[0].default_value = (0.9, 0.3, 0.1, 1)
    tree.links.new(rgb.outputs[0], ramp.inputs["Color"])
    tree.links.new(ramp.outputs[0], principled(tree).inputs["Base Color"])
    ramp.mute = True
    assert color() == (0.9, 0.3, 0.1)


def test_what_cannot_be_read_is_baked_at_one_click(tree, convert, surfels_of):
    wires = tree.nodes.new("ShaderNodeWireframe")
    wires.inputs["Size"].default_value = 0.2
    tree.links.new(wires.outputs[0], principled(tree).inputs["Base Color"])
    (made,) = convert(resolution=8)
    assert "base colour comes from a Wireframe node" in made.surfel_record.unread
    assert np.ptp(surfels_of(made).colors[:, :3], axis=0).max() < 1e-6
    assert bpy.ops.object.surfels_update(bake=True) == {"FINISHED"}
    assert np.ptp(surfels_of(made).colors[:, :3], axis=0).min() > 0.02
    assert made.surfel_record.unread == ""
