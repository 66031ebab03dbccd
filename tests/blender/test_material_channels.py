# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels read roughness, metallic, emission, alpha and normals from materials built as importers build them."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.meshes.mesh_extraction import read_mesh
from splat_addon.sampling.attributes.tangents import corner_tangents

TEXELS = 4
ENCODED = np.random.default_rng(5).integers(0, 256, (TEXELS, TEXELS, 4)) / 255


class Nodes:
    """The nodes of a material, with shortcuts to connect them."""

    def __init__(self):
        self.material = bpy.data.materials.new("material")
        if bpy.app.version < (5, 0, 0):
            self.material.use_nodes = True
        self.tree = self.material.node_tree
        self.inputs = self.tree.nodes["Principled BSDF"].inputs

    def add(self, kind, inputs=None, **settings):
        node = self.tree.nodes.new(kind)
        for key, value in settings.items():
            setattr(node, key, value)
        for key, value in (inputs or {}).items():
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, node.inputs[key])
            else:
                node.inputs[key].default_value = value
        return node

    def link(self, output, name):
        self.tree.links.new(output, self.inputs[name])

    def texture(self, values=ENCODED, space="Non-Color", alpha_mode="CHANNEL_PACKED", vector=None, **settings):
        image = bpy.data.images.new("texture", values.shape[1], values.shape[0], alpha=True, float_buffer=False)
        image.alpha_mode, image.colorspace_settings.name = alpha_mode, space
        image.pixels.foreach_set(np.ascontiguousarray(values, np.float32).ravel())
        image.update()
        inputs = {} if vector is None else {"Vector": vector}
        return self.add("ShaderNodeTexImage", inputs, image=image, interpolation="Closest", **settings)

    def component(self, output, name):
        return self.add("ShaderNodeSeparateColor", {0: output}).outputs[name]

    def math(self, operation, a, b, **settings):
        return self.add("ShaderNodeMath", {0: a, 1: b}, operation=operation, **settings).outputs[0]


@pytest.fixture
def nodes():
    return Nodes()


@pytest.fixture
def made(add_square, convert, surfels_of, world_positions):
    """made(nodes) -> (surfels, texel of each) of the unit square with this material, 4 x 4 surfels per texel."""

    def make(nodes, prepare=lambda square: None):
        square = add_square()
        square.data.materials.append(nodes.material)
        prepare(square)
        made = convert(resolution=4 * TEXELS)[0]
        column, row = np.floor(world_positions(made)[:, :2] * TEXELS).astype(int).T
        return surfels_of(made), (row, column)

    return make


def test_metallic_and_roughness_are_blue_and_green_times_their_factors(nodes, made, capfd):
    color = nodes.texture().outputs["Color"]
    nodes.link(nodes.math("MULTIPLY", nodes.component(color, "Blue"), 0.5), "Metallic")
    nodes.link(nodes.component(color, "Green"), "Roughness")
    surfels, texel = made(nodes)
    assert np.allclose(surfels.metallic, 0.5 * ENCODED[texel][:, 2], atol=1e-6)
    assert np.allclose(surfels.roughness, ENCODED[texel][:, 1], atol=1e-6)
    assert surfels.emission is None
    assert "Warning" not in capfd.readouterr().out


def test_emission_is_its_colour_times_its_strength(nodes, made):
    nodes.link(nodes.texture().outputs["Color"], "Emission Color")
    nodes.inputs["Emission Strength"].default_value = 7.0
    surfels, texel = made(nodes)
    assert np.allclose(surfels.emission, 7 * ENCODED[texel][:, :3], atol=1e-5)


def test_an_emission_texture_of_no_strength_is_not_looked_up(nodes, made):
    nodes.link(nodes.texture().outputs["Color"], "Emission Color")
    nodes.inputs["Emission Strength"].default_value = 0.0
    assert made(nodes)[0].emission is None


