# SPDX-License-Identifier: GPL-3.0-or-later
"""Texture-mapped surfels in Blender are converted, stored, and rendered with the current state of the image."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.engine import final_render

TEXELS, SIZE = 8, 32
#: The pixels in the middles of the texels.
MIDDLES = np.s_[2 :: SIZE // TEXELS, 2 :: SIZE // TEXELS]


def random_pixels(seed=1):
    """(8, 8, 4) random linear values."""
    pixels = np.random.default_rng(seed).uniform(0.05, 0.95, (TEXELS, TEXELS, 4)).astype(np.float32)
    pixels[..., 3] = 1
    return pixels


def paint(image, pixels):
    image.pixels.foreach_set(np.ascontiguousarray(pixels, np.float32).ravel())
    image.update()


def pixels_of(image):
    """The image's (8, 8, 3) pixels in Blender; 4.5 encodes a generated float image when saving it."""
    pixels = np.empty(TEXELS * TEXELS * 4, np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(TEXELS, TEXELS, 4)[..., :3]


@pytest.fixture
def image():
    """A generated float image, which stores linear values."""
    made = bpy.data.images.new("texture", TEXELS, TEXELS, alpha=True, float_buffer=True)
    paint(made, random_pixels())
    return made


def textured_material(image, interpolation="Closest", tint=None):
    """A Principled material whose base colour is the image, or its product with a tint."""
    material = bpy.data.materials.new("textured")
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    texture = nodes.new("ShaderNodeTexImage")
    texture.image, texture.interpolation = image, interpolation
    output = texture.outputs["Color"]
    if tint is not None:
        mix = nodes.new("ShaderNodeMix")
        mix.data_type, mix.blend_type = "RGBA", "MULTIPLY"
        mix.inputs[0].default_value = 1.0
        mix.inputs[7].default_value = (*tint, 1.0)
        links.new(output, mix.inputs[6])
        output = mix.outputs[2]
    links.new(output, nodes["Principled BSDF"].inputs["Base Color"])
    return material


@pytest.fixture
def add_textured(scene, add_camera, add_square, convert):
    """add_textured(material, ...) -> 4 x 4 surfels of a square with these materials, seen from above."""
    add_camera(location=(0.5, 0.5, 5), type="ORTHO", ortho_scale=1.0)

    def add(*materials, resolution=4, **settings):
        square = add_square()
        for material in materials:
            square.data.materials.append(material)
        (made,) = convert(resolution=resolution, texture_mapped=True, source="HIDE", **settings)
        return made

    return add


def test_sixteen_surfels_show_sixty_four_texels(add_textured, image, picture):
    surfels = add_textured(textured_material(image))
    assert len(surfels.data.vertices) == 16
    assert np.allclose(picture()[MIDDLES][..., :3], random_pixels()[..., :3], atol=2e-3)


def test_the_constant_multiplies(add_textured, image, picture):
    add_textured(textured_material(image, tint=(0.5, 1.0, 0.25)))
    assert np.allclose(picture()[MIDDLES][..., :3], random_pixels()[..., :3] * (0.5, 1, 0.25), atol=2e-3)


def test_a_smooth_texture_is_what_cycles_shows(scene, add_textured, image, picture, passes, switch_to_cycles):
    """The comparison is with Cycles' colour pass and box-filtered pixels.

    The material has no coat, which would absorb some colour.
    """
    material = textured_material(image, "Linear")
    material.node_tree.nodes["Principled BSDF"].inputs["Specular IOR Level"].default_value = 0.0
    surfels = add_textured(material)
    scene.surfel_splatting.supersampling = 4
    drawn = picture()[..., :3]
    surfels.hide_render, bpy.data.objects["Square"].hide_render = True, False
    switch_to_cycles(samples=64, filter_width=1.0)
    scene.cycles.pixel_filter_type = "BOX"
    bpy.context.view_layer.use_pass_diffuse_color = True
    names = ("ViewLayer.Diffuse Color", "ViewLayer.DiffCol")
    (colors,) = (values for name, values in passes().items() if name in names)
    inside = np.s_[2:-2, 2:-2]
    assert np.abs(drawn[inside] - colors[inside][..., :3]).max() < 0.02


def test_a_painted_and_an_exchanged_image_show_in_the_next_render(add_textured, image, picture):
    material = textured_material(image)
    add_textured(material)
    picture()
    paint(image, random_pixels(2))
    assert np.allclose(picture()[MIDDLES][..., :3], random_pixels(2)[..., :3], atol=2e-3)
    other = bpy.data.images.new("other", TEXELS, TEXELS, float_buffer=True)
    paint(other, random_pixels(3))
    next(n for n in material.node_tree.nodes if n.type == "TEX_IMAGE").image = other
    assert np.allclose(picture()[MIDDLES][..., :3], random_pixels(3)[..., :3], atol=2e-3)


def test_a_reloaded_file_shows(add_textured, image, picture, tmp_path):
    path = str(tmp_path / "texture.exr")
    image.filepath_raw, image.file_format = path, "OPEN_EXR"
    image.save()
    loaded = bpy.data.images.load(path)
    add_textured(textured_material(loaded))
    before = picture()[MIDDLES][..., :3]
    assert np.allclose(before, pixels_of(loaded), atol=2e-3)
    paint(image, random_pixels(2))
    image.save()
    loaded.reload()
    after = picture()[MIDDLES][..., :3]
    assert np.allclose(after, pixels_of(loaded), atol=2e-3) and not np.allclose(before, after, atol=0.1)


def test_every_slot_has_its_own_image(scene, add_camera, add_mesh, convert, picture):
    """Two faces side by side have images, a third one has none."""
    add_camera(location=(0.5, 0.5, 5), type="ORTHO", ortho_scale=1.0)
    corners = [(x / 3, y, 0) for x in range(4) for y in (0, 1)]
    board = add_mesh("board", corners, [(2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1) for k in range(3)])
    uvs = board.data.uv_layers.new(name="UVMap")
    uvs.uv.foreach_set("vector", [0, 0, 1, 0, 1, 1, 0, 1] * 3)
    images = []
    for color in ((0.8, 0.1, 0.1, 1), (0.1, 0.1, 0.8, 1)):
        made = bpy.data.images.new("plain", 2, 2, float_buffer=True)
        paint(made, np.tile(np.float32(color), (2, 2, 1)))
        images.append(made)
    plain = bpy.data.materials.new("plain")
    if bpy.app.version < (5, 0, 0):
        plain.use_nodes = True
    plain.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.1, 0.7, 0.1, 1)
    for slot, material in enumerate((*map(textured_material, images), plain)):
        board.data.materials.append(material)
        board.data.polygons[slot].material_index = slot
    convert(resolution=12, texture_mapped=True, source="HIDE")
    row = picture()[16, [5, 16, 27], :3]
    assert np.allclose(row, [(0.8, 0.1, 0.1), (0.1, 0.1, 0.8), (0.1, 0.7, 0.1)], atol=2e-3)


