# SPDX-License-Identifier: GPL-3.0-or-later
"""Object > Convert Points to Surfels works on vertex-only meshes, other meshes and point clouds."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.conversion.points_conversion import PointsBatch
from splat_addon.blender.geometry.attributes import has_surfels


def sphere(count=2000):
    points = np.random.default_rng(3).normal(size=(count, 3))
    return points / np.linalg.norm(points, axis=1, keepdims=True)


@pytest.fixture
def scan(add_mesh):
    """The unit sphere as 2,000 loose vertices."""
    return add_mesh("Scan", sphere().tolist(), [])


@pytest.fixture
def convert_points():
    """convert_points(**settings) -> the one new object."""

    def run(**settings):
        before = set(bpy.data.objects)
        bpy.ops.object.surfels_from_points(**settings)
        (made,) = set(bpy.data.objects) - before
        return made

    return run


def set_attribute(data, name, data_type, key, values):
    attribute = data.attributes.new(name, data_type, "POINT")
    attribute.data.foreach_set(key, np.ravel(np.asarray(values, np.float32)))


def test_loose_vertices_become_surfels_with_outward_normals(scan, convert_points, surfels_of):
    surfels = surfels_of(convert_points(isolated="KEEP"))
    assert len(surfels) == 2000
    assert ((surfels.normals * sphere()).sum(axis=1) > 0.9).all()


def test_the_result_lies_over_its_source_under_any_transform(scan, convert_points, world_positions):
    parent = bpy.data.objects.new("parent", None)
    bpy.context.collection.objects.link(parent)
    parent.scale, scan.parent = (1, 2, -3), parent
    scan.location, scan.rotation_euler = (10, 20, 30), (1, 2, 3)
    made = convert_points(isolated="KEEP")
    bpy.context.view_layer.update()
    matrix = np.array(scan.matrix_world)
    assert np.allclose(world_positions(made), sphere() @ matrix[:3, :3].T + matrix[:3, 3], atol=1e-4)


def test_the_result_is_named_placed_and_selected_as_a_converted_mesh_is(scan, convert_points):
    other = bpy.data.collections.new("other")
    bpy.context.scene.collection.children.link(other)
    other.objects.link(scan)
    scan.data.materials.append(bpy.data.materials.new("paint"))
    made = convert_points()
    assert made.name == "Scan surfels" and has_surfels(made.data)
    assert bpy.context.selected_objects == [made] and bpy.context.view_layer.objects.active == made
    assert made.users_collection == scan.users_collection and len(scan.users_collection) == 2
    assert [slot.material.name for slot in made.material_slots] == ["paint"]


def test_attributes_are_used(scan, convert_points, surfels_of):
    set_attribute(scan.data, "normal", "FLOAT_VECTOR", "vector", -sphere())
    set_attribute(scan.data, "radius", "FLOAT", "value", np.full(2000, 0.125))
    set_attribute(scan.data, "Col", "FLOAT_COLOR", "color", np.tile((0.1, 2.0, 0.3, 0.5), (2000, 1)))
    surfels = surfels_of(convert_points(isolated="KEEP"))
    assert np.allclose(surfels.normals, -sphere(), atol=1e-5)
    assert (surfels.scales == 0.125).all()
    assert np.allclose(surfels.colors, (0.1, 2.0, 0.3, 0.5))


def test_a_mesh_with_faces_gives_its_vertices_with_their_normals(convert_points, surfels_of):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=32, ring_count=16)
    surfels = surfels_of(convert_points(isolated="KEEP"))
    assert len(surfels) == 32 * 15 + 2
    assert ((surfels.normals * (surfels.positions)).sum(axis=1) > 0.9).all()


def test_modifiers_shape_the_points(scan, convert_points, surfels_of):
    scan.modifiers.new("array", "ARRAY").relative_offset_displace = (2, 0, 0)
    assert len(surfels_of(convert_points(isolated="KEEP"))) == 4000


def test_a_point_cloud_is_converted(scan, convert_points, surfels_of):
    bpy.ops.object.convert(target="POINTCLOUD")
    assert bpy.context.object.type == "POINTCLOUD"
    set_attribute(bpy.context.object.data, "color", "FLOAT_COLOR", "color", np.tile((1, 0, 0, 1), (2000, 1)))
    surfels = surfels_of(convert_points(isolated="KEEP"))
    assert len(surfels) == 2000 and np.allclose(surfels.colors, (1, 0, 0, 1))


def test_points_of_geometry_nodes_are_converted(scan, add_nodes, convert_points, surfels_of, world_positions):
    """Such points are no longer a mesh; they are in a geometry set that Blender evaluates on request."""

    def to_points(tree, start, end):
        convert = tree.nodes.new("GeometryNodeMeshToPoints")
        convert.inputs["Radius"].default_value = 0.25
        tree.links.new(start, convert.inputs[0])
        tree.links.new(convert.outputs[0], end)

    add_nodes(scan, to_points)
    made = convert_points(isolated="KEEP")
    assert np.allclose(world_positions(made), sphere(), atol=1e-5) and (surfels_of(made).scales == 0.25).all()


@pytest.mark.parametrize(("facing", "inward"), [("OUTWARD", False), ("CURSOR", True), ("CAMERA", True)])
def test_normals_face_where_they_are_told(scan, convert_points, surfels_of, facing, inward):
    scan.location = (7, 0, 0)
    bpy.context.scene.cursor.location = (7, 0, 0)
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    bpy.context.collection.objects.link(camera)
    camera.location, bpy.context.scene.camera = (7, 0, 0), camera
    bpy.context.view_layer.update()
    surfels = surfels_of(convert_points(facing=facing, isolated="KEEP"))
    assert (((surfels.normals * sphere()).sum(axis=1) < 0) == inward).all()


def test_what_was_skipped_and_estimated_is_reported(add_mesh, convert_points, capfd):
    points = sphere()
    points[0], points[1] = points[2], (np.nan, 0, 0)
    add_mesh("Scan", [*points.tolist(), (50, 0, 0)], [])
    convert_points()
    report = capfd.readouterr().out
    assert "Scan: 2,001 points -> " in report
    assert "Warning: Scan: Skipped 1 points that are not finite, 1 points that repeat another" in report
    assert "Info: Scan: Estimated normals of " in report


@pytest.mark.parametrize(("source", "hidden"), [("KEEP", False), ("HIDE", True)])
def test_the_source_is_kept_or_hidden_as_asked(scan, convert_points, source, hidden):
    convert_points(source=source)
    assert (scan.hide_get(), scan.hide_render) == (hidden, hidden)


def test_undo_takes_the_surfels_back(scan):
    bpy.ops.ed.undo_push(message="before")
    bpy.ops.object.surfels_from_points("EXEC_DEFAULT", True)
    assert "Scan surfels" in bpy.data.objects
    bpy.ops.ed.undo()
    assert "Scan surfels" not in bpy.data.objects


@pytest.mark.parametrize(
    ("vertices", "settings", "sentence"),
    [
        ([], {}, "It has no points"),
        ([(0, 0, 0), (1, 0, 0)], {}, "2 usable points are too few"),
        ([(float("nan"), 0, 0)] * 9, {}, "None of the 9 points has finite coordinates"),
        (sphere(9).tolist(), {"neighbours": 1}, "whole number from 3 to 256, not 1"),
        (sphere(9).tolist(), {"splat_size": 0.0}, "splat size must be a finite number above 0, not 0"),
        (sphere(9).tolist(), {"facing": "CAMERA"}, "The scene has no camera"),
    ],
)
def test_what_cannot_be_done_is_an_error_with_the_objects_name(add_mesh, vertices, settings, sentence):
    add_mesh("Scan", vertices, [])
    with pytest.raises(RuntimeError, match=f"Scan: .*{sentence}"):
        bpy.ops.object.surfels_from_points(**settings)
    assert len(bpy.data.objects) == 1


def test_one_source_without_points_does_not_stop_the_others(scan, add_mesh, convert_points, capfd):
    add_mesh("Empty", [], [])
    scan.select_set(True)
    assert convert_points().name == "Scan surfels"
    assert "Warning: Empty: It has no points" in capfd.readouterr().out


def test_surfels_are_not_converted_again(scan, convert_points):
    convert_points()
    with pytest.raises(RuntimeError, match="surfels already; use Update"):
        convert_points()


def test_a_cancelled_batch_adds_nothing_and_leaves_its_sources(scan):
    batch = PointsBatch([scan], {}, lambda: None)
    names_before, shares = (set(bpy.data.objects.keys()), set(bpy.data.meshes.keys())), []

    def cancel(share):
        shares.append(share)
        batch.is_cancelled = share > 0.7

    for conversion in batch.prepared(bpy.context):
        batch.sample(conversion, cancel)
    assert 0.7 < shares[-1] < 0.9 and not batch.has_surfels and not batch.refused
    assert (set(bpy.data.objects.keys()), set(bpy.data.meshes.keys())) == names_before
    assert scan.select_get() and len(scan.data.vertices) == len(conversion.points.positions)


def test_progress_rises_to_the_end(scan):
    shares = []
    batch = PointsBatch([scan], {}, lambda: None)
    for conversion in batch.prepared(bpy.context):
        batch.sample(conversion, shares.append)
    assert shares == sorted(shares) and shares[-1] == 1.0 and shares[0] < 0.6


def test_creases_are_found_where_they_are_asked_for(add_mesh, convert_points, surfels_of):
    random = np.random.default_rng(1)
    face, points = random.integers(0, 6, 6000), random.random((6000, 3))
    points[np.arange(6000), face // 2] = face % 2
    add_mesh("Cube", points.tolist(), [])
    assert not surfels_of(convert_points(source="KEEP")).is_clipped
    bpy.ops.object.select_all(action="DESELECT")
    bpy.data.objects["Cube"].select_set(True)
    cut = surfels_of(convert_points(source="KEEP", finds_creases=True))
    assert 300 < cut.clipped_count < 3000
    bpy.ops.object.select_all(action="DESELECT")
    bpy.data.objects["Cube"].select_set(True)
    assert not surfels_of(convert_points(finds_creases=True, crease_angle=np.radians(100))).is_clipped
