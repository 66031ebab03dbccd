# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials become the colours and opacities of surfels, tested on a unit square whose UV map equals x and y."""

from itertools import pairwise

import bpy
import numpy as np
import pytest

from splat_addon.blender.materials.material_surfaces import MeshLayers, material_surface
from splat_addon.blender.materials.surface_textures import has_holes
from splat_addon.blender.materials.texture_images import linear_pixels

TEXELS = 4
ENCODED = np.random.default_rng(3).integers(0, 256, (TEXELS, TEXELS, 4)) / 255


def decoded(encoded):
    """sRGB converted to linear, by a formula written independently of the code under test."""
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


@pytest.fixture
def image():
    """image(values, **settings) -> a generated image that stores these (h, w, 4) values."""

    def make(values=ENCODED, alpha_mode="STRAIGHT", space="sRGB", **settings):
        made = bpy.data.images.new("texture", values.shape[1], values.shape[0], alpha=True, **settings)
        made.alpha_mode, made.colorspace_settings.name = alpha_mode, space
        made.pixels.foreach_set(np.ascontiguousarray(values, np.float32).ravel())
        made.update()
        return made

    return make


class Nodes:
    """The nodes of a material, with shortcuts to connect them."""

    def __init__(self, name="material"):
        self.material = bpy.data.materials.new(name)
        if bpy.app.version < (5, 0, 0):
            self.material.use_nodes = True
        self.tree = self.material.node_tree
        self.principled = self.tree.nodes["Principled BSDF"]

    def add(self, kind, **settings):
        node = self.tree.nodes.new(kind)
        for key, value in settings.items():
            setattr(node, key, value)
        return node

    def link(self, node, output, to, socket):
        self.tree.links.new(next(s for s in node.outputs if s.identifier == output), to.inputs[socket])
        return self

    def texture(self, image):
        return self.add("ShaderNodeTexImage", image=image, interpolation="Closest")


@pytest.fixture
def painted(add_square, convert, surfels_of, world_positions):
    """painted(material, ...) -> (surfels, texel of each) of the square with these materials, 4 x 4 surfels per
    texel.
    """

    def make(*materials, prepare=lambda square: None):
        square = add_square()
        for material in materials:
            square.data.materials.append(material)
        prepare(square)
        made = convert(resolution=4 * TEXELS)[0]
        column, row = np.floor(world_positions(made)[:, :2] * TEXELS).astype(int).T
        return surfels_of(made), (row, column)

    return make


@pytest.mark.parametrize("kind", ["generated", "packed", "file"])
def test_an_srgb_texture_gives_its_linear_texels(image, painted, kind, tmp_path):
    texture = image()
    if kind == "packed":
        texture.pack()
    if kind == "file":
        texture.filepath_raw, texture.file_format = str(tmp_path / "texture.png"), "PNG"
        texture.save()
        texture = bpy.data.images.load(str(tmp_path / "texture.png"))
    texture.alpha_mode = "CHANNEL_PACKED"
    nodes = Nodes()
    nodes.link(nodes.texture(texture), "Color", nodes.principled, "Base Color")
    surfels, texel = painted(nodes.material)
    assert np.allclose(surfels.colors[:, :3], decoded(ENCODED)[texel][:, :3], atol=1e-6)
    assert (surfels.colors[:, 3] == 1).all()


@pytest.mark.parametrize(("settings", "space"), [({}, "Non-Color"), ({"float_buffer": True}, "sRGB")])
def test_data_and_float_textures_are_taken_as_they_are(image, painted, settings, space):
    nodes = Nodes()
    texture = image(alpha_mode="CHANNEL_PACKED", space=space, **settings)
    nodes.link(nodes.texture(texture), "Color", nodes.principled, "Base Color")
    surfels, texel = painted(nodes.material)
    assert np.allclose(surfels.colors[:, :3], ENCODED[texel][:, :3], atol=1e-6)


