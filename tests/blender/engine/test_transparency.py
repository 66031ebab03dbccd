# SPDX-License-Identifier: GPL-3.0-or-later
"""Transparent surfels and materials look as they do in Cycles."""

import bpy
import numpy as np
import pytest

WHITE_GLASS = (1, 1, 1, 0.5)


def test_surfels_of_half_opacity_show_half_of_what_is_behind(scene, add_camera, add_sheet, picture):
    add_camera()
    add_sheet(side=8, count=30, colors=WHITE_GLASS)
    add_sheet(side=8, count=30, colors=(1, 0, 0, 1)).location.z = -1
    for method in ("quad", "mip"):
        scene.surfel_splatting.method = method
        np.testing.assert_allclose(picture()[8:24, 8:24], np.broadcast_to((1, 0.5, 0.5, 1), (16, 16, 4)), atol=1e-5)


def test_layers_are_as_many_as_the_user_says(scene, add_camera, add_sheet, picture):
    add_camera(type="ORTHO", ortho_scale=4)
    for z in range(4):
        add_sheet(side=8, count=30, colors=WHITE_GLASS).location.z = -z
    properties = scene.surfel_splatting
    for layers, blends_rest, alpha in (
        (2, False, 0.75),
        (3, False, 0.875),
        (2, True, 1 - 0.5**4),
        (8, True, 1 - 0.5**4),
    ):
        properties.layers, properties.blends_rest = layers, blends_rest
        np.testing.assert_allclose(picture()[8:24, 8:24, 3], alpha, atol=1e-4)


@pytest.mark.parametrize("threshold", [0.0, 0.5, 0.9])
def test_depth_is_as_cycles_has_it_behind_what_is_transparent(scene, add_camera, add_sheet, passes, threshold):
    """The view layer's Alpha Threshold sets how opaque a surface must be to have a depth."""
    add_camera()
    add_sheet(side=8, count=30, colors=(1, 1, 1, 0.4)).location.z = 1
    add_sheet(side=8, count=30, colors=(1, 1, 1, 0.8))
    add_sheet(side=8, count=30).location.z = -1
    scene.view_layers[0].use_pass_z = True
    scene.view_layers[0].pass_alpha_threshold = threshold
    depth = passes()["ViewLayer.Depth"]
    np.testing.assert_allclose(depth[8:24, 8:24], {0.0: 9, 0.5: 10, 0.9: 11}[threshold], atol=1e-3)


@pytest.mark.parametrize("film", [False, True])
def test_a_holdout_cuts_the_alpha_that_cycles_cuts(scene, add_camera, add_object, switch_to_cycles, picture, film):
    """An object and a collection are held out, in front of a wall and in front of the world."""
    scene.render.film_transparent = film
    add_camera(type="ORTHO", ortho_scale=4)
    wall = mesh_square(add_object, 8, (1, 0, -1))
    wall.scale.x = 0.25
    own, held = mesh_square(add_object, 1, (0.75, 0.75, 0)), mesh_square(add_object, 1, (-0.75, -0.75, 0))
    own.is_holdout = True
    collection = bpy.data.collections.new("held")
    scene.collection.children.link(collection)
    collection.objects.link(held)
    scene.collection.objects.unlink(held)
    scene.view_layers[0].layer_collection.children["held"].holdout = True
    ours = picture()
    switch_to_cycles(filter_width=0.01)
    np.testing.assert_allclose(ours[..., 3], picture()[..., 3], atol=1e-3)
    assert (ours[20:22, 20:22] == 0).all() and (ours[8:10, 8:10] == 0).all() and (ours[4, 26, 3] == 1).all()


@pytest.mark.parametrize("kind", ["POLYGONS", "SURFELS", "converted", "overridden"])
@pytest.mark.parametrize("film", [False, True])
def test_a_holdout_material_cuts_the_alpha_that_cycles_cuts(
    scene, add_camera, add_object, switch_to_cycles, convert, picture, film, kind
):
    """A square is held out, and half of another one, in front of a wall and in front of the world."""
    scene.render.film_transparent = film
    add_camera(type="ORTHO", ortho_scale=4)
    plain, hole = (bpy.data.materials.new(name) for name in ("plain", "hole"))
    if bpy.app.version < (5, 0, 0):
        plain.use_nodes = hole.use_nodes = True
    tree = hole.node_tree
    tree.links.new(tree.nodes.new("ShaderNodeHoldout").outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    wall, whole = mesh_square(add_object, 8, (1, 0, -1)), mesh_square(add_object, 1, (0.75, 0.75, 0))
    wall.scale.x = 0.25
    half = bpy.data.meshes.new("half")
    places = [(x, y, 0) for y in (-1.5, -0.5) for x in (-1.5, -0.5, 0.5)]
    half.from_pydata(places, [], [(0, 1, 4, 3), (1, 2, 5, 4)])
    half.polygons[1].material_index = 1
    meshes = {wall.data: [plain], whole.data: [hole], half: [plain, hole]}
    for object_ in (wall, whole, add_object(half)):
        for material in meshes[object_.data]:
            object_.data.materials.append(material)
        object_.select_set(True)
    if kind == "overridden":
        scene.view_layers[0].material_override = hole
    ours = scene.render.engine
    switch_to_cycles(filter_width=0.01)
    theirs = picture()
    scene.render.engine = ours
    settings = scene.surfel_splatting
    settings.render_meshes = "SURFELS" if kind == "SURFELS" else "POLYGONS"
    settings.mesh_density, settings.mesh_resolution = "RESOLUTION", 64
    if kind in ("converted", "overridden"):
        convert(resolution=64)
    ours = picture()
    np.testing.assert_allclose(ours[..., 3], theirs[..., 3], atol=0.02)
    assert (ours[20:24, 20:24] == 0).all() and (ours[6:10, 14:18] == 0).all()
    assert ((ours[6:10, 6:10, 3] == 1) | (kind == "overridden")).all()


def mesh_square(add_object, side, location):
    mesh = bpy.data.meshes.new("square")
    half = side / 2
    mesh.from_pydata([(-half, -half, 0), (half, -half, 0), (half, half, 0), (-half, half, 0)], [], [(0, 1, 2, 3)])
    made = add_object(mesh)
    made.location = location
    return made


def test_a_sprite_method_says_that_it_draws_what_is_transparent_opaque(scene, add_camera, add_sheet, picture):
    from splat_addon.blender.engine.final_render import last_frame_stats

    add_camera()
    add_sheet(side=8, count=30, colors=WHITE_GLASS)
    scene.surfel_splatting.method = "sprites_unfiltered"
    assert picture()[16, 16, 3] == 1
    assert any("drawn opaque" in note for note in last_frame_stats["notes"])
