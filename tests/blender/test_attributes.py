# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels are stored exactly, as named and typed attributes of vertices; broken attributes are reported in a
sentence.
"""

from dataclasses import replace

import bpy
import numpy as np
import pytest

from splat_addon.blender.geometry.attributes import has_surfels, write_surfels
from splat_addon.blender.geometry.stored_surfels import read_surfels
from splat_addon.surfels import LAYOUT, OPTIONAL_LAYOUT, empty_surfels

NAMES_AND_TYPES = {
    "position": "FLOAT_VECTOR",
    "rotation": "QUATERNION",
    "scale": "FLOAT_VECTOR",
    "normal": "FLOAT_VECTOR",
    "Col": "FLOAT_COLOR",
    "radius": "FLOAT",
    "material": "INT",
}


def assert_same_bits(read, written):
    for name in LAYOUT:
        assert getattr(read, name).tobytes() == getattr(written, name).tobytes(), name


def test_the_attributes_have_the_names_and_types_that_the_design_promises(random_surfels):
    attributes = write_surfels("surfels", random_surfels(3)).attributes
    assert {n: (attributes[n].data_type, attributes[n].domain) for n in NAMES_AND_TYPES} == {
        n: (kind, "POINT") for n, kind in NAMES_AND_TYPES.items()
    }


def test_what_is_written_is_read_bit_for_bit(random_surfels):
    surfels = random_surfels(1000)
    read, skipped = read_surfels(write_surfels("surfels", surfels))
    assert skipped == 0
    assert_same_bits(read, surfels)


def test_optional_fields_have_attributes_only_where_they_are_there(random_surfels):
    surfels = random_surfels(100)
    plain = write_surfels("plain", surfels)
    assert not set(OPTIONAL_LAYOUT) & set(plain.attributes.keys())
    assert all(getattr(read_surfels(plain)[0], name) is None for name in OPTIONAL_LAYOUT)
    values = {
        name: np.random.default_rng(5).uniform(
            0, 1 if dtype == np.float32 else 30_000, (100, columns) if columns > 1 else 100
        )
        for name, (columns, dtype, _) in OPTIONAL_LAYOUT.items()
    }
    rich = replace(surfels, **values)
    read, _ = read_surfels(write_surfels("rich", rich))
    for name in (*LAYOUT, *OPTIONAL_LAYOUT):
        assert getattr(read, name).tobytes() == getattr(rich, name).tobytes(), name


def test_surfels_survive_saving_and_loading_bit_for_bit(random_surfels, add_object, tmp_path):
    surfels = random_surfels(1000)
    add_object(write_surfels("kept", surfels))
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "surfels.blend"))
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "surfels.blend"))
    assert_same_bits(read_surfels(bpy.data.meshes["kept"])[0], surfels)


def test_surfels_survive_a_visit_to_edit_mode_bit_for_bit(random_surfels, add_object):
    surfels = random_surfels(100)
    mesh = add_object(write_surfels("visited", surfels)).data
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.object.mode_set(mode="OBJECT")
    assert_same_bits(read_surfels(mesh)[0], surfels)


def test_the_radius_is_the_larger_half_axis(random_surfels):
    surfels = random_surfels(10)
    radius = np.empty(10, np.float32)
    write_surfels("surfels", surfels).attributes["radius"].data.foreach_get("value", radius)
    assert np.array_equal(radius, surfels.scales.max(axis=1))


def test_geometry_nodes_read_and_move_surfels(random_surfels, add_object):
    surfels = random_surfels(50)
    made = add_object(write_surfels("moved", surfels))
    made.modifiers.new("up by the radius", "NODES").node_group = raise_by_attribute("radius")
    evaluated = made.evaluated_get(bpy.context.evaluated_depsgraph_get())
    moved, _ = read_surfels(evaluated.data)
    assert np.allclose(moved.positions - surfels.positions, surfels.radius[:, None] * [0, 0, 1], atol=1e-6)
    assert np.array_equal(moved.rotations, surfels.rotations)


def raise_by_attribute(name: str) -> bpy.types.NodeTree:
    """A Geometry Nodes modifier that adds a named float attribute to z."""
    tree = bpy.data.node_groups.new("raise", "GeometryNodeTree")
    for direction in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    start, attribute, vector, move, end = (
        tree.nodes.new(kind)
        for kind in (
            "NodeGroupInput",
            "GeometryNodeInputNamedAttribute",
            "ShaderNodeCombineXYZ",
            "GeometryNodeSetPosition",
            "NodeGroupOutput",
        )
    )
    attribute.data_type = "FLOAT"
    attribute.inputs["Name"].default_value = name
    tree.links.new(attribute.outputs["Attribute"], vector.inputs["Z"])
    tree.links.new(vector.outputs["Vector"], move.inputs["Offset"])
    tree.links.new(start.outputs[0], move.inputs["Geometry"])
    tree.links.new(move.outputs["Geometry"], end.inputs[0])
    return tree


def test_no_surfels_are_written_and_read_as_none():
    surfels, skipped = read_surfels(write_surfels("none", empty_surfels()))
    assert (len(surfels), skipped) == (0, 0)


def test_a_point_with_an_unusable_value_is_left_out_and_counted(random_surfels):
    mesh = write_surfels("damaged", random_surfels(10))
    mesh.attributes["scale"].data[3].vector = (float("nan"), 1.0, 0.0)
    mesh.attributes["scale"].data[4].vector = (-1.0, 1.0, 0.0)
    surfels, skipped = read_surfels(mesh)
    assert (len(surfels), skipped) == (8, 2)


@pytest.mark.parametrize("name", [n for n in NAMES_AND_TYPES if n not in ("position", "radius")])
def test_a_missing_attribute_is_named_with_its_type(random_surfels, name):
    mesh = write_surfels("torn", random_surfels(2))
    mesh.attributes.remove(mesh.attributes[name])
    with pytest.raises(ValueError, match=rf"'torn' has no attribute '{name}'.*add it \({NAMES_AND_TYPES[name]}"):
        read_surfels(mesh)


@pytest.mark.parametrize(("kind", "domain"), [("FLOAT", "POINT"), ("FLOAT_VECTOR", "CORNER")])
def test_an_attribute_of_another_type_or_domain_is_named_with_the_right_one(random_surfels, kind, domain):
    mesh = write_surfels("wrong", random_surfels(2))
    mesh.attributes.remove(mesh.attributes["scale"])
    mesh.attributes.new("scale", kind, domain)
    with pytest.raises(
        ValueError, match=f"'scale' .* 'wrong' is {kind} on {domain}; convert it to FLOAT_VECTOR on POINT"
    ):
        read_surfels(mesh)


def test_surfels_in_edit_mode_are_refused_with_a_sentence(random_surfels, add_object):
    mesh = add_object(write_surfels("edited", random_surfels(2))).data
    bpy.ops.object.mode_set(mode="EDIT")
    with pytest.raises(ValueError, match="'edited' is in edit mode"):
        read_surfels(mesh)


def test_a_mesh_with_faces_is_not_surfels(add_square):
    mesh = add_square().data
    mesh.attributes.new("rotation", "QUATERNION", "POINT")
    assert not has_surfels(mesh)


def test_points_without_our_attributes_are_not_surfels(add_mesh):
    assert not has_surfels(add_mesh("points", [(0, 0, 0)], []).data)


@pytest.mark.parametrize("lost", [None, "rotation", "scale"])
def test_surfels_are_known_even_when_one_attribute_is_lost(random_surfels, lost):
    mesh = write_surfels("surfels", random_surfels(2))
    if lost:
        mesh.attributes.remove(mesh.attributes[lost])
    assert has_surfels(mesh)
