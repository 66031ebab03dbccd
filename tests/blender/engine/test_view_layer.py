# SPDX-License-Identifier: GPL-3.0-or-later
"""A view layer's material override and its visible collections apply to surfels and to polygons."""

import bpy
import numpy as np
import pytest


@pytest.fixture
def things(scene, add_camera, add_surfels, add_square):
    """A disc of green surfels on the left, a white square of polygons on the right; no world."""
    add_camera()
    add_surfels([(-1, 0, 0)], size=0.8, colors=(0, 1, 0, 1))
    add_square().location = (0.5, -0.5, 0)


LEFT, RIGHT = (16, 12), (16, 20)


def material(color=(1, 0, 0, 1), name="red"):
    made = bpy.data.materials.new(name)
    if bpy.app.version < (5, 0, 0):
        made.use_nodes = True
    made.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = color
    return made


@pytest.mark.parametrize("meshes", ["POLYGONS", "SURFELS"])
def test_the_material_override_paints_everything(things, scene, picture, meshes):
    scene.surfel_splatting.render_meshes = meshes
    before = picture()
    assert np.array_equal(before[LEFT], (0, 1, 0, 1)) and before[RIGHT][1] > 0.5
    bpy.context.view_layer.material_override = material()
    for pixel in (LEFT, RIGHT):
        assert np.allclose(picture()[pixel], (1, 0, 0, 1), atol=1e-6)
    bpy.context.view_layer.material_override = None
    assert np.array_equal(picture(), before)


def test_under_an_override_surfels_keep_their_form(scene, add_camera, cube, convert, picture):
    """They end at edges as before, and those inside flat faces do not bulge over them."""
    add_camera(type="ORTHO", ortho_scale=4)
    cube.rotation_euler = (0.4, 0.5, 0.3)
    convert(resolution=6, source="HIDE")
    before = picture()
    bpy.context.view_layer.material_override = material((1, 1, 1, 1), "white")
    covered = picture()
    assert 0.2 < before[..., 3].mean() < 0.8
    assert np.array_equal(covered[..., 3], before[..., 3])


def test_another_override_takes_the_place_of_the_first_in_a_view(add_square):
    """A view reads a mesh again only if its key is another one."""
    from splat_addon.blender.export.changes import Changes
    from splat_addon.blender.export.live_meshes import LiveMeshes
    from splat_addon.blender.export.scene import export_scene
    from splat_addon.blender.export.sliced_store import SlicedStore

    add_square()
    view_layer, live, colors = bpy.context.view_layer, LiveMeshes(), []
    for color in ((1, 0, 0, 1), (0, 0, 1, 1)):
        view_layer.material_override = material(color, f"paint {color}")
        live.begin_frame(Changes())
        scene, _ = export_scene(bpy.context.evaluated_depsgraph_get(), SlicedStore(), live)
        colors.append(tuple(scene.polygons[0].polygons.colors[0]))
    assert colors == [(1, 0, 0, 1), (0, 0, 1, 1)]


def test_a_textured_override_gives_surfels_its_plain_colour_and_says_so(things, picture, said):
    made = material((0, 0, 1, 1), "textured")
    node = made.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = bpy.data.images.new("white", 1, 1)
    made.node_tree.links.new(node.outputs["Color"], made.node_tree.nodes["Principled BSDF"].inputs["Base Color"])
    bpy.context.view_layer.material_override = made
    assert np.allclose(picture()[LEFT], (0, 0, 1, 1))
    assert "The overriding material 'textured' is textured" in said()


@pytest.fixture
def sky(scene):
    """A blue world behind an opaque film."""
    scene.render.film_transparent = False
    scene.world = bpy.data.worlds.new("sky")
    if bpy.app.version < (5, 0, 0):
        scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (0, 0, 1, 1)


def test_without_its_environment_a_layer_has_no_world(things, sky, picture):
    assert np.allclose(picture()[2, 2], (0, 0, 1, 1))
    bpy.context.view_layer.use_sky = False
    assert np.allclose(picture()[2, 2], (0, 0, 0, 1))


@pytest.mark.skipif("world_override" not in bpy.types.ViewLayer.bl_rna.properties, reason="Blender 5.0 brought it")
def test_the_world_override_takes_the_world_s_place(things, sky, picture):
    other = bpy.data.worlds.new("other")
    if bpy.app.version < (5, 0, 0):
        other.use_nodes = True
    other.node_tree.nodes["Background"].inputs["Color"].default_value = (0.5, 0, 0, 1)
    bpy.context.view_layer.world_override = other
    assert np.allclose(picture()[2, 2], (0.5, 0, 0, 1))


def test_without_its_surfaces_a_layer_is_empty(things, picture):
    bpy.context.view_layer.use_solid = False
    assert not picture().any()


def test_a_layer_s_samples_come_before_the_scene_s(things, picture):
    from splat_addon.blender.engine import final_render

    bpy.context.view_layer.samples = 3
    picture()
    assert final_render.last_frame_stats["samples"] == 3


@pytest.mark.parametrize("way", ["object", "collection"])
def test_what_the_camera_does_not_see_casts_its_shadow(things, scene, add_square, picture, way):
    square = bpy.data.objects["Square"]
    if way == "object":
        square.visible_camera = False
    else:
        apart = bpy.data.collections.new("apart")
        scene.collection.children.link(apart)
        apart.objects.link(square)
        scene.collection.objects.unlink(square)
        bpy.context.view_layer.layer_collection.children["apart"].indirect_only = True
    drawn = picture()
    assert drawn[LEFT].any() and not drawn[RIGHT].any()
    floor, sun = add_square(), bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    floor.location, floor.scale, sun.data.energy = (-5, -5, -1), (10, 10, 1), 3.0
    scene.collection.objects.link(sun)
    scene.surfel_splatting.shading = "principled"
    shaded = picture()
    square.visible_shadow = False
    lit = picture()
    assert (lit - shaded)[RIGHT][1] > 0.2 and np.allclose(lit[LEFT], shaded[LEFT])
