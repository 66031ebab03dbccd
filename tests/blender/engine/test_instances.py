# SPDX-License-Identifier: GPL-3.0-or-later
"""Instances of every kind look like the objects that Blender's "Make Instances Real" makes of them."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.export import traits
from splat_addon.blender.export.live_meshes import LiveMeshes
from splat_addon.blender.export.scene import export_scene
from splat_addon.blender.export.surfel_store import SurfelStore


@pytest.fixture
def motif(add_camera, add_surfels):
    """Twelve surfels of many colours around the origin, seen from above."""
    add_camera()
    random = np.random.default_rng(4)
    colors = np.concatenate([random.uniform(size=(12, 3)), np.ones((12, 1))], axis=1)
    # points that a modifier shows would be made real a second time, as objects of their own
    place, normals = random.uniform(-0.5, 0.5, (12, 3)), random.normal(size=(12, 3))
    return add_surfels(place, normals, 0.3, colors, is_shown=False)


@pytest.fixture
def assert_as_made_real(motif, picture, assert_same_picture):
    """assert_as_made_real(instancer, count): the picture stays the same when the instances become `count` real
    objects.
    """

    def check(instancer: bpy.types.Object, count: int) -> None:
        instanced = picture()
        before = set(bpy.data.objects)
        for other in bpy.context.selected_objects:
            other.select_set(False)
        instancer.select_set(True)
        bpy.ops.object.duplicates_make_real()
        made = set(bpy.data.objects) - before
        assert len(made) == count
        for real in made:
            real.hide_render = False
        instancer.hide_render = motif.hide_render = True
        assert_same_picture(instanced, picture(), ties=2)

    return check


def place(made, location, rotation=(0, 0, 0), scale=(1, 1, 1)):
    made.location, made.rotation_euler, made.scale = location, rotation, scale
    return made


def test_collection_instances(scene, motif, assert_as_made_real):
    hidden = bpy.data.collections.new("hidden")
    hidden.objects.link(motif)
    scene.collection.objects.unlink(motif)
    hidden.objects.link(place(motif.copy(), (1, 0.3, 0), (0, 0, 1)))
    instancer = bpy.data.objects.new("instancer", None)
    instancer.instance_type, instancer.instance_collection = "COLLECTION", hidden
    scene.collection.objects.link(place(instancer, (-0.5, 0.2, 1), (0.3, 0.6, 0.2), (-1.3, 1.3, 1.3)))
    assert_as_made_real(instancer, count=2)


def test_geometry_nodes_instances_on_points(scene, motif, add_mesh, add_nodes, assert_as_made_real):
    corners = [(-2, -2, 0), (2, -1, 0.5), (-1, 2, 1), (1.5, 1.5, -1)]
    instancer = add_mesh("points", corners, [])
    add_nodes(instancer, instances_of(motif, scale=(1.2, -0.7, 1)))
    motif.hide_render = True
    assert_as_made_real(instancer, count=4)


def instances_of(source, scale):
    """A Geometry Nodes modifier that puts an object on every point."""

    def build(tree, start, end):
        info, instance = tree.nodes.new("GeometryNodeObjectInfo"), tree.nodes.new("GeometryNodeInstanceOnPoints")
        info.inputs["Object"].default_value = source
        info.inputs["As Instance"].default_value = True
        instance.inputs["Scale"].default_value = scale
        tree.links.new(start, instance.inputs["Points"])
        tree.links.new(info.outputs["Geometry"], instance.inputs["Instance"])
        tree.links.new(instance.outputs["Instances"], end)

    return build


def test_instances_on_vertices(scene, motif, add_mesh, assert_as_made_real):
    instancer = add_mesh("vertices", [(-2, -2, 0), (2, -1, 0), (0, 2, 0)], [])
    instancer.instance_type = "VERTS"
    motif.parent = instancer
    assert_as_made_real(instancer, count=3)


def test_linked_duplicates_are_drawn_in_their_own_places(scene, motif, picture, assert_same_picture):
    together, alone = [], []
    for x in (-2.5, 0, 2.5):
        together.append(place(motif.copy(), (x, 0, 0), (0, 0, x)))
        scene.collection.objects.link(together[-1])
    bpy.data.objects.remove(motif)
    whole = picture()
    for shown in together:
        for made in together:
            made.hide_render = made != shown
        alone.append(picture())
    assert_same_picture(whole, sum(alone))


def test_duplicates_of_one_mesh_keep_their_own_modifiers(scene, motif, add_nodes, picture, assert_same_picture):
    """This is difficult because Blender gives their evaluated meshes the same name."""
    motif.location.x = -2.5
    alone = picture()
    moved = motif.copy()
    scene.collection.objects.link(moved)
    add_nodes(moved, moved_by_five)
    both = picture()
    assert_same_picture(both[:, :16], alone[:, :16])
    motif.hide_render = True
    assert_same_picture(both[:, 16:], picture()[:, 16:])


def moved_by_five(tree, start, end):
    move = tree.nodes.new("GeometryNodeTransform")
    move.inputs["Translation"].default_value = (5, 0, 0)
    tree.links.new(start, move.inputs["Geometry"])
    tree.links.new(move.outputs["Geometry"], end)


def test_an_instancer_that_hides_itself_shows_only_its_instances(motif, add_surfels, picture, assert_same_picture):
    alone = picture()
    instancer = add_surfels([(0, 0, 0)], size=2, is_shown=False)
    instancer.instance_type, instancer.show_instancer_for_render = "VERTS", False
    motif.parent = instancer
    assert_same_picture(alone, picture())


def test_what_is_hidden_from_render_is_not_drawn(scene, motif, picture):
    motif.hide_render = True
    assert not picture().any()


def test_what_is_hidden_in_the_viewport_only_is_drawn(scene, motif, picture):
    motif.hide_set(True)
    assert picture().any()


def test_what_is_in_an_excluded_collection_is_not_drawn(scene, motif, picture):
    excluded = bpy.data.collections.new("excluded")
    scene.collection.children.link(excluded)
    excluded.objects.link(motif)
    scene.collection.objects.unlink(motif)
    scene.view_layers[0].layer_collection.children["excluded"].exclude = True
    assert not picture().any()


def test_five_hundred_instances_are_all_drawn(scene, add_camera, add_surfels, add_mesh, add_nodes, picture):
    """Each one has its own block of 4 x 4 pixels. Vulkan runs out of descriptors if draws keep them."""
    scene.render.resolution_x, scene.render.resolution_y = 100, 80
    add_camera(type="ORTHO", ortho_scale=25, clip_end=100)
    dot = add_surfels([(0, 0, 0)], size=0.3)
    dot.hide_render = True
    x, y = np.meshgrid(np.arange(25) - 12.0, np.arange(20) - 9.5)
    instancer = add_mesh("points", np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3), [])
    add_nodes(instancer, instances_of(dot, scale=(1, 1, 1)))
    blocks = picture()[..., 3].reshape(20, 4, 25, 4)
    assert np.array_equal(blocks[:, 1:3, :, 1:3], np.ones((20, 2, 25, 2)))
    assert not blocks[:, [0, 3]][..., [0, 3]].any()


def test_what_instances_share_is_found_once(scene, motif, add_mesh, add_nodes, monkeypatch):
    """Of thousands, only the places are read one by one."""
    triangle = add_mesh("triangle", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    corners = np.random.default_rng(2).uniform(-2, 2, (60, 3)).astype(np.float32)
    for source in (motif, triangle):
        add_nodes(add_mesh(f"points of {source.name}", corners.tolist(), []), instances_of(source, scale=(2, 1, 1)))
        source.hide_render = source.hide_viewport = True
    asked, may_change = [], traits.may_change
    monkeypatch.setattr(traits, "may_change", lambda entry: asked.append(entry.object.name) or may_change(entry))
    found, _ = export_scene(bpy.context.evaluated_depsgraph_get(), SurfelStore(), LiveMeshes())
    for placed, source in ((found.surfels, motif), (found.polygons, triangle)):
        assert {each.name for each in placed} == {source.name}
        assert np.array_equal([each.matrix_world[:3, 3] for each in placed], corners)
        assert all(np.array_equal(each.matrix_world[:3, :3], np.diag((2, 1, 1))) for each in placed)
        assert len({id(each.shape) for each in placed}) == 1
    assert len(asked) == len(set(asked)) and {motif.name, "triangle"} <= set(asked)


def test_meshes_of_one_instancer_are_told_apart(scene, add_mesh, add_nodes):
    """Blender gives all of them as the same temporary object."""

    def build(tree, start, end):
        joined = tree.nodes.new("GeometryNodeJoinGeometry")
        for size in (1.0, 2.0, 3.0):
            cube, placed = tree.nodes.new("GeometryNodeMeshCube"), tree.nodes.new("GeometryNodeInstanceOnPoints")
            cube.inputs["Size"].default_value = (size, size, size)
            tree.links.new(start, placed.inputs["Points"])
            tree.links.new(cube.outputs["Mesh"], placed.inputs["Instance"])
            tree.links.new(placed.outputs["Instances"], joined.inputs[0])
        tree.links.new(joined.outputs[0], end)

    add_nodes(add_mesh("points", [(0, 0, 0), (5, 0, 0)], []), build)
    found, _ = export_scene(bpy.context.evaluated_depsgraph_get(), SurfelStore(), LiveMeshes())
    seen = sorted((float(each.shape.positions.max()), each.matrix_world[0, 3]) for each in found.polygons)
    assert seen == [(size / 2, x) for size in (1, 2, 3) for x in (0, 5)]