def test_an_alpha_that_is_linked_is_the_opacity(image, painted):
    nodes = Nodes()
    texture = nodes.texture(image())
    nodes.link(texture, "Color", nodes.principled, "Base Color").link(texture, "Alpha", nodes.principled, "Alpha")
    surfels, texel = painted(nodes.material)
    assert np.allclose(surfels.colors[:, 3], ENCODED[texel][:, 3], atol=1e-6)
    assert np.allclose(surfels.colors[:, :3], decoded(ENCODED)[texel][:, :3], atol=1e-5)


def test_an_alpha_that_is_linked_is_the_opacity_of_a_channel_packed_image_too(image, painted):
    """glTF's importer makes every image channel-packed."""
    nodes = Nodes()
    texture = nodes.texture(image(alpha_mode="CHANNEL_PACKED"))
    nodes.link(texture, "Color", nodes.principled, "Base Color").link(texture, "Alpha", nodes.principled, "Alpha")
    surfels, texel = painted(nodes.material)
    assert np.allclose(surfels.colors[:, 3], ENCODED[texel][:, 3], atol=1e-6)
    assert np.allclose(surfels.colors[:, :3], decoded(ENCODED)[texel][:, :3], atol=1e-5)


def test_an_alpha_that_is_not_linked_darkens_the_colour_as_in_cycles(image, painted):
    nodes = Nodes()
    nodes.link(nodes.texture(image()), "Color", nodes.principled, "Base Color")
    surfels, texel = painted(nodes.material)
    # Cycles multiplies the encoded bytes
    stored = np.rint(255 * ENCODED[..., :3] * ENCODED[..., 3:]) / 255
    assert np.allclose(surfels.colors[:, :3], decoded(stored)[texel], atol=1e-6)
    assert (surfels.colors[:, 3] == 1).all()


#: What Cycles 5.2.3 shows of the bytes (200, 120, 40, 64), as 16 samples of a sun of strength pi on a diffuse surface
#: without specular: alpha mode, packed?, other uses of the alpha? -> red. A premultiplied file is brighter than its
#: alpha; a packed one was divided by Blender, and Cycles does not know that.
CYCLES = {
    ("STRAIGHT", False, False): 0.032,
    ("STRAIGHT", False, True): 0.578,
    ("PREMUL", False, False): 0.578,
    ("PREMUL", False, True): 14.126,
    ("PREMUL", True, False): 1.0,
    ("PREMUL", True, True): 25.081,
    ("CHANNEL_PACKED", False, False): 0.578,
    ("CHANNEL_PACKED", False, True): 0.578,
}


@pytest.mark.parametrize(("mode", "is_packed", "is_apart"), CYCLES)
def test_bytes_with_alpha_are_what_cycles_makes_of_them(image, tmp_path, mode, is_packed, is_apart):
    drawn = image(np.full((2, 2, 4), (200, 120, 40, 64)) / 255, "CHANNEL_PACKED")
    drawn.filepath_raw, drawn.file_format = str(tmp_path / "texture.png"), "PNG"
    drawn.save()
    texture = bpy.data.images.load(str(tmp_path / "texture.png"))
    texture.alpha_mode = mode
    if is_packed:
        texture.pack()
    before = len(bpy.data.images)
    assert linear_pixels(texture, False, is_apart)[0, 0, 0] == pytest.approx(
        CYCLES[mode, is_packed, is_apart], rel=0.02
    )
    assert len(bpy.data.images) == before


def test_the_plain_colour_and_alpha_of_a_material_are_taken(painted):
    nodes = Nodes()
    nodes.principled.inputs["Base Color"].default_value = (0.1, 0.2, 0.3, 1)
    nodes.principled.inputs["Alpha"].default_value = 0.25
    surfels, _ = painted(nodes.material)
    assert np.allclose(surfels.colors, (0.1, 0.2, 0.3, 0.25))


def test_a_uv_map_node_chooses_the_uv_map(image, painted):
    def swap_axes(square):
        square.data.uv_layers.new(name="swapped").uv.foreach_set("vector", [0, 0, 0, 1, 1, 1, 1, 0])

    nodes = Nodes()
    texture = nodes.texture(image(alpha_mode="NONE"))
    nodes.link(texture, "Color", nodes.principled, "Base Color")
    nodes.link(nodes.add("ShaderNodeUVMap", uv_map="swapped"), "UV", texture, "Vector")
    surfels, (row, column) = painted(nodes.material, prepare=swap_axes)
    assert np.allclose(surfels.colors[:, :3], decoded(ENCODED)[column, row][:, :3], atol=1e-6)


