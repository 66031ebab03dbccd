# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons look up images at each pixel: colours, normals, roughness and metallic; what they do not show is said."""

import bpy
import numpy as np
import pytest

from tests.blender.engine.mesh_scenes import add_sun, as_cycles_has_it, counts, principled


def test_an_image_is_looked_up_at_every_pixel(slanting, picture, switch_to_cycles):
    """The image passes through a Mapping node and is repeated."""
    slanting.surfel_splatting.shading = "flat"
    slanting.surfel_splatting.supersampling = 4
    image = bpy.data.images.new("checks", 16, 16, float_buffer=True)
    pixels = np.random.default_rng(0).uniform(0.1, 0.9, (16, 16, 4)).astype(np.float32)
    pixels[..., 3] = 1
    image.pixels.foreach_set(pixels.ravel())
    material = bpy.data.materials.new("textured")
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    tree = material.node_tree
    texture, mapping, where = (tree.nodes.new(f"ShaderNode{n}") for n in ("TexImage", "Mapping", "TexCoord"))
    emission = tree.nodes.new("ShaderNodeBsdfDiffuse")
    texture.image, texture.interpolation = image, "Closest"
    mapping.inputs["Scale"].default_value = (2, 1.5, 1)
    tree.links.new(where.outputs["UV"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    tree.links.new(texture.outputs["Color"], emission.inputs["Color"])
    tree.links.new(emission.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    bpy.ops.mesh.primitive_plane_add(size=3)
    bpy.context.object.data.materials.append(material)
    ours = picture()
    # under a uniform white world the radiance is the colour
    slanting.world = bpy.data.worlds.new("white")
    slanting.world.color = (1, 1, 1)
    if bpy.app.version < (5, 0, 0):
        slanting.world.use_nodes = True
    slanting.world.node_tree.nodes["Background"].inputs["Color"].default_value = (1, 1, 1, 1)
    switch_to_cycles(samples=64, filter_width=1.0)
    truth = picture()
    inside = (ours[..., 3] == 1) & (truth[..., 3] > 0.999)
    assert np.abs(ours - truth)[inside].mean() < 0.02 < ours[inside][:, :3].std()


def add_normal_map(material, strength=1.0, space="TANGENT") -> None:
    """Waves along u and v, from an image."""
    u, v = np.meshgrid(*2 * [(np.arange(64) + 0.5) / 64 * 2 * np.pi])
    normals = np.stack([0.5 * np.sin(3 * u), 0.3 * np.sin(2 * v + u), np.ones_like(u)], axis=2)
    pixels = np.ones((64, 64, 4), np.float32)
    pixels[..., :3] = normals / np.linalg.norm(normals, axis=2, keepdims=True) / 2 + 0.5
    image = bpy.data.images.new("waves", 64, 64, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_set(pixels.ravel())
    tree = material.node_tree
    texture, bump = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeNormalMap")
    texture.image, bump.space, bump.inputs["Strength"].default_value = image, space, strength
    tree.links.new(texture.outputs["Color"], bump.inputs["Color"])
    tree.links.new(bump.outputs["Normal"], tree.nodes["Principled BSDF"].inputs["Normal"])


@pytest.mark.parametrize(("form", "strength"), [("plane", 0.8), ("sphere", 0.4)])
def test_a_normal_map_is_as_in_cycles(form, strength, slanting, picture, said, switch_to_cycles):
    """Cycles dims light that grazes the surface behind a steep map, which this engine does not."""
    if form == "plane":
        bpy.ops.mesh.primitive_plane_add(size=3, rotation=(0.2, -0.3, 0.7))
    else:
        bpy.ops.mesh.primitive_uv_sphere_add(radius=1.5, segments=48, ring_count=24)
        bpy.ops.object.shade_smooth()
    mesh = bpy.context.object.data
    mesh.materials.append(principled(Roughness=0.8, Specular_IOR_Level=0.0))
    add_sun(slanting, rotation=(0.3, 0.2, 0))
    smooth = picture()
    add_normal_map(mesh.materials[0], strength=strength)
    ours = picture()
    assert set(counts()) == {"polygon_meshes", "triangles"} and "normal map" not in said()
    switch_to_cycles(samples=64)
    slanting.cycles.max_bounces = 0
    truth = picture()
    assert as_cycles_has_it(ours, truth, share=0.05)
    assert not as_cycles_has_it(smooth, ours, share=0.05)


def add_gloss(material, sizes, turned=False) -> None:
    """Roughness and metallic from green and blue of one image, or from two. turned: the second lies elsewhere."""
    tree, made = material.node_tree, []
    for size in sizes:
        u, v = np.meshgrid(*2 * [(np.arange(size) + 0.5) / size * 2 * np.pi])
        pixels = np.ones((size, size, 4), np.float32)
        pixels[..., 1], pixels[..., 2] = 0.55 + 0.25 * np.sin(2 * u), 0.5 + 0.5 * np.sin(3 * v)
        image = bpy.data.images.new("gloss", size, size, float_buffer=True)
        image.colorspace_settings.name = "Non-Color"
        image.pixels.foreach_set(pixels.ravel())
        texture, parts = tree.nodes.new("ShaderNodeTexImage"), tree.nodes.new("ShaderNodeSeparateColor")
        texture.image = image
        tree.links.new(texture.outputs["Color"], parts.inputs[0])
        made.append(parts)
    if turned:
        mapping, place = tree.nodes.new("ShaderNodeMapping"), tree.nodes.new("ShaderNodeTexCoord")
        mapping.inputs["Rotation"].default_value[2] = 0.5
        tree.links.new(place.outputs["UV"], mapping.inputs[0])
        tree.links.new(mapping.outputs[0], made[-1].inputs[0].links[0].from_node.inputs[0])
    shader = tree.nodes["Principled BSDF"]
    tree.links.new(made[0].outputs["Green"], shader.inputs["Roughness"])
    tree.links.new(made[-1].outputs["Blue"], shader.inputs["Metallic"])


@pytest.mark.parametrize("sizes", [(64,), (64, 32)], ids=["one image", "two images"])
def test_roughness_and_metallic_images_are_as_in_cycles(sizes, slanting, picture, said, switch_to_cycles):
    bpy.ops.mesh.primitive_plane_add(size=3, rotation=(0.2, -0.3, 0.7))
    mesh = bpy.context.object.data
    mesh.materials.append(principled(Base_Color=(0.8, 0.5, 0.3, 1)))
    add_sun(slanting, rotation=(-0.2, 0.5, 0))
    plain = picture()
    add_gloss(mesh.materials[0], sizes)
    ours = picture()
    assert set(counts()) == {"polygon_meshes", "triangles"} and "for its" not in said()
    switch_to_cycles(samples=64)
    slanting.cycles.max_bounces = 0
    assert as_cycles_has_it(ours, picture(), share=0.05)
    assert np.abs(plain - ours).max() > 0.1


def test_images_at_two_places_are_named(slanting, picture, said):
    bpy.ops.mesh.primitive_plane_add(size=3)
    bpy.context.object.data.materials.append(principled())
    add_gloss(bpy.context.object.data.materials[0], (8, 8), turned=True)
    bpy.context.object.surfel_splatting.render_as = "POLYGONS"
    picture()
    assert "has an image or nodes for its metallic and roughness" in said()


def test_a_normal_map_that_polygons_do_not_show_is_named(slanting, picture, said):
    bpy.ops.mesh.primitive_cube_add()
    bpy.context.object.data.materials.append(principled())
    add_normal_map(bpy.context.object.data.materials[0], space="OBJECT")
    bpy.context.object.surfel_splatting.render_as = "POLYGONS"
    picture()
    assert "Cube has a normal map that is not one image in tangent space" in said()


@pytest.mark.parametrize("channel", ["Emission Color", "Roughness", "Base Color"])
def test_images_that_polygons_show_at_corners_alone_are_named(channel, slanting, picture, said):
    """The images of colour and roughness are looked up pixel by pixel, and that of the emission is not."""
    bpy.ops.mesh.primitive_cube_add()
    material = principled(Emission_Strength=1.0)
    bpy.context.object.data.materials.append(material)
    bpy.context.object.surfel_splatting.render_as = "POLYGONS"
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = bpy.data.images.new("spots", 4, 4)
    material.node_tree.links.new(node.outputs["Color"], material.node_tree.nodes["Principled BSDF"].inputs[channel])
    picture()
    name = {"Emission Color": "emission"}.get(channel)
    told = said()
    assert (f"Cube has an image or nodes for its {name}, of which polygons show only" in told) == (name is not None)
    assert ("at their corners" in told) == (name is not None)