def test_plain_sockets_add_no_fields(nodes, made):
    nodes.inputs["Roughness"].default_value, nodes.inputs["Metallic"].default_value = 0.9, 1.0
    nodes.inputs["Emission Strength"].default_value = 2.0
    surfels, _ = made(nodes)
    assert surfels.roughness is None and surfels.metallic is None and surfels.emission is None


def test_a_colour_on_a_number_socket_is_its_luminance(nodes, made):
    nodes.link(nodes.texture().outputs["Color"], "Roughness")
    surfels, texel = made(nodes)
    assert np.allclose(surfels.roughness, ENCODED[texel][:, :3] @ (0.2126, 0.7152, 0.0722), atol=1e-4)


def test_gloss_becomes_roughness_pixel_by_pixel(nodes, made):
    green = nodes.component(nodes.texture().outputs["Color"], "Green")
    nodes.link(nodes.math("SUBTRACT", 1.0, nodes.math("POWER", green, 2.0)), "Roughness")
    surfels, texel = made(nodes)
    assert np.allclose(surfels.roughness, 1 - ENCODED[texel][:, 1] ** 2, atol=1e-6)


def test_an_inverted_colour_is_read(nodes, made):
    nodes.link(nodes.add("ShaderNodeInvert", {1: nodes.texture().outputs["Color"]}).outputs[0], "Base Color")
    surfels, texel = made(nodes)
    assert np.allclose(surfels.colors[:, :3], 1 - ENCODED[texel][:, :3], atol=1e-6)


def ramp(nodes, number, *stops, interpolation="LINEAR"):
    """A Color Ramp over a number; stops: (place, colour)."""
    node = nodes.add("ShaderNodeValToRGB", {0: number})
    node.color_ramp.interpolation = interpolation
    for element, (place, color) in zip(node.color_ramp.elements, stops, strict=True):
        element.position, element.color = place, color
    return node


BLACK, WHITE = (0, 0, 0, 1), (1, 1, 1, 1)


@pytest.mark.parametrize(("interpolation", "slope"), [("LINEAR", 5.0), ("CONSTANT", 1e9)])
def test_a_ramp_of_an_images_alpha_is_its_alpha(nodes, made, interpolation, slope):
    """Leaf cards sharpen their alpha so; before ramps were read, such a card was an opaque square."""
    texture = nodes.texture(alpha_mode="STRAIGHT")
    nodes.link(texture.outputs["Color"], "Base Color")
    sharp = ramp(nodes, texture.outputs["Alpha"], (0.4, BLACK), (0.6, WHITE), interpolation=interpolation)
    nodes.link(sharp.outputs["Color"], "Alpha")
    surfels, texel = made(nodes)
    start = 0.4 if interpolation == "LINEAR" else 0.6
    assert np.allclose(surfels.colors[:, 3], np.clip((ENCODED[texel][:, 3] - start) * slope, 0, 1), atol=0.02)


@pytest.mark.parametrize(("is_used", "rim"), [(True, 1.0), (False, 0.214)])
def test_beside_a_sharpened_alpha_the_colour_is_not_darkened_by_alpha(nodes, made, is_used, rim):
    """Cycles divides the colour by the alpha if anything uses the alpha; without that, cards had dark rims."""
    values = np.ones((TEXELS, TEXELS, 4))
    values[:2, :, 3], values[0, :, :3], values[0, :, 3] = 0.5, 0, 0
    texture = nodes.texture(values, "sRGB", "STRAIGHT")
    nodes.link(texture.outputs["Color"], "Base Color")
    if is_used:
        nodes.link(nodes.math("GREATER_THAN", texture.outputs["Alpha"], -1.0), "Alpha")
    surfels, (row, _) = made(nodes)
    assert np.allclose(surfels.colors[row >= 2, :3], 1)
    assert np.allclose(surfels.colors[row == 1, :3], rim, atol=0.01)
    assert np.allclose(surfels.colors[row == 0, :3], 1.0 if is_used else 0.0, atol=0.01)