def paint(square, color, name="paint"):
    square.data.color_attributes.new(name, "FLOAT_COLOR", "CORNER").data.foreach_set("color", [*color, 1] * 4)


def test_a_full_multiply_of_texture_attribute_and_constant_is_their_product(image, painted):
    nodes = Nodes()
    inner = nodes.add("ShaderNodeMix", data_type="RGBA", blend_type="MULTIPLY")
    outer = nodes.add("ShaderNodeMix", data_type="RGBA", blend_type="MULTIPLY")
    inner.inputs[0].default_value = outer.inputs[0].default_value = 1.0
    outer.inputs[7].default_value = (0.5, 0.25, 1, 1)
    nodes.link(nodes.texture(image(alpha_mode="NONE")), "Color", inner, 6)
    nodes.link(nodes.add("ShaderNodeVertexColor", layer_name="paint"), "Color", inner, 7)
    nodes.link(inner, "Result_Color", outer, 6).link(outer, "Result_Color", nodes.principled, "Base Color")
    surfels, texel = painted(nodes.material, prepare=lambda square: paint(square, (0.5, 1, 0.1)))
    assert np.allclose(surfels.colors[:, :3], decoded(ENCODED)[texel][:, :3] * (0.25, 0.25, 0.1), atol=1e-6)


def test_without_a_material_the_colour_attribute_is_the_colour(painted):
    surfels, _ = painted(prepare=lambda square: paint(square, (0.1, 0.2, 0.3)))
    assert np.allclose(surfels.colors, (0.1, 0.2, 0.3, 1))


def test_without_material_and_attribute_the_colour_is_blenders_grey(painted):
    surfels, _ = painted()
    assert np.allclose(surfels.colors, (0.8, 0.8, 0.8, 1))


def test_a_material_without_attribute_nodes_ignores_the_colour_attribute(painted):
    nodes = Nodes()
    nodes.principled.inputs["Base Color"].default_value = (0.5, 0.5, 0.5, 1)
    surfels, _ = painted(nodes.material, prepare=lambda square: paint(square, (1, 0, 0)))
    assert np.allclose(surfels.colors[:, :3], 0.5)


def test_two_materials_each_use_their_own_layer(add_mesh, convert, surfels_of, world_positions):
    pair = add_mesh("pair", [(x, y, 0) for y in (0, 1) for x in (0, 1, 2)], [(0, 1, 4, 3), (1, 2, 5, 4)])
    for index, (name, color) in enumerate((("red", (1, 0, 0)), ("green", (0, 1, 0)))):
        pair.data.color_attributes.new(name, "FLOAT_COLOR", "CORNER").data.foreach_set("color", [*color, 1] * 8)
        nodes = Nodes(name)
        nodes.link(nodes.add("ShaderNodeVertexColor", layer_name=name), "Color", nodes.principled, "Base Color")
        pair.data.materials.append(nodes.material)
        pair.data.polygons[index].material_index = index
    made = convert(resolution=8)[0]
    surfels, right = surfels_of(made), world_positions(made)[:, 0] > 1
    assert np.array_equal(surfels.materials, right)
    assert np.array_equal(surfels.colors[:, :2], np.stack([~right, right], axis=1))


def particles(nodes, image):
    nodes.link(nodes.add("ShaderNodeParticleInfo"), "Location", nodes.principled, "Base Color")


def without_image(nodes, image):
    nodes.link(nodes.add("ShaderNodeTexImage"), "Color", nodes.principled, "Base Color")


def missing_file(nodes, image):
    texture = bpy.data.images.new("gone", 1, 1)
    texture.source, texture.filepath = "FILE", "//nowhere.png"
    nodes.link(nodes.texture(texture), "Color", nodes.principled, "Base Color")


def missing_uv_map(nodes, image):
    texture = nodes.texture(image())
    nodes.link(texture, "Color", nodes.principled, "Base Color")
    nodes.link(nodes.add("ShaderNodeUVMap", uv_map="nowhere"), "UV", texture, "Vector")