def test_a_missing_image_is_said_and_the_stored_colours_show(add_textured, image, picture, said):
    material = textured_material(image)
    surfels = add_textured(material)
    stored = np.empty(64, np.float32)
    surfels.data.attributes["Col"].data.foreach_get("color", stored)
    missing = bpy.data.images.new("gone", 4, 4)
    missing.source, missing.filepath = "FILE", "/nowhere/gone.png"
    next(n for n in material.node_tree.nodes if n.type == "TEX_IMAGE").image = missing
    drawn = picture()
    assert "has no pixels (is its file missing?); its texture-mapped surfels show the colours" in said()
    colors = stored.reshape(16, 4)[:, :3]
    assert (drawn[16, 16, :3] >= colors.min(axis=0) - 1e-4).all() and (
        drawn[16, 16, :3] <= colors.max(axis=0) + 1e-4
    ).all()
    assert not np.allclose(drawn[MIDDLES][..., :3], random_pixels()[..., :3], atol=0.1)


def test_an_animation_reads_an_unchanged_image_once(scene, add_textured, tmp_path, monkeypatch):
    path = tmp_path / "texture.exr"
    image = bpy.data.images.new("kept", TEXELS, TEXELS, float_buffer=True)
    paint(image, random_pixels())
    image.filepath_raw, image.file_format = str(path), "OPEN_EXR"
    image.save()
    add_textured(textured_material(bpy.data.images.load(str(path))))
    from splat_addon.blender.materials import mesh_layers

    reads, original = [], mesh_layers.linear_pixels
    monkeypatch.setattr(mesh_layers, "linear_pixels", lambda *a: reads.append(a[0].name) or original(*a))
    scene.frame_start, scene.frame_end, scene.render.filepath = 1, 3, str(tmp_path / "frame")
    bpy.ops.render.render(animation=True)
    assert len(list(tmp_path.glob("frame*"))) == 3 and len(reads) == 1


def test_the_plan_says_what_is_looked_up(add_textured, image, picture):
    add_textured(textured_material(image))
    picture()
    assert "1 of 1 instances look textures up" in str(final_render.last_frame_stats["plan"])
    assert not final_render.last_frame_stats["notes"]


@pytest.fixture
def live_square(scene, add_camera, add_square, image):
    """The unconverted square, rendered as 4 x 4 texture-mapped surfels."""
    add_camera(location=(0.5, 0.5, 5), type="ORTHO", ortho_scale=1.0)
    square = add_square()
    square.data.materials.append(textured_material(image))
    scene.surfel_splatting.render_meshes, scene.surfel_splatting.mesh_textures = "SURFELS", True
    scene.surfel_splatting.mesh_resolution = 4
    return square