def test_data_are_not_multiplied_by_alpha(nodes, made):
    nodes.link(nodes.texture(alpha_mode="STRAIGHT").outputs["Color"], "Base Color")
    surfels, texel = made(nodes)
    assert np.allclose(surfels.colors[:, :3], ENCODED[texel][:, :3], atol=1e-5)


def test_a_ramp_colours_a_number(nodes, made):
    texture = nodes.texture()
    colored = ramp(nodes, texture.outputs["Alpha"], (0, (1, 0, 0, 0)), (1, (0, 0.5, 1, 1)))
    nodes.link(colored.outputs["Color"], "Base Color")
    nodes.link(colored.outputs["Alpha"], "Roughness")
    surfels, texel = made(nodes)
    number = ENCODED[texel][:, 3:]
    assert np.allclose(surfels.colors[:, :3], (1 - number) * (1, 0, 0) + number * (0, 0.5, 1), atol=1e-5)
    assert np.allclose(surfels.roughness, number[:, 0], atol=1e-5)


@pytest.mark.parametrize("interpolation", ["LINEAR", "SMOOTHSTEP"])
def test_a_mapped_range_is_read(nodes, made, interpolation):
    alpha, limits = nodes.texture().outputs["Alpha"], {1: 0.2, 2: 0.7, 3: 0.9, 4: 0.1}
    node = nodes.add("ShaderNodeMapRange", {0: alpha, **limits}, interpolation_type=interpolation)
    nodes.link(nodes.add("ShaderNodeClamp", {0: node.outputs[0], 1: 0.2, 2: 0.8}).outputs[0], "Roughness")
    surfels, texel = made(nodes)
    place = np.clip((ENCODED[texel][:, 3] - 0.2) / 0.5, 0, 1)
    eased = place if interpolation == "LINEAR" else place * place * (3 - 2 * place)
    assert np.allclose(surfels.roughness, np.clip(0.9 - 0.8 * eased, 0.2, 0.8), atol=1e-5)


def test_an_alpha_that_is_cut_off_as_in_gltf_covers_the_share_of_its_pixels(nodes, made, add_square):
    """The importer computes 1 - (alpha < 0.5). A single surfel on the whole image gets the mean of that."""
    texture = nodes.texture(alpha_mode="STRAIGHT")
    nodes.link(texture.outputs["Color"], "Base Color")
    nodes.link(nodes.math("SUBTRACT", 1.0, nodes.math("LESS_THAN", texture.outputs["Alpha"], 0.5)), "Alpha")
    surfels, texel = made(nodes)
    assert np.array_equal(surfels.colors[:, 3], ENCODED[texel][:, 3] >= 0.5)


def test_alpha_of_another_image_and_of_vertex_colours_multiply(nodes, made):
    def paint(square):
        square.data.color_attributes.new("paint", "FLOAT_COLOR", "CORNER").data.foreach_set("color", [1, 0, 0, 0.5] * 4)

    paint_node = nodes.add("ShaderNodeVertexColor", layer_name="paint")
    other = nodes.texture()
    nodes.link(nodes.math("MULTIPLY", other.outputs["Color"], paint_node.outputs["Alpha"]), "Alpha")
    nodes.link(paint_node.outputs["Color"], "Base Color")
    surfels, texel = made(nodes, paint)
    luminance = ENCODED[texel][:, :3] @ (0.2126, 0.7152, 0.0722)
    assert np.allclose(surfels.colors[:, 3], 0.5 * luminance, atol=1e-4)
    assert np.allclose(surfels.colors[:, :3], (1, 0, 0))


def test_a_grey_of_one_component_keeps_the_alpha_of_its_image(nodes, made):
    texture = nodes.texture()
    nodes.link(nodes.component(texture.outputs["Color"], "Green"), "Base Color")
    nodes.link(texture.outputs["Alpha"], "Alpha")
    surfels, texel = made(nodes)
    assert np.allclose(surfels.colors[:, :3], ENCODED[texel][:, 1:2], atol=1e-5)
    assert np.allclose(surfels.colors[:, 3], ENCODED[texel][:, 3], atol=1e-5)


