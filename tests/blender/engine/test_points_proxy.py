# SPDX-License-Identifier: GPL-3.0-or-later
"""Other engines see surfel objects as points; this engine sees the same surfels as before."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.geometry.points_proxy import show_as_points

POSITIONS = np.random.default_rng(4).uniform(-1.5, 1.5, (12, 3))
COLORS = np.concatenate([np.random.default_rng(5).uniform(0.2, 1, (12, 3)), np.ones((12, 1))], axis=1)


@pytest.fixture
def discs(add_camera, add_surfels):
    """discs(is_shown) -> an object of coloured discs that face in all directions."""
    add_camera()
    normals = np.random.default_rng(6).normal(size=(12, 3))
    return lambda is_shown: add_surfels(POSITIONS, normals, 0.4, COLORS, is_shown=is_shown)


def alone(scene, discs, add_mesh, add_nodes):
    return discs


def in_a_collection(scene, discs, add_mesh, add_nodes):
    hidden = bpy.data.collections.new("hidden")
    hidden.objects.link(discs)
    scene.collection.objects.unlink(discs)
    instancer = bpy.data.objects.new("instancer", None)
    instancer.instance_type, instancer.instance_collection = "COLLECTION", hidden
    instancer.location = (0.5, 0.2, 0)
    scene.collection.objects.link(instancer)


def as_hidden_source_of_instances(scene, discs, add_mesh, add_nodes):
    """Hide the object and place instances of it; Blender leaves the points out of such instances in renders."""
    discs.hide_render = True

    def build(tree, start, end):
        info, instance = tree.nodes.new("GeometryNodeObjectInfo"), tree.nodes.new("GeometryNodeInstanceOnPoints")
        info.inputs["Object"].default_value, info.inputs["As Instance"].default_value = discs, True
        tree.links.new(start, instance.inputs["Points"])
        tree.links.new(info.outputs["Geometry"], instance.inputs["Instance"])
        tree.links.new(instance.outputs["Instances"], end)

    add_nodes(add_mesh("places", [(-1, -1, 0), (1, 1, 0)], []), build)


def mirrored(scene, discs, add_mesh, add_nodes):
    discs.modifiers.new("mirror", "MIRROR").use_mirror_merge = False


@pytest.mark.parametrize("use", [alone, in_a_collection, as_hidden_source_of_instances, mirrored])
def test_the_engine_draws_the_same_surfels(use, discs, scene, add_mesh, add_nodes, picture, assert_same_picture):
    pictures = []
    for is_shown in (False, True):
        made = discs(is_shown)
        use(scene, made, add_mesh, add_nodes)
        pictures.append(picture())
        for owner in list(bpy.data.objects):
            if owner.type != "CAMERA":
                bpy.data.objects.remove(owner)
    assert_same_picture(*pictures)


def test_cycles_shows_the_surfels_in_their_colours(discs, picture, switch_to_cycles, scene):
    switch_to_cycles()
    scene.world = bpy.data.worlds.new("white")
    if scene.world.node_tree is None:
        scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (1, 1, 1, 1)
    discs(is_shown=False)
    assert not picture().any()
    bpy.data.objects.remove(bpy.data.objects["surfels"])
    made = discs(is_shown=True)
    seen = picture()
    assert (seen[..., 3] > 0.5).mean() > 0.1
    nearest = made.data.attributes["position"].data[int(np.argmax(POSITIONS[:, 2]))].vector
    row, column = (int(16 + 32 * c / (10 - nearest.z) * 50 / 36) for c in (nearest.y, nearest.x))
    own = COLORS[np.argmax(POSITIONS[:, 2]), :3]
    assert np.corrcoef(seen[row, column, :3], own)[0, 1] > 0.9


def test_each_of_several_point_clouds_keeps_its_own_surfels(scene, add_camera, add_sheet, picture):
    """Object > Convert makes point clouds of surfel objects; an evaluated one has no number of its own."""
    add_camera()
    for x, color in ((-1.5, (1, 0, 0, 1)), (1.5, (0, 0, 1, 1))):
        add_sheet(side=1, colors=color, is_shown=False).location.x = x
        bpy.ops.object.convert(target="POINTCLOUD")
    drawn = picture()
    assert np.allclose(drawn[16, 11], (1, 0, 0, 1), atol=1e-3) and np.allclose(drawn[16, 20], (0, 0, 1, 1), atol=1e-3)


def test_modifiers_added_later_come_before_it(discs):
    made = discs(is_shown=True)
    made.modifiers.new("array", "ARRAY")
    assert [modifier.type for modifier in made.modifiers] == ["ARRAY", "NODES"]


def test_faces_that_are_joined_to_surfels_stay_faces(discs, add_square):
    made = discs(is_shown=True)
    add_square().select_set(True)
    made.select_set(True)
    bpy.context.view_layer.objects.active = made
    bpy.ops.object.join()
    geometry = made.evaluated_get(bpy.context.evaluated_depsgraph_get()).evaluated_geometry()
    assert (len(geometry.pointcloud.points), len(geometry.mesh.polygons)) == (12, 1)


def test_all_surfel_objects_share_one_group_and_one_material(discs):
    for _ in range(3):
        show_as_points(discs(is_shown=True))
    assert len(bpy.data.node_groups) == 1
    assert [material.name for material in bpy.data.materials] == ["Surfels as Points"]