def missing_attribute(nodes, image):
    nodes.link(nodes.add("ShaderNodeVertexColor", layer_name="nowhere"), "Color", nodes.principled, "Base Color")


def ring_of_mappings(nodes, image):
    texture, first, second = nodes.texture(image()), *(nodes.add("ShaderNodeMapping") for _ in range(2))
    nodes.link(texture, "Color", nodes.principled, "Base Color").link(first, "Vector", texture, "Vector")
    nodes.link(second, "Vector", first, "Vector").link(first, "Vector", second, "Vector")


def ring_of_inverters(nodes, image):
    first, second = (nodes.add("ShaderNodeInvert") for _ in range(2))
    nodes.link(first, "Color", nodes.principled, "Base Color")
    nodes.link(second, "Color", first, "Color").link(first, "Color", second, "Color")


def long_chain(nodes, image):
    links = [nodes.add("ShaderNodeMath", operation="ADD") for _ in range(120)]
    for node, following in pairwise(links):
        nodes.link(node, "Value", following, 0)
    nodes.link(links[-1], "Value", nodes.principled, "Base Color")


@pytest.mark.parametrize(
    ("build", "reason"),
    [
        (ring_of_inverters, "Invert Color node in a ring of nodes"),
        (particles, "Particle Info node"),
        (without_image, "without an image"),
        (missing_file, "'gone', which has no pixels"),
        (missing_attribute, "attribute 'nowhere'"),
    ],
)
def test_what_cannot_be_read_falls_back_to_the_sockets_colour_and_is_reported(painted, image, capfd, build, reason):
    nodes = Nodes("odd")
    nodes.principled.inputs["Base Color"].default_value = (0.1, 0.2, 0.3, 1)
    build(nodes, image)
    surfels, _ = painted(nodes.material)
    assert np.allclose(surfels.colors, (0.1, 0.2, 0.3, 1))
    warning = next(line for line in capfd.readouterr().out.splitlines() if line.startswith("Warning"))
    assert "material 'odd'" in warning and reason in warning


@pytest.mark.parametrize(
    ("build", "reason"),
    [(ring_of_mappings, "Mapping node in a ring of nodes"), (missing_uv_map, "UV map 'nowhere'")],
)
def test_an_image_whose_place_cannot_be_read_lies_on_the_uv_map(painted, image, capfd, build, reason):
    nodes, plain = Nodes("odd"), Nodes("plain")
    build(nodes, image)
    plain.link(plain.texture(image()), "Color", plain.principled, "Base Color")
    assert np.allclose(painted(nodes.material)[0].colors, painted(plain.material)[0].colors, atol=1e-6)
    warning = next(line for line in capfd.readouterr().out.splitlines() if line.startswith("Warning"))
    assert "material 'odd'" in warning and reason in warning and "what can be read of its nodes is used" in warning


def test_a_chain_that_is_too_long_is_reported(painted, image, capfd):
    nodes = Nodes("odd")
    long_chain(nodes, image)
    painted(nodes.material)
    assert "a chain of more than 100 nodes" in capfd.readouterr().out


def test_reroutes_in_a_ring_feed_nothing(painted, capfd):
    nodes = Nodes("ring")
    nodes.principled.inputs["Base Color"].default_value = (0.1, 0.2, 0.3, 1)
    first, second = (nodes.add("NodeReroute") for _ in range(2))
    nodes.link(first, "Output", nodes.principled, "Base Color")
    nodes.link(second, "Output", first, 0).link(first, "Output", second, 0)
    assert np.allclose(painted(nodes.material)[0].colors, (0.1, 0.2, 0.3, 1))


def test_a_node_that_takes_its_predecessor_twice_is_read_once(painted):
    """With 40 such nodes there are 2 ** 40 paths, so a reader that follows each path would never end."""
    nodes = Nodes()
    doubled = nodes.add("ShaderNodeValue")
    doubled.outputs[0].default_value = 2.0**-40
    for _ in range(40):
        following = nodes.add("ShaderNodeMath", operation="ADD")
        for socket in (0, 1):
            nodes.link(doubled, "Value", following, socket)
        doubled = following
    nodes.link(doubled, "Value", nodes.principled, "Base Color")
    assert np.allclose(painted(nodes.material)[0].colors, 1)


