# SPDX-License-Identifier: GPL-3.0-or-later
"""Polygons are cut out by the alpha of their image, as in Cycles."""

import bpy
import numpy as np
import pytest

from tests.blender.engine.mesh_scenes import add_sun, counts, principled


def leaf_card(pixels, is_mixed=False) -> bpy.types.Object:
    """A plane whose Base Color and Alpha come from one image, or whose alpha mixes it with a Transparent BSDF."""
    image = bpy.data.images.new("leaf", *pixels.shape[1::-1], alpha=True, float_buffer=True)
    image.pixels.foreach_set(np.float32(pixels).ravel())
    material = principled(Roughness=1.0)
    tree, shader = material.node_tree, material.node_tree.nodes["Principled BSDF"]
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = image
    tree.links.new(texture.outputs["Color"], shader.inputs["Base Color"])
    if is_mixed:
        mix, clear = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeBsdfTransparent")
        for output, to in ((texture.outputs["Alpha"], 0), (clear.outputs[0], 1), (shader.outputs[0], 2)):
            tree.links.new(output, mix.inputs[to])
        tree.links.new(mix.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    else:
        tree.links.new(texture.outputs["Alpha"], shader.inputs["Alpha"])
    bpy.ops.mesh.primitive_plane_add(size=3)
    bpy.context.object.data.materials.append(material)
    return bpy.context.object


def leaf(size=32) -> np.ndarray:
    """The pixels of a green disc; the transparent ones around it are black, as in a real leaf card."""
    x, y = np.meshgrid(*2 * [(np.arange(size) + 0.5) / size - 0.5])
    inside = x * x + y * y < 0.35**2
    return inside[..., None] * np.array((0.1, 0.6, 0.2, 1.0))


@pytest.mark.parametrize(("form", "is_mixed"), [("SCENE", False), ("POLYGONS", False), ("SCENE", True)])
def test_a_leaf_card_is_seen_through_as_in_cycles(form, is_mixed, slanting, picture, said, switch_to_cycles):
    """It is polygons, by default and on demand, and none of the black around the leaf is visible."""
    slanting.surfel_splatting.samples = 16
    card = leaf_card(leaf(), is_mixed)
    card.surfel_splatting.render_as = form
    add_sun(slanting)
    ours = picture()
    assert set(counts()) == {"polygon_meshes", "triangles"} and "transparent" not in said()
    switch_to_cycles(samples=64)
    slanting.cycles.max_bounces, slanting.cycles.transparent_max_bounces = 0, 8
    truth = picture()
    assert np.abs(ours[..., 3] - truth[..., 3]).mean() < 0.01
    assert abs(ours[..., 3].sum() / truth[..., 3].sum() - 1) < 0.03
    whole = (truth[..., 3] > 0.999) & (ours[..., 3] > 0.999)
    assert whole.sum() > 300 and np.abs(ours - truth)[whole].max() < 0.1 * truth[whole].max()
    rim = (ours[..., 3] > 0.05) & (ours[..., 3] < 0.95)
    assert rim.sum() > 20
    straight = ours[rim][:, :3] / ours[rim][:, 3:]
    assert np.abs(straight - np.median(ours[whole][:, :3], axis=0)).max() < 0.1 * truth[whole].max()


def test_an_alpha_from_elsewhere_makes_surfels(slanting, picture):
    """The image's own alpha times a constant cuts no hole: everything is transparent."""
    card = leaf_card(leaf())
    tree = card.material_slots[0].material.node_tree
    halved = tree.nodes.new("ShaderNodeMath")
    halved.operation, halved.inputs[1].default_value = "MULTIPLY", 0.5
    alpha = tree.nodes["Principled BSDF"].inputs["Alpha"]
    tree.links.new(alpha.links[0].from_socket, halved.inputs[0])
    tree.links.new(halved.outputs[0], alpha)
    assert picture()[..., 3].max() == pytest.approx(0.5, abs=0.01) and "triangles" not in counts()


def test_a_card_of_an_opaque_image_stays_polygons(slanting, picture):
    pixels = leaf()
    pixels[..., 3] = 1
    leaf_card(pixels)
    assert picture()[..., 3].max() == 1 and set(counts()) == {"polygon_meshes", "triangles"}
