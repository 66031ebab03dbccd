# SPDX-License-Identifier: GPL-3.0-or-later
"""In a file whose working space is not Rec. 709, colours come in, go out and are weighed as Blender means them."""

import bpy
import numpy as np
import pytest
from mathutils import Color

from splat_addon.blender.materials import ramps
from splat_addon.blender.materials.surface_shaders import surface_shader
from splat_addon.blender.materials.texture_images import linear_pixels
from splat_addon.interchange import read_ply, write_ply
from splat_addon.streaming import Stream

pytestmark = pytest.mark.skipif(not hasattr(bpy.data, "colorspace"), reason="this Blender has no working space")

ENCODED = np.array((200, 60, 40)) / 255


def change_to(space, **options):
    assert bpy.ops.wm.set_working_color_space(working_space=space, **options) == {"FINISHED"}


@pytest.fixture
def aces():
    change_to("ACEScg")


def in_file(linear):
    """Linear Rec. 709 in the working space, by Blender."""
    return np.array([Color(color[:3]).from_rec709_linear_to_scene_linear()[:] for color in np.atleast_2d(linear)])


@pytest.mark.parametrize(
    "space, as_blender",  # a method of Color, which Blender 4.5 does not have for all
    [
        ("sRGB", "from_srgb_to_scene_linear"),
        ("Linear Rec.709", "from_rec709_linear_to_scene_linear"),
        ("Linear Rec.2020", "from_rec2020_linear_to_scene_linear"),
        ("ACEScg", "from_acescg_to_scene_linear"),
        ("ACES2065-1", "from_aces_to_scene_linear"),
        ("Non-Color", "copy"),
        ("scene_linear", "copy"),
    ],
)
def test_8_bit_images_of_any_colour_space_are_in_the_working_space(aces, space, as_blender):
    image = bpy.data.images.new("image", 3, 2)
    image.colorspace_settings.name = space
    image.pixels.foreach_set(np.tile(np.float32((*ENCODED, 1)), 6))
    image.pixels[:4] = (0, 0, 0, 1)
    pixels, count = linear_pixels(image, keep_alpha=False), len(bpy.data.images)
    assert np.allclose(pixels[1, 1], (*getattr(Color(ENCODED), as_blender)(), 1), atol=2e-5)
    assert np.allclose(pixels[0, 0], (0, 0, 0, 1), atol=1e-6) and count == 1


def test_files_of_surfels_are_in_rec_709(aces, random_surfels, surfels_of, add_object, tmp_path):
    written = random_surfels(50)
    write_ply(tmp_path / "a.ply", written)
    bpy.ops.import_scene.surfels_ply(filepath=str(tmp_path / "a.ply"))
    made = bpy.context.object
    stored = surfels_of(made)
    assert np.allclose(stored.colors[:, :3], in_file(written.colors), atol=1e-6)
    assert np.array_equal(stored.colors[:, 3], written.colors[:, 3])
    bpy.ops.export_scene.surfels_ply(filepath=str(tmp_path / "b.ply"))
    assert np.allclose(read_ply(tmp_path / "b.ply").colors, written.colors, atol=1e-6)
    # a file of blocks, and what is kept of it in the object
    bpy.ops.object.surfels_to_file(filepath=str(tmp_path / "a.surfelblocks"))
    stream = Stream(tmp_path / "a.surfelblocks", 1 << 20)
    assert np.allclose(by_position(stream.at_most(100)), by_position(written), atol=1e-6)
    assert np.allclose(by_position(surfels_of(made)), by_position(stored), atol=1e-6)
    stream.close()


def by_position(surfels):
    return surfels.colors[np.lexsort(surfels.positions.T)]


def test_a_colour_s_luminance_does_not_depend_on_the_working_space():
    material = bpy.data.materials.new("grey")
    nodes, links = material.node_tree.nodes, material.node_tree.links
    color, grey, shader = nodes.new("ShaderNodeRGB"), nodes.new("ShaderNodeRGBToBW"), nodes["Principled BSDF"]
    color.outputs[0].default_value = (0.1, 0.6, 0.3, 1)
    links.new(color.outputs[0], grey.inputs[0])
    links.new(grey.outputs[0], shader.inputs["Roughness"])
    read = [surface_shader(material).product("Roughness").value[0]]
    assert np.isclose(read[0], 0.2126 * 0.1 + 0.7152 * 0.6 + 0.0722 * 0.3, atol=1e-4)
    ramp = [np.dot(ramps.ramp_of(None).luminance, (0.1, 0.6, 0.3))]
    for space in ("ACEScg", "Linear Rec.2020"):
        change_to(space)
        read.append(surface_shader(material).product("Roughness").value[0])
        ramp.append(np.dot(ramps.ramp_of(None).luminance, in_file((0.1, 0.6, 0.3))[0]))
    assert np.allclose(read, read[0], atol=1e-4) and np.allclose(ramp, read[0], atol=1e-4)
