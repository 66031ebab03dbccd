# SPDX-License-Identifier: GPL-3.0-or-later
"""Render Meshes as Surfels: meshes look as if they had been converted."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.export.live_meshes import LiveMeshes
from splat_addon.blender.export.scene import export_scene
from splat_addon.blender.export.surfel_store import SurfelStore
from tests.blender.engine.mesh_scenes import counts


def add_text():
    bpy.ops.object.text_add(location=(-1, 0, 0))
    bpy.context.object.data.extrude = 0.1


def add_curve():
    bpy.ops.curve.primitive_bezier_circle_add(rotation=(0.4, 0.3, 0))
    bpy.context.object.data.bevel_depth = 0.3


def add_metaballs():
    for x in (0, 1.2):
        bpy.ops.object.metaball_add(location=(x, 0, 0))
        # the conversion samples what the viewport shows
        bpy.context.object.data.render_resolution = bpy.context.object.data.resolution
    bpy.data.objects["Mball"].select_set(True)
    bpy.data.objects["Mball.001"].select_set(False)
    bpy.context.view_layer.objects.active = bpy.data.objects["Mball"]


def add_coloured_mirrored_mesh():
    bpy.ops.mesh.primitive_monkey_add(rotation=(0.3, 0.2, 0.1))
    monkey = bpy.context.object
    monkey.scale = (-1, 1, 1.5)
    attribute = monkey.data.color_attributes.new("paint", "FLOAT_COLOR", "POINT")
    colors = np.random.default_rng(1).uniform(size=(len(monkey.data.vertices), 4))
    attribute.data.foreach_set("color", colors.astype(np.float32).ravel())


KINDS = {f.__name__: f for f in (add_text, add_curve, add_metaballs, add_coloured_mirrored_mesh)}


@pytest.mark.parametrize("add", KINDS.values(), ids=KINDS)
def test_it_looks_as_if_it_had_been_converted(add, live, picture, assert_same_picture):
    add()
    unconverted = picture()
    assert unconverted[..., 3].any() and counts()["meshes"] == 1
    live.render_meshes = "HIDDEN"
    bpy.ops.object.surfels_from_mesh(resolution=32, source="HIDE")
    assert_same_picture(unconverted, picture())


def test_polygons_are_the_default(scene, add_camera, picture):
    assert scene.surfel_splatting.render_meshes == "POLYGONS"
    add_camera()
    add_curve()
    assert picture().any() and counts()["polygon_meshes"] == 1 and "surfels" not in counts()


def test_what_has_been_converted_is_not_drawn_twice(live, picture):
    add_coloured_mirrored_mesh()
    bpy.ops.object.surfels_from_mesh(resolution=24, source="KEEP")
    both = picture()
    assert counts() == {}
    live.render_meshes = "HIDDEN"
    assert np.array_equal(both, picture())


def test_neither_is_an_instance_of_its_collection(live, scene, picture):
    """A source is not drawn in an instance of its collection either, if its surfels are in that collection too."""
    hidden = bpy.data.collections.new("hidden")
    add_coloured_mirrored_mesh()
    bpy.ops.object.surfels_from_mesh(resolution=24)
    for shown in list(scene.collection.objects)[-2:]:
        hidden.objects.link(shown)
        scene.collection.objects.unlink(shown)
    instancer = bpy.data.objects.new("instancer", None)
    instancer.instance_type, instancer.instance_collection = "COLLECTION", hidden
    scene.collection.objects.link(instancer)
    assert picture().any() and counts() == {}


def test_an_object_can_be_left_out(live, picture):
    add_coloured_mirrored_mesh()
    bpy.context.object.surfel_splatting.render_as = "HIDDEN"
    assert not picture().any()


def test_instances_share_one_sampling(live, scene, packed_surfels, picture, add_mesh, add_nodes):
    """Boxes on two points and a linked duplicate of one of them make two meshes in three places."""
    points = add_mesh("points", [(-2, 0, 0), (2, 0, 0)], [])

    def build(tree, start, end):
        cube, place = tree.nodes.new("GeometryNodeMeshCube"), tree.nodes.new("GeometryNodeInstanceOnPoints")
        tree.links.new(cube.outputs["Mesh"], place.inputs["Instance"])
        tree.links.new(start, place.inputs["Points"])
        tree.links.new(place.outputs["Instances"], end)

    add_nodes(points, build)
    alpha = picture()[..., 3]
    assert alpha[:, :16].any() and alpha[:, 16:].any()
    assert counts()["meshes"] == 1 and len(packed_surfels) == 1


def test_a_collection_instance_shows_where_it_stands(live, scene, picture):
    add_curve()
    hidden = bpy.data.collections.new("hidden")
    hidden.objects.link(bpy.context.object)
    scene.collection.objects.unlink(bpy.context.object)
    assert not picture().any()
    instancer = bpy.data.objects.new("instancer", None)
    instancer.instance_type, instancer.instance_collection = "COLLECTION", hidden
    scene.collection.objects.link(instancer)
    instancer.location.x = 1.5
    alpha = picture()[..., 3]
    assert alpha[:, 20:].sum() > 2 * alpha[:, :16].sum()


def test_normals_change_over_surfels_while_phong_splatting_is_chosen(live):
    bpy.ops.mesh.primitive_uv_sphere_add()
    bpy.ops.object.shade_smooth()
    kept = LiveMeshes()
    for is_chosen in (False, True, False):
        live.mesh_normal_fields = is_chosen
        kept.begin_frame()
        found, _ = export_scene(bpy.context.evaluated_depsgraph_get(), SurfelStore(), kept)
        (instance,) = found.surfels
        assert instance.surfels.normals_change is is_chosen


@pytest.mark.parametrize("form", ["POLYGONS", "SURFELS"])
def test_faces_without_a_place_and_strays_among_surfels_are_counted_in_notes(form, add_mesh):
    axis = np.linspace(0, 1, 9)
    corners = [(x, y, 0) for y in axis for x in axis]
    faces = [(k, k + 1, k + 10, k + 9) for row in range(8) for k in range(9 * row, 9 * row + 8)]
    add_mesh("Sheet", [*corners, (np.nan, 0, 0), (1e7, 0, 0)], [*faces, (0, 1, 81), (1, 2, 82)])
    bpy.context.scene.surfel_splatting.render_meshes = form
    scene, notes = export_scene(bpy.context.evaluated_depsgraph_get(), SurfelStore(), LiveMeshes())
    said = notes.sentences()
    assert "Sheet: 1 triangles with a non-finite vertex are left out" in said
    if form == "SURFELS":
        assert any(note.startswith("Sheet: left out of its surfels are 1 triangle that reaches") for note in said)
        assert len(scene.surfels[0].surfels) > 1000