def attribute(square, kind, domain, key, values):
    made = square.data.attributes.new("given", kind, domain)
    made.data.foreach_set(key, np.ravel(values).astype(np.float32))


def test_a_number_of_each_face_drives_the_roughness(nodes, made):
    nodes.link(nodes.add("ShaderNodeAttribute", attribute_name="given").outputs["Fac"], "Roughness")
    surfels, _ = made(nodes, lambda square: attribute(square, "FLOAT", "FACE", "value", [0.375]))
    assert np.allclose(surfels.roughness, 0.375)


#: What Cycles renders of a colour as a number, in Blender 5.2 and in 4.5.
LUMINANCE = 0.44382194 if hasattr(bpy.data, "colorspace") else 0.44380111


@pytest.mark.parametrize(("output", "value"), [(2, 0.5), (0, LUMINANCE)])
def test_the_factor_of_a_colour_is_its_mean_and_the_colour_as_a_number_its_luminance(nodes, made, output, value):
    nodes.link(nodes.add("ShaderNodeAttribute", attribute_name="given").outputs[output], "Roughness")
    surfels, _ = made(nodes, lambda square: attribute(square, "FLOAT_VECTOR", "POINT", "vector", [(0.1, 0.5, 0.9)] * 4))
    assert np.allclose(surfels.roughness, value, atol=1e-6)


@pytest.mark.parametrize("kind", ["POINT", "TEXTURE"])
def test_a_mapping_node_places_the_texture(nodes, made, kind):
    """The mapping is a quarter turn about the corner and a shift up by one image, (u, v) -> (-v, u), or its inverse."""
    uv = nodes.add("ShaderNodeUVMap", uv_map="UVMap").outputs[0]
    mapping = nodes.add("ShaderNodeMapping", {"Vector": uv, "Rotation": (0, 0, np.pi / 2)}, vector_type=kind)
    nodes.link(nodes.texture(vector=mapping.outputs[0]).outputs["Color"], "Base Color")
    surfels, (row, column) = made(nodes)
    turned = ENCODED[column, -1 - row] if kind == "POINT" else ENCODED[-1 - column, row]
    assert np.allclose(surfels.colors[:, :3], turned[:, :3], atol=1e-5)


@pytest.mark.parametrize(("operation", "numbers"), [("WRAP", (0.0, 1.0)), ("PINGPONG", (1.0,))])
def test_a_texture_repeats_along_one_side_alone_as_gltf_has_it(nodes, made, operation, numbers):
    """The coordinates are shifted by one and a half images both ways: u is wrapped, v is clamped to the upper edge."""
    uv = nodes.add("ShaderNodeUVMap", uv_map="UVMap").outputs[0]
    moved = nodes.add("ShaderNodeMapping", {"Vector": uv, "Location": (1.5, 1.5, 0)}).outputs[0]
    separate = nodes.add("ShaderNodeSeparateXYZ", {0: moved})
    given = {0: separate.outputs["X"], **{k + 1: number for k, number in enumerate(numbers)}}
    wrapped = nodes.add("ShaderNodeMath", given, operation=operation).outputs[0]
    vector = nodes.add("ShaderNodeCombineXYZ", {"X": wrapped, "Y": separate.outputs["Y"]}).outputs[0]
    nodes.link(nodes.texture(vector=vector, extension="EXTEND").outputs["Color"], "Base Color")
    surfels, (_, column) = made(nodes)
    of_image = np.arange(6, 10) % 8
    of_image = of_image % 4 if operation == "WRAP" else np.minimum(of_image, 7 - of_image)
    assert np.allclose(surfels.colors[:, :3], ENCODED[-1, of_image[column]][:, :3], atol=1e-5)