def test_an_unreadable_alpha_costs_only_the_alpha(painted, image, capfd):
    nodes = Nodes("odd")
    nodes.link(nodes.texture(image(alpha_mode="NONE")), "Color", nodes.principled, "Base Color")
    nodes.link(nodes.add("ShaderNodeCameraData"), "View Distance", nodes.principled, "Alpha")
    surfels, texel = painted(nodes.material)
    assert np.allclose(surfels.colors[:, :3], decoded(ENCODED)[texel][:, :3], atol=1e-6)
    assert "alpha comes from a Camera Data node" in capfd.readouterr().out


def test_a_material_in_a_slot_that_no_face_uses_is_not_complained_about(painted, image, capfd):
    nodes = Nodes("unused")
    particles(nodes, image)
    painted(Nodes("used").material, nodes.material)
    assert "Warning" not in capfd.readouterr().out


def leaf(image, covers="SECOND", color=(1, 1, 1, 1)):
    """The nodes of a leaf card, whose image's alpha mixes it with a Transparent BSDF, and its Mix Shader."""
    nodes = Nodes()
    texture, mix = nodes.texture(image()), nodes.add("ShaderNodeMixShader")
    clear = nodes.add("ShaderNodeBsdfTransparent")
    clear.inputs["Color"].default_value = color
    nodes.link(texture, "Color", nodes.principled, "Base Color").link(texture, "Alpha", mix, 0)
    first, second = (clear, nodes.principled) if covers == "SECOND" else (nodes.principled, clear)
    nodes.link(first, "BSDF", mix, 1).link(second, "BSDF", mix, 2)
    return nodes.link(mix, "Shader", nodes.tree.get_output_node("ALL"), "Surface"), mix


@pytest.mark.parametrize("covers", ["FIRST", "SECOND"])
def test_a_mix_with_a_transparent_shader_is_opacity(image, painted, covers):
    nodes, _ = leaf(image, covers)
    nodes.principled.inputs["Alpha"].default_value = 0.5
    surfels, texel = painted(nodes.material)
    share = ENCODED[texel][:, 3] if covers == "SECOND" else 1 - ENCODED[texel][:, 3]
    assert np.allclose(surfels.colors[:, 3], 0.5 * share, atol=1e-6)


def test_a_leaf_card_has_the_holes_of_its_image(image, add_square):
    nodes, _ = leaf(image)
    square = add_square()
    surface, unread = material_surface(nodes.material, MeshLayers(square.data))
    assert not unread
    assert has_holes(surface)


def test_a_constant_share_is_opacity(painted):
    nodes = Nodes()
    mix, clear = nodes.add("ShaderNodeMixShader"), nodes.add("ShaderNodeBsdfTransparent")
    mix.inputs[0].default_value = 0.25
    nodes.principled.inputs["Base Color"].default_value = (0.1, 0.2, 0.3, 1)
    nodes.link(clear, "BSDF", mix, 1).link(nodes.principled, "BSDF", mix, 2)
    nodes.link(mix, "Shader", nodes.tree.get_output_node("ALL"), "Surface")
    surfels, _ = painted(nodes.material)
    assert np.allclose(surfels.colors, (0.1, 0.2, 0.3, 0.25))


def test_a_tinted_transparent_shader_is_no_hole(image, add_square):
    nodes, _ = leaf(image, color=(1, 0.5, 0.5, 1))
    surface, unread = material_surface(nodes.material, MeshLayers(add_square().data))
    assert not unread and not has_holes(surface) and surface.opacity.factors


def test_what_cannot_be_read_in_a_mix_is_reported(image, add_square):
    nodes, mix = leaf(image)
    nodes.link(nodes.add("ShaderNodeWireframe"), "Fac", mix, 0)
    _, unread = material_surface(nodes.material, MeshLayers(add_square().data))
    assert {what.reason for what in unread} == {"a Wireframe node"}
