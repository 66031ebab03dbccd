# SPDX-License-Identifier: GPL-3.0-or-later
"""Render Meshes as Surfels: meshes look as if they had been converted, and keep their surfels while they deform."""

from pathlib import Path

import bpy
import numpy as np
import pytest

from splat_addon.blender.conversion.automatic_density import LEAST_RESOLUTION
from splat_addon.blender.engine import final_render
from splat_addon.blender.export.live_meshes import LiveMeshes
from splat_addon.blender.export.scene import SurfelStore, export_scene
from splat_addon.rendering.upload import storages


@pytest.fixture
def live(scene, add_camera):
    """The scene with Render Meshes as Surfels at resolution 32, seen from above."""
    add_camera(location=(0, 0, 10))
    scene.surfel_splatting.render_meshes = "SURFELS"
    scene.surfel_splatting.mesh_resolution = 32
    scene.surfel_splatting.detail_tolerance = 0  # merged surfels would count
    return scene.surfel_splatting


@pytest.fixture
def sampled(monkeypatch):
    """The list of surfels packed for the device, in order."""
    packed, pack = [], storages.pack_surfels
    monkeypatch.setattr(storages, "pack_surfels", lambda surfels, order: packed.append(surfels) or pack(surfels, order))
    return packed


@pytest.fixture
def render_frames(scene):
    """render_frames(last) renders frames 1 to `last`; returns the counts of the last one."""

    def render(last: int = 3) -> dict:
        scene.frame_start, scene.frame_end = 1, last
        scene.render.filepath = str(Path(scene.render.filepath).parent / "frame_####.exr")
        bpy.ops.render.render(animation=True)
        return final_render.last_frame_stats["live_meshes"]

    return render


def world(surfels):
    return surfels.origin + surfels.positions.astype(np.float64)


def counts():
    return final_render.last_frame_stats["live_meshes"]


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


def test_instances_share_one_sampling(live, scene, sampled, picture, add_mesh, add_nodes):
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
    assert counts()["meshes"] == 1 and len(sampled) == 1


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


def add_bar():
    """A smooth bar along x, 4 units long, of many quads."""
    bpy.ops.mesh.primitive_cylinder_add(vertices=24, radius=0.4, depth=4, rotation=(0, np.pi / 2, 0))
    bpy.ops.object.transform_apply()
    bar = bpy.context.object
    bar.modifiers.new("fine", "SUBSURF").levels = 2
    bpy.ops.object.modifier_apply(modifier="fine")
    return bar


def by_armature(bar):
    bpy.ops.object.armature_add(enter_editmode=True, rotation=(0, 0, 0))
    armature = bpy.context.object
    bones = armature.data.edit_bones
    bones[0].head, bones[0].tail = (-2, 0, 0), (0, 0, 0)
    second = bones.new("second")
    second.head, second.tail, second.parent = (0, 0, 0), (2, 0, 0), bones[0]
    bpy.ops.object.mode_set(mode="OBJECT")
    bar.select_set(True)
    bpy.ops.object.parent_set(type="ARMATURE_AUTO")
    bone = armature.pose.bones["second"]
    bone.rotation_mode = "XYZ"
    for frame, angle in ((1, 0), (3, 0.8)):
        bone.rotation_euler.x = angle
        bone.keyframe_insert("rotation_euler", frame=frame)


def by_shape_key(bar):
    bar.shape_key_add(name="Basis")
    key = bar.shape_key_add(name="bent")
    for point in key.data:
        point.co.z += 0.3 * point.co.x**2
    for frame, value in ((1, 0), (3, 1)):
        key.value = value
        key.keyframe_insert("value", frame=frame)


