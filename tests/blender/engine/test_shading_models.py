# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's properties set shading models, lines and matcaps."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.materials.matcap_images import doubt, matcap_of
from splat_addon.blender.materials.ramps import ramp_of
from splat_addon.blender.properties import viewport_settings
from splat_addon.rendering.shading_models import SHADING_MODELS


@pytest.fixture
def sheet(scene, add_sheet, add_camera):
    """The engine's render settings, in a scene with a sheet that faces the camera."""
    add_sheet(colors=(1.0, 0.5, 0.25, 1.0), is_shown=False)
    add_camera((0, 0, 10), type="ORTHO", ortho_scale=3.0)
    return scene.surfel_splatting


def center(picture):
    return picture[14:18, 14:18, :3].mean(axis=(0, 1))


def own_matcaps():
    return [light for light in bpy.context.preferences.studio_lights if light.type == "MATCAP"]


def test_every_model_can_be_chosen(sheet):
    names = bpy.types.Scene.bl_rna.properties["surfel_splatting"].fixed_type.properties["shading"].enum_items.keys()
    assert names == list(SHADING_MODELS)


def test_a_model_is_rendered(sheet, picture):
    sheet.shading = "normals"
    assert center(picture()) == pytest.approx((0.5, 0.5, 1.0), abs=1e-3)


def test_lines_have_their_width_and_colour(sheet, picture):
    """The line is the sheet's silhouette: the sheet is 2/3 of 32 pixels wide, and its splats half a pixel more."""
    sheet.use_lines, sheet.line_width, sheet.line_color = True, 2.0, (0.0, 0.0, 1.0)
    row = picture()[16]
    is_line = (row[:, 2] > 0.9) & (row[:, 0] < 0.1)
    covered = np.flatnonzero(row[:, 3] > 0.5)
    assert list(np.flatnonzero(is_line)) == [*covered[:2], *covered[-2:]]


def test_a_color_ramp_is_a_textures(sheet, scene, picture):
    """Without light the ramp's left end is seen. Without a texture that is black, the first of three greys."""
    scene.world = None
    sheet.shading = "ramp"
    assert center(picture()) == pytest.approx((0, 0, 0), abs=1e-5)
    texture = bpy.data.textures.new("ramp", "BLEND")
    texture.use_color_ramp = True
    texture.color_ramp.elements[0].color = (0.2, 0.4, 0.8, 1.0)
    sheet.ramp = texture
    assert center(picture()) == pytest.approx((0.2, 0.2, 0.2), abs=1e-3)
    first = ramp_of(texture)
    assert ramp_of(texture) is first
    texture.color_ramp.elements[0].color = (1.0, 0.0, 0.0, 1.0)
    assert ramp_of(texture) is not first and center(picture()) == pytest.approx((1, 0, 0), abs=1e-3)


def test_a_line_over_shallow_angles_and_the_papers_ways_reach_the_renderer(sheet, scene):
    sheet.use_lines, sheet.line_shallow_angle = True, 0.25
    sheet.lights_splats = sheet.culls_backs = sheet.as_printed = True
    sheet.epsilon_length, sheet.filter_variance = 0.25, 0.625
    settings = viewport_settings(scene)
    assert settings.lines.shallow_angle == 0.25
    assert settings.lights_splats and settings.culls_backs and settings.as_printed
    assert (settings.epsilon_length, settings.filter_variance) == (0.25, 0.625)


def test_a_matcap_is_an_image(sheet, picture):
    image = bpy.data.images.new("ball", 8, 8, float_buffer=True)
    image.pixels.foreach_set(np.tile(np.float32((0.5, 1.0, 2.0, 1.0)), 64))
    sheet.shading, sheet.matcap = "matcap", image
    assert center(picture()) == pytest.approx((0.5, 0.5, 0.5), abs=1e-3)


def test_a_painted_matcap_is_another_one_only_where_its_pixels_are():
    """A painted image stays dirty until it is saved; a view refines only if this does not count as a change."""
    image = bpy.data.images.new("ball", 8, 8, float_buffer=True)
    image.pixels.foreach_set(np.full(256, 0.5, np.float32))
    assert image.is_dirty
    first = matcap_of(image)
    assert matcap_of(image) is first
    image.pixels[0] = 0.25
    assert matcap_of(image) is not first


def test_a_matcap_of_another_colour_space_and_a_reloaded_one_are_other_ones(saved_image):
    image = bpy.data.images.load(saved_image("ball.png", (0.6, 0, 0, 1)))
    first = matcap_of(image)
    image.colorspace_settings.name = "Non-Color"
    second = matcap_of(image)
    saved_image("ball.png", (0, 0, 0, 1))
    image.reload()
    doubt()
    third = matcap_of(image)
    doubt()
    assert matcap_of(image) is third
    reds = [matcap.pixels[0, 0, 0] for matcap in (first, second, third)]
    assert reds == pytest.approx([0.319, 0.6, 0], abs=1e-3)


def workbench(scene, light):
    """The colour of a surface that faces the viewer, under a matcap in Workbench without highlights."""
    scene.render.engine = "BLENDER_WORKBENCH"
    shading = scene.display.shading
    shading.light, shading.color_type, shading.single_color = "MATCAP", "SINGLE", (1.0, 0.5, 0.25)
    shading.studio_light, shading.show_specular_highlight = light.name, False


@pytest.mark.parametrize("number", [0, 2, 13])
def test_blenders_own_matcaps_are_what_workbench_shows_without_highlights(number, sheet, scene, picture):
    """The tolerance is a few of the matcap's pixels: Workbench turns the ball's rim, and rounds normals to 8 bits."""
    light = own_matcaps()[number]
    sheet.shading, sheet.matcap = "matcap", bpy.data.images.load(light.path)
    ours = center(picture())
    cube = bpy.data.meshes.new("quad")
    cube.from_pydata([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [], [(0, 1, 2, 3)])
    scene.collection.objects.link(bpy.data.objects.new("quad", cube))
    workbench(scene, light)
    assert ours == pytest.approx(center(picture()), rel=0.02, abs=0.01)


def test_a_multilayer_matcap_whose_first_layer_is_black_is_said(sheet, picture):
    """Blender 5's metal matcaps are such files: they consist of highlights only."""
    lights = [light for light in own_matcaps() if light.name == "metal_bronze.exr"]
    if not lights:
        pytest.skip("this Blender has no such matcap")
    sheet.shading, sheet.matcap = "matcap", bpy.data.images.load(lights[0].path)
    with pytest.raises(RuntimeError, match="whose first layer is black"):
        picture()


def test_a_matcap_that_is_missing_is_said(sheet, picture):
    sheet.shading = "matcap"
    with pytest.raises(RuntimeError, match="Matcap shading needs a picture of a ball"):
        picture()
