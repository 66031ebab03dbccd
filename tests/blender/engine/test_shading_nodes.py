# SPDX-License-Identifier: GPL-3.0-or-later
"""The engine draws materials as their nodes make them: on polygons where one image shows it, as surfels elsewhere."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.engine import final_render


@pytest.fixture
def squares(scene, add_camera, add_square):
    """squares(build, count) -> squares beside each other that share a mesh, whose Base Color is what build(tree)
    returns, seen from above."""

    def made(build, count=1):
        first = add_square()
        material = bpy.data.materials.new("nodes")
        if bpy.app.version < (5, 0, 0):
            material.use_nodes = True
        tree = material.node_tree
        tree.links.new(build(tree), tree.nodes["Principled BSDF"].inputs["Base Color"])
        first.data.materials.append(material)
        others = [bpy.data.objects.new("square", first.data) for _ in range(count - 1)]
        for k, other in enumerate(others, 1):
            bpy.context.collection.objects.link(other)
            other.location.x = k
        add_camera(location=(count / 2, 0.5, 5), type="ORTHO", ortho_scale=count)
        scene.render.resolution_x, scene.render.resolution_y = 16 * count, 16
        scene.surfel_splatting.shading = "flat"
        return [first, *others]

    return made


def node(tree, kind, **settings):
    made = tree.nodes.new(f"ShaderNode{kind}")
    for name, value in settings.items():
        setattr(made, name, value)
    return made


def test_a_colour_node_after_an_image_is_drawn_on_polygons(squares, picture):
    def inverted(tree):
        image = bpy.data.images.new("quarters", 2, 2, float_buffer=True)
        image.pixels.foreach_set([1, 0, 0, 1, 0, 1, 0, 1, 0, 0, 1, 1, 1, 1, 1, 1])
        texture, invert = node(tree, "TexImage", image=image, interpolation="Closest"), node(tree, "Invert")
        tree.links.new(texture.outputs[0], invert.inputs[1])
        return invert.outputs[0]

    squares(inverted)
    pixels = picture()[..., :3]
    assert np.allclose(pixels[4::8, 4::8], [[(0, 1, 1), (1, 0, 1)], [(1, 1, 0), (0, 0, 0)]], atol=1e-3)
    meshes = final_render.last_frame_stats["live_meshes"]
    assert meshes["triangles"] == 2 and "surfels" not in meshes and not final_render.last_frame_stats["notes"]


def test_a_texture_that_polygons_cannot_draw_makes_surfels_of_them(squares, picture):
    """A gradient along Generated X is black at the left and white at the right."""
    squares(lambda tree: node(tree, "TexGradient").outputs[0])
    pixels = picture()[8, 1:-1, 0]
    assert np.allclose(pixels, (np.arange(1, 15) + 0.5) / 16, atol=0.02)


def test_objects_that_share_a_mesh_have_their_own_object_colour(squares, picture):
    first, second = squares(lambda tree: node(tree, "ObjectInfo").outputs["Color"], count=2)
    first.color, second.color = (1, 0, 0, 1), (0, 1, 0, 1)
    pixels = picture()[..., :3]
    assert np.allclose(pixels[8, 8], (1, 0, 0), atol=1e-3) and np.allclose(pixels[8, 24], (0, 1, 0), atol=1e-3)


def test_pointiness_is_that_of_cycles(scene, add_camera, picture, switch_to_cycles):
    """A box with round edges glows where it stands out."""
    bpy.ops.mesh.primitive_cube_add()
    box = bpy.context.object
    bevel = box.modifiers.new("Bevel", "BEVEL")
    bevel.width, bevel.segments = 0.6, 3
    material = bpy.data.materials.new("edges")
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    tree = material.node_tree
    edges, ranged, light = node(tree, "NewGeometry"), node(tree, "MapRange"), node(tree, "Emission")
    ranged.inputs["From Min"].default_value, ranged.inputs["From Max"].default_value = 0.45, 0.65
    tree.links.new(edges.outputs["Pointiness"], ranged.inputs["Value"])
    tree.links.new(ranged.outputs[0], light.inputs["Color"])
    tree.links.new(light.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    box.data.materials.append(material)
    add_camera(location=(0, 0, 5), type="ORTHO", ortho_scale=1.8)
    scene.render.resolution_x = scene.render.resolution_y = 32
    scene.surfel_splatting.shading, scene.world = "principled", None
    ours = picture()
    switch_to_cycles(samples=16)
    truth = picture()
    inside = (ours[..., 3] == 1) & (truth[..., 3] == 1)
    assert truth[inside, 0].std() > 0.02 and np.abs(ours - truth)[inside, 0].max() < 0.01