def test_a_mesh_that_is_rendered_as_surfels_shows_its_texture(live_square, scene, image, picture):
    assert np.allclose(picture()[MIDDLES][..., :3], random_pixels()[..., :3], atol=2e-3)
    paint(image, random_pixels(2))
    assert np.allclose(picture()[MIDDLES][..., :3], random_pixels(2)[..., :3], atol=2e-3)
    scene.surfel_splatting.mesh_textures = False
    assert not np.allclose(picture()[MIDDLES][..., :3], random_pixels(2)[..., :3], atol=0.1)


def test_the_texture_follows_a_mesh_that_deforms(live_square, scene, image, tmp_path, read_picture):
    """Shearing changes the axes of the ellipses; undoing it gives the first frame's picture again."""
    live_square.shape_key_add(name="Basis")
    key = live_square.shape_key_add(name="Key")
    for point, x in zip(key.data, (0.0, 1.0, 1.4, 0.4), strict=True):
        point.co.x = x
    for frame, value in ((1, 0.0), (2, 1.0), (3, 0.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    scene.frame_start, scene.frame_end, scene.render.filepath = 1, 3, str(tmp_path / "frame_####.exr")
    bpy.ops.render.render(animation=True)
    assert final_render.last_frame_stats["live_meshes"]["followed"] == 1
    first, second, third = (read_picture(tmp_path / f"frame_000{k}.exr") for k in (1, 2, 3))
    assert np.allclose(first, third, atol=1e-4)
    # a sheared texel of the middle row: the point (u, v) lies at x = u + 0.4 v
    for column in range(3):
        u, v = (column + 0.5) / TEXELS, 3.5 / TEXELS
        pixel = second[int(v * SIZE), int((u + 0.4 * v) * SIZE), :3]
        assert np.allclose(pixel, random_pixels()[3, column, :3], atol=5e-3)


def test_a_viewport_reads_an_image_again_only_where_it_is_told(image):
    """A painted image stays dirty until it is saved, so every move of an object would otherwise read it again."""
    from splat_addon.blender.export.notes import Notes
    from splat_addon.blender.materials.surface_textures import TextureStore

    material, store, seen = textured_material(image), TextureStore(), []
    for is_edited in (False, False, True, True):
        store.begin_frame(is_edited, is_told=True)
        seen.append(store.get(material, Notes()))
        paint(image, random_pixels(2))
    assert image.is_dirty
    assert seen[0] is seen[1] and seen[1] is not seen[2] and seen[2] is seen[3]
    assert np.allclose(seen[2].image.pixels, random_pixels(2), atol=1e-6)


@pytest.mark.parametrize("shader", ["ShaderNodeEmission", "ShaderNodeBsdfGlass", "ShaderNodeMixShader"])
def test_a_shader_without_a_base_colour_leaves_the_stored_colours(add_textured, image, picture, shader):
    material = textured_material(image)
    add_textured(material).parent = None  # what follows no source is a frozen copy
    nodes, links = material.node_tree.nodes, material.node_tree.links
    output = next(n for n in nodes if n.type == "OUTPUT_MATERIAL")
    links.new(nodes.new(shader).outputs[0], output.inputs["Surface"])
    drawn = picture()[MIDDLES][..., :3]
    assert drawn.any() and not np.allclose(drawn, random_pixels()[..., :3], atol=0.1)


def test_a_conversion_without_images_says_that_nothing_is_texture_mapped(add_square, convert, said):
    add_square()
    (made,) = convert(resolution=4, texture_mapped=True)
    assert "No base colour is one image times a constant, so no surfel is texture-mapped" in said()
    assert "uv" not in made.data.attributes


def test_each_of_several_materials_keeps_its_texture_from_frame_to_frame(add_square, image):
    """A texture that is the same object stays on the device. In a render, materials are evaluated."""
    from splat_addon.blender.export.notes import Notes
    from splat_addon.blender.materials.surface_textures import TextureStore

    for tint in (None, (0.5, 0.5, 0.5)):
        add_square().data.materials.append(textured_material(image, tint=tint))
    depsgraph = bpy.context.evaluated_depsgraph_get()
    evaluated = [each.evaluated_get(depsgraph).material_slots[0].material for each in bpy.context.scene.objects]
    store, frames = TextureStore(), []
    for _ in range(2):
        store.begin_frame(is_edited=False, is_told=True)
        frames.append([store.get(material, Notes()) for material in evaluated])
    assert frames[0][0] is not frames[0][1]
    assert all(first is second for first, second in zip(*frames, strict=True))
