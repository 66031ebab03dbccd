# SPDX-License-Identifier: GPL-3.0-or-later
"""Persistent Data keeps uploaded surfels on the device for the next render, which still shows every change."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.engine import final_render, render_resources


@pytest.fixture
def persistent(scene, picture):
    """The scene with persistent data; afterwards a render without it frees the device."""
    scene.render.use_persistent_data = True
    yield scene
    scene.render.use_persistent_data = False
    picture()
    assert render_resources._kept is None


def test_surfels_are_uploaded_once_for_all_renders(persistent, add_camera, add_surfels, picture, packed_surfels):
    add_camera()
    add_surfels([(0, 0, 0), (1, 1, 0)], size=0.5)
    first = picture()
    np.testing.assert_array_equal(picture(), first)
    assert first.any() and len(packed_surfels) == 1 and render_resources._kept is not None


def test_what_changed_is_seen(persistent, add_camera, add_surfels, picture, packed_surfels):
    add_camera()
    made = add_surfels([(0, 0, 0), (1, 1, 0)], size=0.5)
    first = picture()
    made.location.x = 1
    moved = picture()
    made.data.attributes["position"].data[0].vector = (-2, 0, 0)
    made.data.update()
    edited = picture()
    assert len(packed_surfels) == 2
    assert np.abs(moved - first).max() > 0.5 and np.abs(edited - moved).max() > 0.5


def test_reloaded_images_are_seen(persistent, add_camera, add_square, convert, picture, saved_image):
    """Blender tells an engine of no edit between two renders."""
    image = bpy.data.images.load(saved_image("image.png", (1, 0, 0, 1)))
    add_camera(location=(0.5, 0.5, 1), type="ORTHO", ortho_scale=3)
    square, persistent.world = add_square(), bpy.data.worlds.new("world")
    square.data.materials.append(bpy.data.materials.new("material"))
    for owner, kind in ((square.active_material, "Image"), (persistent.world, "Environment")):
        owner.use_nodes = True
        nodes, links = owner.node_tree.nodes, owner.node_tree.links
        nodes.new(f"ShaderNodeTex{kind}").image = image
        shader = nodes["Background"].inputs["Color"] if kind == "Environment" else nodes["Principled BSDF"].inputs[0]
        links.new(nodes[f"{kind} Texture"].outputs["Color"], shader)
    persistent.render.film_transparent = False
    convert(resolution=4, texture_mapped=True)
    beside = add_square("Beside")
    beside.location.x = -1
    beside.data.materials.append(square.active_material)
    surfels_polygons_sky = [16, 16, 1], [16, 5, 1]
    assert np.allclose(picture()[surfels_polygons_sky][:, :3], (1, 0, 0), atol=2e-3)
    saved_image("image.png", (0, 1, 0, 1))
    image.reload()
    assert np.allclose(picture()[surfels_polygons_sky][:, :3], (0, 1, 0), atol=2e-3)


def test_live_meshes_are_sampled_once(persistent, add_camera, picture):
    bpy.ops.mesh.primitive_uv_sphere_add()
    add_camera()
    persistent.surfel_splatting.render_meshes = "SURFELS"
    first = picture()
    assert final_render.last_frame_stats["live_meshes"]["sampled"] == 1
    np.testing.assert_array_equal(picture(), first)
    assert final_render.last_frame_stats["live_meshes"]["followed"] == 1


def test_a_failure_lets_everything_go(persistent, add_camera, add_surfels, picture):
    camera = add_camera()
    add_surfels([(0, 0, 0)], size=0.5)
    picture()
    camera.data.clip_start = 2000
    with pytest.raises(RuntimeError, match="near 2000"):
        picture()
    assert render_resources._kept is None
    camera.data.clip_start = 0.1