def by_lattice(bar):
    bpy.ops.object.add(type="LATTICE")
    lattice = bpy.context.object
    lattice.scale = (5, 2, 2)
    lattice.shape_key_add(name="Basis")
    key = lattice.shape_key_add(name="up")
    for point in key.data:
        point.co.z += point.co.x
    for frame, value in ((1, 0), (3, 1)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    modifier = bar.modifiers.new("lattice", "LATTICE")
    modifier.object = lattice


DEFORMERS = {f.__name__: f for f in (by_armature, by_shape_key, by_lattice)}


@pytest.mark.parametrize("deform", DEFORMERS.values(), ids=DEFORMERS)
def test_a_deforming_mesh_keeps_its_surfels(deform, live, scene, sampled, render_frames):
    """On every frame each surfel lies in its own triangle of the mesh that Blender has deformed."""
    bar = add_bar()
    deform(bar)
    said = render_frames()
    assert said.get("followed") == 1, said
    assert len(sampled) == 3 and len({len(s) for s in sampled}) == 1
    meshes = []
    for frame in (1, 2, 3):
        scene.frame_set(frame)
        meshes.append(triangles_of(bar))
    places = [world(s) for s in sampled]
    assert np.abs(places[2] - places[0]).max() > 0.3
    triangle, weights = nearest_triangle(meshes[0], places[0])
    for mesh, place, surfels in zip(meshes, places, sampled, strict=True):
        own = np.einsum("nk,nkj->nj", weights, mesh[triangle])
        assert np.abs(own - place).max() < 2e-4
        a, b, c = np.moveaxis(mesh[triangle], 1, 0)
        normal = np.cross(b - a, c - a)
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        assert np.quantile(np.einsum("nj,nj->n", normal, surfels.geometric_normals()), 0.02) > 0.999


def triangles_of(object_) -> np.ndarray:
    """The (T, 3, 3) corners of the evaluated mesh's triangles. Faces are split alike on every frame by construction."""
    evaluated = object_.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.to_mesh()
    # An array before the mesh is cleared: a vertex's vector is a view of the mesh's memory.
    corners = np.array(
        [[mesh.vertices[v].co for v in (f.vertices[0], *pair)] for f in mesh.polygons for pair in _fans(f)], np.float64
    )
    evaluated.to_mesh_clear()
    return corners


def _fans(face):
    return zip(list(face.vertices)[1:-1], list(face.vertices)[2:], strict=True)


def nearest_triangle(triangles, points):
    """(N,) index of the triangle that each point lies in, and its (N, 3) barycentric weights."""
    import trimesh

    mesh = trimesh.Trimesh(triangles.reshape(-1, 3), np.arange(len(triangles) * 3).reshape(-1, 3), process=False)
    _, _, index = trimesh.proximity.closest_point(mesh, points)
    return index, trimesh.triangles.points_to_barycentric(triangles[index], points)


def test_what_stands_still_is_uploaded_once(live, sampled, render_frames):
    bar = add_bar()
    bar.location.x = 0
    bar.keyframe_insert("location", frame=1)
    bar.location.x = 1
    bar.keyframe_insert("location", frame=3)
    assert render_frames() == {"meshes": 1, "surfels": len(sampled[0]), "followed": 1}
    assert len(sampled) == 1


def test_a_colour_that_changes_leaves_the_surfels_in_their_places(live, sampled, render_frames):
    bar = add_bar()
    by_shape_key(bar)
    material = bpy.data.materials.new("paint")
    material.use_nodes = True
    color = material.node_tree.nodes["Principled BSDF"].inputs["Base Color"]
    for frame, value in ((1, (1, 0, 0, 1)), (3, (0, 1, 0, 1))):
        color.default_value = value
        color.keyframe_insert("default_value", frame=frame)
    bar.data.materials.append(material)
    assert render_frames()["followed"] == 1
    assert np.allclose(sampled[0].colors, (1, 0, 0, 1)) and np.allclose(sampled[2].colors, (0, 1, 0, 1))
    assert np.allclose((world(sampled[0]) + world(sampled[2])) / 2, world(sampled[1]), atol=1e-5)


def test_too_much_stretch_samples_anew_and_says_so(live, sampled, render_frames):
    bar = add_bar()
    bar.shape_key_add(name="Basis")
    key = bar.shape_key_add(name="long")
    for point in key.data:
        point.co.x *= 4
    for frame, value in ((1, 0), (2, 1)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    assert render_frames(2) == {
        "read": 1,
        "meshes": 1,
        "surfels": len(sampled[1]),
        "sampled": 1,
        "stretched": 1,
    }


def test_another_topology_is_sampled_anew(live, sampled, render_frames):
    bar = add_bar()
    build = bar.modifiers.new("build", "BUILD")
    build.frame_start, build.frame_duration = 0, 6
    assert render_frames(2)["sampled"] == 1
    assert len(sampled) == 2 and len(sampled[0]) != len(sampled[1])


def test_spacing_is_in_world_units(live, sampled, picture):
    bpy.ops.mesh.primitive_cube_add(size=1)
    bpy.context.object.scale = (2, 2, 2)
    live.mesh_density, live.mesh_spacing = "SPACING", 0.25
    picture()
    assert len(sampled[0]) == 6 * 8**2


def test_an_object_can_be_finer_than_the_others(live, sampled, picture):
    bpy.ops.mesh.primitive_cube_add(size=1)
    bpy.ops.mesh.primitive_cube_add(size=1, location=(2, 0, 0))
    bpy.context.object.surfel_splatting.detail = 0.5
    picture()
    assert sorted(map(len, sampled)) == [6 * 16**2, 6 * 32**2]
    bpy.context.object.surfel_splatting.detail = 1
    picture()
    assert len(sampled[-1]) == 6 * 32**2


def test_the_neediest_of_an_objects_linked_copies_decides(live, sampled, picture):
    bpy.ops.mesh.primitive_cube_add(size=1)
    bpy.ops.object.duplicate(linked=True)
    bpy.context.object.location.x = 2
    bpy.context.object.surfel_splatting.detail = 0.5
    picture()
    assert [len(surfels) for surfels in sampled] == [6 * 32**2] and counts()["meshes"] == 1


def test_for_the_camera_a_surfel_covers_as_many_pixels_as_asked(live, scene, sampled, picture):
    """The square is at distance 10 from a camera whose picture is 1 wide at distance 1; another square is behind it."""
    scene.camera.data.sensor_width = scene.camera.data.lens = 36
    bpy.ops.mesh.primitive_plane_add(size=2)
    live.mesh_density, live.mesh_pixels = "CAMERA", 0.5
    picture()
    assert sampled[0].scales[0, 0] / 1.25 == pytest.approx(0.5 * 10 / 32, rel=0.02)
    bpy.context.object.location.z = 20
    picture()
    assert counts()["meshes"] == 1


def test_by_itself_the_density_is_the_cameras(live, scene, sampled, picture):
    scene.camera.data.sensor_width = scene.camera.data.lens = 36
    bpy.ops.mesh.primitive_plane_add(size=2)
    live.mesh_density, live.mesh_pixels = "AUTOMATIC", 0.5
    picture()
    assert sampled[0].scales[0, 0] / 1.25 == pytest.approx(2 / LEAST_RESOLUTION)
    live.mesh_pixels = 0.25
    picture()
    assert sampled[1].scales[0, 0] / 1.25 == pytest.approx(0.25 * 10 / 32, rel=0.02)


def test_by_itself_the_density_is_a_resolution_where_the_camera_sees_nothing(live, sampled, picture):
    bpy.ops.mesh.primitive_plane_add(size=2, location=(0, 0, 20))
    bpy.context.object.surfel_splatting.detail = 0.25
    live.mesh_density = "AUTOMATIC"
    picture()
    assert counts()["meshes"] == 1 and counts()["surfels"] == 64**2


def test_too_many_surfels_are_refused_with_a_sentence(live, picture, said):
    bpy.ops.mesh.primitive_plane_add(size=2)
    live.mesh_resolution = 20_000
    assert not picture().any()
    assert "Plane is left out: It would be 400,000,000 surfels and the limit is 100,000,000" in said()


def test_a_preview_samples_large_meshes_coarsely(live):
    bpy.ops.mesh.primitive_plane_add(size=2)
    live.mesh_resolution = 20_000
    found, _ = export_scene(bpy.context.evaluated_depsgraph_get(), SurfelStore(), LiveMeshes(most=400))
    (instance,) = found.surfels
    assert 300 < len(instance.surfels) < 500


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