def normal_map(nodes, normal, **settings):
    encoded = np.append((np.array(normal) + 1) / 2, 1)
    texture = nodes.texture(np.broadcast_to(encoded, (2, 2, 4)))
    node = nodes.add("ShaderNodeNormalMap", {"Color": texture.outputs["Color"]}, **settings)
    nodes.link(node.outputs["Normal"], "Normal")
    return node


def test_a_normal_map_tilts_the_shading_normal_alone(nodes, made):
    normal_map(nodes, (0.6, 0.0, 0.8), uv_map="UVMap")
    surfels, _ = made(nodes)
    assert np.allclose(surfels.normals, (0.6, 0, 0.8), atol=5e-3)
    assert np.allclose(surfels.geometric_normals(), (0, 0, 1), atol=1e-6)


def test_its_strength_is_taken(nodes, made):
    normal_map(nodes, (0.6, 0.0, 0.8)).inputs["Strength"].default_value = 0.0
    assert np.allclose(made(nodes)[0].normals, (0, 0, 1), atol=1e-6)


@pytest.mark.parametrize(
    ("wire", "said"),
    [
        (lambda n: n.link(n.add("ShaderNodeBevel").outputs[0], "Normal"), "normal comes from a Bevel node"),
        (lambda n: n.link(n.add("ShaderNodeWireframe").outputs[0], "Roughness"), "roughness comes from a Wireframe"),
        (
            lambda n: n.link(n.add("ShaderNodeParticleInfo").outputs["Location"], "Emission Color"),
            "emission comes from a Particle Info",
        ),
        (
            lambda n: n.link(n.math("LESS_THAN", n.add("ShaderNodeVertexColor").outputs[1], 0.5), "Alpha"),
            "the attribute ''",
        ),
        (lambda n: normal_map(n, (0, 0, 1), space="WORLD"), "normal comes from a normal map in world space"),
        (lambda n: normal_map(n, (0, 0, 1), uv_map="nowhere"), "UV map 'nowhere'"),
    ],
)
def test_what_cannot_be_read_is_said(nodes, made, capfd, wire, said):
    nodes.inputs["Emission Strength"].default_value = 1.0
    wire(nodes)
    surfels, _ = made(nodes)
    assert np.allclose(surfels.normals, (0, 0, 1), atol=1e-6)
    assert said in next(line for line in capfd.readouterr().out.splitlines() if line.startswith("Warning"))


def test_tangents_are_those_of_blender():
    bpy.ops.mesh.primitive_monkey_add()
    monkey = bpy.context.object
    bpy.ops.object.modifier_add(type="TRIANGULATE")
    bpy.ops.object.modifier_apply(modifier="Triangulate")
    mesh = monkey.data
    for polygon in mesh.polygons:
        polygon.use_smooth = polygon.index % 3 > 0
    nodes = Nodes()
    normal_map(nodes, (0, 0, 1))
    mesh.materials.append(nodes.material)
    mesh.calc_tangents()
    values = np.empty((len(mesh.loops), 3), np.float32)
    mesh.loops.foreach_get("tangent", values.ravel())
    signs = np.empty(len(mesh.loops), np.float32)
    mesh.loops.foreach_get("bitangent_sign", signs)
    evaluated = monkey.evaluated_get(bpy.context.evaluated_depsgraph_get())
    triangles = read_mesh(evaluated, evaluated.data).triangles
    tangents = corner_tangents(triangles, triangles.corner_uvs).reshape(-1, 4)
    (du1, dv1), (du2, dv2) = ((triangles.corner_uvs[:, k] - triangles.corner_uvs[:, 0]).T for k in (1, 2))
    with_area = np.repeat(du1 * dv2 != du2 * dv1, 3)
    assert np.array_equal(tangents[with_area, 3], signs[with_area]) and (signs < 0).any()
    degrees = np.degrees(np.arccos(np.clip((tangents[:, :3] * values).sum(axis=1), -1, 1)))
    assert np.quantile(degrees, 0.98) < 0.05
