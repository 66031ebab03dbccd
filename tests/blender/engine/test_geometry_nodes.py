# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels edited by Geometry Nodes look like surfels that were created that way."""

import numpy as np
import pytest

POSITIONS = np.random.default_rng(6).uniform(-2.5, 2.5, (20, 3))


@pytest.fixture
def surfels(add_camera, add_surfels):
    add_camera()
    return add_surfels(POSITIONS, size=0.5)


def replaced(surfels, add_surfels, positions, **options):
    """Hide these surfels and add others in their place."""
    surfels.hide_render = True
    return add_surfels(positions, **options)


def test_an_edited_scale_changes_the_splats(surfels, add_nodes, add_surfels, picture, assert_same_picture):
    plain = picture()
    add_nodes(surfels, store_scale)
    edited = picture()
    replaced(surfels, add_surfels, POSITIONS, size=[0.2, 0.3])
    assert_same_picture(edited, picture())
    assert edited[..., 3].sum() < 0.5 * plain[..., 3].sum()


def store_scale(tree, start, end):
    store = tree.nodes.new("GeometryNodeStoreNamedAttribute")
    store.data_type, store.domain = "FLOAT_VECTOR", "POINT"
    store.inputs["Name"].default_value = "scale"
    tree.links.new(start, store.inputs["Geometry"])
    vector = tree.nodes.new("ShaderNodeCombineXYZ")
    vector.inputs["X"].default_value, vector.inputs["Y"].default_value = 0.2, 0.3
    tree.links.new(vector.outputs[0], next(s for s in store.inputs if s.name == "Value" and s.enabled))
    tree.links.new(store.outputs["Geometry"], end)


def test_deleted_points_are_not_drawn(surfels, add_nodes, add_surfels, picture, assert_same_picture):
    add_nodes(surfels, delete_first_half)
    edited = picture()
    replaced(surfels, add_surfels, POSITIONS[10:], size=0.5)
    assert_same_picture(edited, picture())


def delete_first_half(tree, start, end):
    index, compare = tree.nodes.new("GeometryNodeInputIndex"), tree.nodes.new("FunctionNodeCompare")
    delete = tree.nodes.new("GeometryNodeDeleteGeometry")
    compare.data_type, compare.operation = "INT", "LESS_THAN"
    first, second = (socket for socket in compare.inputs if socket.enabled)
    second.default_value = 10
    tree.links.new(index.outputs[0], first)
    tree.links.new(compare.outputs[0], delete.inputs["Selection"])
    tree.links.new(start, delete.inputs["Geometry"])
    tree.links.new(delete.outputs["Geometry"], end)


def test_realised_and_joined_surfels_are_drawn(surfels, add_nodes, add_surfels, picture, assert_same_picture):
    add_nodes(surfels, twice)
    edited = picture()
    replaced(surfels, add_surfels, np.concatenate([POSITIONS, POSITIONS + np.array((0.7, 0, 0))]), size=0.5)
    assert_same_picture(edited, picture())


def twice(tree, start, end):
    move, join = tree.nodes.new("GeometryNodeTransform"), tree.nodes.new("GeometryNodeJoinGeometry")
    move.inputs["Translation"].default_value = (0.7, 0, 0)
    tree.links.new(start, move.inputs["Geometry"])
    tree.links.new(start, join.inputs[0])
    tree.links.new(move.outputs[0], join.inputs[0])
    tree.links.new(join.outputs[0], end)
