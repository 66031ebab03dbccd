# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfel objects survive Blender's own edits, which move centres but not frames.

Each picture is the same as if the whole object had been moved.
"""

import bpy
import numpy as np
import pytest
from mathutils import Euler, Matrix

PLACE = Matrix.LocRotScale((0.4, -0.3, 0.2), Euler((0.5, 0.9, 0.3)), (1.2, 0.7, 1.5))


@pytest.fixture
def discs(add_camera, add_surfels):
    """discs(name) -> an object of slanted, coloured discs near the origin."""
    add_camera(location=(0, 0, 9))

    def add(name="discs", seed=3):
        random = np.random.default_rng(seed)
        colors = np.append(random.uniform(size=(20, 3)), np.ones((20, 1)), axis=1)
        sizes = random.uniform(0.2, 0.6, (20, 2))
        return add_surfels(random.uniform(-1, 1, (20, 3)), random.normal(size=(20, 3)), sizes, colors, name)

    return add


@pytest.fixture
def assert_drawn_as(picture, assert_same_picture):
    """assert_drawn_as(expected): the scene gives that picture, except where rounding moves the edge of a disc."""
    return lambda expected: assert_same_picture(picture(), expected, ties=4)


def twin(source, matrix):
    made = bpy.data.objects.new("twin", source.data)
    bpy.context.collection.objects.link(made)
    made.matrix_world = matrix
    return made


def test_apply(discs, picture, assert_drawn_as):
    made = discs()
    made.matrix_world = PLACE
    expected = picture()
    bpy.ops.object.transform_apply()
    assert made.matrix_world.is_identity
    assert_drawn_as(expected)


def test_apply_twice(discs, picture, assert_drawn_as):
    made = discs()
    for _ in range(2):
        made.matrix_world = PLACE
        expected = picture()
        bpy.ops.object.transform_apply()
    assert_drawn_as(expected)


def test_moving_the_points_of_a_part(discs, picture, assert_drawn_as):
    """Half of the points are turned, as in edit mode."""
    made = discs()
    other = twin(made, PLACE)
    other.data = other.data.copy()
    for owner, rows in ((made, range(0, 20, 2)), (other, range(1, 20, 2))):
        keep_only(owner.data, rows)
    expected = picture()
    for owner in (made, other):
        bpy.data.objects.remove(owner)
    edited = discs()
    positions = np.empty((20, 3), np.float32)
    edited.data.attributes["position"].data.foreach_get("vector", positions.ravel())
    matrix = np.array(PLACE)
    positions[1::2] = positions[1::2] @ matrix[:3, :3].T + matrix[:3, 3]
    edited.data.attributes["position"].data.foreach_set("vector", positions.ravel())
    assert_drawn_as(expected)


def keep_only(mesh, rows):
    import bmesh

    points = bmesh.new()
    points.from_mesh(mesh)
    points.verts.ensure_lookup_table()
    bmesh.ops.delete(points, geom=[v for v in points.verts if v.index not in rows], context="VERTS")
    points.to_mesh(mesh)
    points.free()


def test_mirror(discs, picture, assert_drawn_as):
    made = discs()
    other = twin(made, Matrix.Diagonal((-1, 1, 1, 1)))
    expected = picture()
    bpy.data.objects.remove(other)
    made.modifiers.new("mirror", "MIRROR").use_mirror_merge = False
    assert_drawn_as(expected)


def test_array(discs, picture, assert_drawn_as):
    made = discs()
    others = [twin(made, Matrix.Translation((k, 0, 0))) for k in (1, 2)]
    expected = picture()
    for other in others:
        bpy.data.objects.remove(other)
    array = made.modifiers.new("array", "ARRAY")
    array.count, array.use_relative_offset, array.use_constant_offset = 3, False, True
    array.constant_offset_displace = (1, 0, 0)
    assert_drawn_as(expected)


def test_transform_geometry(discs, add_nodes, picture, assert_drawn_as):
    made = discs()
    made.matrix_world = Matrix.LocRotScale((0.5, 0, 0), Euler((0, 0, 1)), (1, 2, 1))
    expected = picture()
    made.matrix_world = Matrix()

    def turn(tree, start, end):
        node = tree.nodes.new("GeometryNodeTransform")
        node.inputs["Translation"].default_value = (0.5, 0, 0)
        node.inputs["Rotation"].default_value = (0, 0, 1)
        node.inputs["Scale"].default_value = (1, 2, 1)
        tree.links.new(start, node.inputs[0])
        tree.links.new(node.outputs[0], end)

    add_nodes(made, turn)
    assert_drawn_as(expected)


def test_join(discs, picture, assert_drawn_as):
    one, other = discs("one"), discs("other", seed=4)
    one.matrix_world, other.matrix_world = PLACE, Matrix.Rotation(1.0, 4, (1, 2, 3))
    expected = picture()
    one.select_set(True)
    bpy.ops.object.join()
    assert len([o for o in bpy.data.objects if o.type == "MESH"]) == 1
    assert_drawn_as(expected)


@pytest.mark.parametrize("active", ["surfels", "mesh"])
def test_join_with_a_mesh(discs, add_square, picture, assert_drawn_as, said, active):
    made, square = discs(), add_square()
    made.matrix_world, square.matrix_world = PLACE, Matrix.Translation((-2, -1, 0))
    expected = picture()
    made.select_set(True)
    square.select_set(True)
    bpy.context.view_layer.objects.active = made if active == "surfels" else square
    bpy.ops.object.join()
    said()
    assert_drawn_as(expected)
    assert "unusable" not in said()


def test_what_was_moved_one_by_one_is_named(discs, picture, said):
    made = discs()
    positions = np.random.default_rng(9).normal(size=(20, 3)).astype(np.float32)
    made.data.attributes["position"].data.foreach_set("vector", positions.ravel())
    picture()
    assert "discs: 20 surfels were moved one by one" in said()


def test_frames_are_moved_once_for_an_animation(discs, scene, tmp_path, monkeypatch):
    from splat_addon.blender.geometry import stored_surfels

    calls, followed = [], stored_surfels.followed
    monkeypatch.setattr(stored_surfels, "followed", lambda *given: calls.append(given) or followed(*given))
    discs().matrix_world = PLACE
    bpy.ops.object.transform_apply()
    scene.frame_end, scene.render.filepath = 3, str(tmp_path / "frame_")
    bpy.ops.render.render(animation=True)
    assert len(calls) == 1
