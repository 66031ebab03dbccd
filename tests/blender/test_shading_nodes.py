# SPDX-License-Identifier: GPL-3.0-or-later
"""Node chains have the values that Cycles gives them."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.materials.graphs.channels import constant_of
from splat_addon.blender.materials.graphs.vector_readers import inverse_of
from splat_addon.blender.materials.surface_shaders import surface_shader
from splat_addon.blender.materials.texture_images import UnreadableError
from splat_addon.blender.meshes.mesh_extraction import read_mesh
from splat_addon.blender.working_space import luminance
from splat_addon.shading_nodes import numbers, vectors
from splat_addon.shading_nodes.colors import hue_saturation
from splat_addon.shading_nodes.mixing import BLENDS

from .atlas import SIDE, Chain, compared


def builds() -> dict:
    found = {
        "hue saturation": lambda c: c.add(
            "HueSaturation", {"Hue": 0.7, "Saturation": 1.3, "Value": 0.9, "Fac": 0.8, "Color": c.color}
        ).outputs[0],
        "bright contrast": lambda c: c.add("BrightContrast", {0: c.color, 1: 0.1, 2: 0.4}).outputs[0],
        "gamma": lambda c: c.add("Gamma", {0: c.color, 1: 2.2}).outputs[0],
        "invert": lambda c: c.add("Invert", {0: 0.7, 1: c.color}).outputs[0],
        "black and white": lambda c: c.add("RGBToBW", {0: c.color}).outputs[0],
        "clamp": lambda c: c.add("Clamp", {0: c.number, 1: 0.2, 2: 0.7}).outputs[0],
        "clamp range": lambda c: c.add("Clamp", {0: c.number, 1: 0.7, 2: 0.2}, clamp_type="RANGE").outputs[0],
        "blackbody": lambda c: c.add("Blackbody", {0: c.math("MULTIPLY_ADD", c.part("X"), 11000.0, 1000.0)}).outputs[0],
        "wavelength": lambda c: c.add("Wavelength", {0: c.math("MULTIPLY_ADD", c.part("X"), 420.0, 370.0)}).outputs[0],
        "vertex color": lambda c: c.add("VertexColor", layer_name="Col").outputs[0],
        "attribute factor": lambda c: c.add("Attribute", attribute_name="Col").outputs["Fac"],
        "generated": lambda c: c.add("TexCoord").outputs["Generated"],
        "object": lambda c: c.add("TexCoord").outputs["Object"],
        "texture normal": lambda c: c.add("TexCoord").outputs["Normal"],
        "position": lambda c: c.add("NewGeometry").outputs["Position"],
        "object color": lambda c: c.add("ObjectInfo").outputs["Color"],
        "object random": lambda c: c.add("ObjectInfo").outputs["Random"],
        "material index": lambda c: c.add("ObjectInfo").outputs["Material Index"],
    }
    for blend in BLENDS:
        found[f"mix {blend}"] = lambda c, blend=blend: mixed(c, blend)
    for operation in numbers.OPERATIONS:
        found[f"math {operation}"] = lambda c, o=operation: c.math(
            o, c.number, c.math("MULTIPLY_ADD", c.part("Y"), 2.0, -0.7), 0.4
        )
    # Blender 4.5 has not all of them
    known = bpy.types.ShaderNodeVectorMath.bl_rna.properties["operation"].enum_items.keys()
    for operation in {*known} & {*vectors.OPERATIONS, *vectors.SCALED}:
        found[f"vector {operation}"] = lambda c, o=operation: vector(c, o)
    for how in ("LINEAR", "STEPPED", "SMOOTHSTEP", "SMOOTHERSTEP"):
        found[f"map range {how}"] = lambda c, h=how: ranged(c, h, "FLOAT")
        found[f"map range vector {how}"] = lambda c, h=how: ranged(c, h, "FLOAT_VECTOR")
    for mode in ("RGB", "HSV", "HSL"):
        found[f"separate {mode}"] = lambda c, m=mode: separated(c, m)
    for kind in ("POINT", "TEXTURE", "VECTOR", "NORMAL"):
        found[f"mapping {kind}"] = lambda c, k=kind: mapping(c, k)
    for kind in ("AXIS_ANGLE", "X_AXIS", "Y_AXIS", "Z_AXIS", "EULER_XYZ"):
        found[f"rotate {kind}"] = lambda c, k=kind: turned(c, k)
    found |= {
        "bump": bumped,
        "rgb curves": curves,
        "vector curves": vector_curves,
        "float curve": float_curve,
        "ramp": ramp,
        "stepped ramp": stepped,
    }
    for projection in ("FLAT", "BOX", "SPHERE", "TUBE"):
        found[f"image {projection}"] = lambda c, p=projection: image(c, p)
    return found


def bumped(c):
    waves = c.math("SINE", c.math("MULTIPLY", c.part("X"), 5.0))
    given = {"Height": c.math("MULTIPLY", waves, c.part("Y")), "Strength": 0.7, "Distance": 0.4}
    return c.add("Bump", given, invert=True).outputs[0]


def mixed(c, blend):
    other = c.add("CombineColor", {0: c.part("Y"), 1: 0.3, 2: c.part("X")}).outputs[0]
    return c.add(
        "Mix", {"Factor_Float": 0.7, "A_Color": c.color, "B_Color": other}, data_type="RGBA", blend_type=blend
    ).outputs[2]


def used(node):
    """The output that the node's mode uses."""
    return next(socket for socket in node.outputs if socket.enabled)


def vector(c, operation):
    a = c.add("CombineXYZ", {0: c.number, 1: c.part("Y"), 2: 0.3}).outputs[0]
    given = {"Vector": a, "Vector_001": (0.4, -0.3, 0.8), "Vector_002": (0.1, 0.2, 0.3), "Scale": 0.6}
    return used(c.add("VectorMath", given, operation=operation))


def ranged(c, how, kind):
    names = ("From Min", "From Max", "To Min", "To Max", "Steps")
    if kind == "FLOAT":
        given = {"Value": c.number} | dict(zip(names, (-0.5, 1.2, 0.1, 0.9, 3.0), strict=True))
    else:
        rows = (0.1, 0.2, 0.0), (0.8, 0.7, 1.2), (0.1, 0.3, 0.2), (0.9, 0.6, 1.1), (2, 3, 4)
        given = {"Vector": c.color} | {f"{n.replace(' ', '_')}_FLOAT3": row for n, row in zip(names, rows, strict=True)}
    return used(c.add("MapRange", given, data_type=kind, interpolation_type=how))


def separated(c, mode):
    parts = c.add("SeparateColor", {0: c.color}, mode=mode).outputs
    moved = {0: c.math("ADD", parts[0], 0.2), 1: c.math("MULTIPLY", parts[1], 0.8), 2: parts[2]}
    return c.add("CombineColor", moved, mode=mode).outputs[0]


def mapping(c, kind):
    given = {"Vector": c.color, "Rotation": (0.3, 0.5, 0.7), "Scale": (1.5, 0.7, 2.0)}
    if kind in ("POINT", "TEXTURE"):
        given["Location"] = (0.1, 0.2, 0.3)
    return c.add("Mapping", given, vector_type=kind).outputs[0]


def turned(c, kind):
    given = {"Vector": c.color, "Center": (0.2, 0.1, 0.0), "Axis": (0.3, 0.5, 0.8), "Angle": 0.8}
    return c.add("VectorRotate", given | {"Rotation": (0.3, 0.5, 0.7)}, rotation_type=kind, invert=True).outputs[0]


def bent(node):
    for curve, y in zip(node.mapping.curves, (0.7, 0.3, 0.9, 0.6), strict=False):
        curve.points.new(0.4, y)
    node.mapping.update()
    return node.outputs[0]


def curves(c):
    return bent(c.add("RGBCurve", {0: 0.8, 1: c.color}))


def vector_curves(c):
    return bent(c.add("VectorCurve", {0: 0.8, 1: c.color}))


def float_curve(c):
    return bent(c.add("FloatCurve", {0: 0.8, 1: c.number}))


def ramp(c):
    node = c.add("ValToRGB", {0: c.part("X")})
    node.color_ramp.elements.new(0.3).color = 0.9, 0.2, 0.1, 1
    return node.outputs[0]


def stepped(c):
    node = c.add("ValToRGB", {0: c.part("X")})
    node.color_ramp.interpolation = "CONSTANT"
    node.color_ramp.elements.new(0.3).color = 0.9, 0.2, 0.1, 1
    return node.outputs[0]


def image(c, projection):
    found = bpy.data.images.get("random") or bpy.data.images.new("random", 8, 4, float_buffer=True)
    found.pixels.foreach_set(np.random.default_rng(1).random(8 * 4 * 4).astype(np.float32))
    found.alpha_mode = "CHANNEL_PACKED"
    vector = c.add("TexCoord").outputs["Object"]
    vector = c.add("Mapping", {"Vector": vector, "Scale": (0.3, 0.4, 0.5)}).outputs[0]
    return c.add("TexImage", {0: vector}, image=found, projection=projection, interpolation="Linear").outputs[0]


def test_each_node_has_the_values_of_cycles(tmp_path):
    results = compared(builds(), tmp_path)
    print({name: round(result.db) for name, result in results.items()})
    wrong = {name: round(result.db) for name, result in results.items() if result.db < 38}
    assert wrong == {}


def procedural() -> dict:
    def texture(kind, output=0, scale=3.0, **settings):
        """A texture over the square, with inputs that are none of its defaults; those of settings are properties."""
        given = {"Scale": scale, "W": 0.37, **_GIVEN.get(kind, {})}

        def build(c):
            node = c.add(f"Tex{kind}", **settings)
            sockets = {socket.identifier: socket for socket in node.inputs if socket.enabled}
            for name in given.keys() & sockets.keys():
                sockets[name].default_value = given[name]
            moved = c.add("Mapping", {"Vector": c.uv, "Location": (-0.3, 0.2, 0.13), "Rotation": (0.4, 0.3, 0.2)})
            if kind == "WhiteNoise":  # its numbers depend on the last bit of each coordinate
                moved = c.add("VectorMath", {"Vector": moved.outputs[0], "Vector_001": (0.25,) * 3}, operation="SNAP")
            if "Vector" in sockets:
                c.tree.links.new(moved.outputs[0], sockets["Vector"])
            return node.outputs[output]

        return build

    found = {
        "checker": texture("Checker"),
        "checker factor": texture("Checker", "Fac"),
        "brick": texture("Brick", offset_frequency=3, squash_frequency=2, squash=0.7),
        "brick factor": texture("Brick", "Fac"),
        "magic": texture("Magic", turbulence_depth=10),
        "magic factor": texture("Magic", "Fac", turbulence_depth=2),
        "wave rings": texture("Wave", wave_type="RINGS", rings_direction="SPHERICAL", wave_profile="TRI"),
    }
    for kind in ("LINEAR", "QUADRATIC", "EASING", "DIAGONAL", "SPHERICAL", "QUADRATIC_SPHERE", "RADIAL"):
        found[f"gradient {kind}"] = texture("Gradient", gradient_type=kind)
    for direction, profile in (("X", "SIN"), ("Y", "SAW"), ("Z", "TRI"), ("DIAGONAL", "SIN")):
        found[f"wave {direction}"] = texture("Wave", bands_direction=direction, wave_profile=profile, scale=1.0)
    for dimensions in ("1D", "2D", "3D", "4D"):
        found[f"white noise {dimensions}"] = texture("WhiteNoise", "Color", noise_dimensions=dimensions)
        found[f"noise {dimensions}"] = texture("Noise", "Fac", noise_dimensions=dimensions)
        found[f"noise color {dimensions}"] = texture("Noise", "Color", noise_dimensions=dimensions, normalize=False)
    for kind in ("MULTIFRACTAL", "RIDGED_MULTIFRACTAL", "HYBRID_MULTIFRACTAL", "HETERO_TERRAIN"):
        found[f"noise {kind}"] = texture("Noise", noise_type=kind)
    for dimensions in ("1D", "2D", "3D", "4D"):
        for feature in ("F1", "F2", "SMOOTH_F1", "DISTANCE_TO_EDGE", "N_SPHERE_RADIUS"):
            output = "Radius" if feature == "N_SPHERE_RADIUS" else "Distance"
            how = {"voronoi_dimensions": dimensions, "feature": feature}
            found[f"voronoi {dimensions} {feature}"] = texture("Voronoi", output, **how)
        found[f"voronoi color {dimensions}"] = texture("Voronoi", "Color", voronoi_dimensions=dimensions)
    for metric in ("MANHATTAN", "CHEBYCHEV", "MINKOWSKI"):
        found[f"voronoi {metric}"] = texture("Voronoi", distance=metric, normalize=True, feature="F2")
    found["voronoi position"] = texture("Voronoi", "Position", feature="SMOOTH_F1")
    found["voronoi edge"] = texture("Voronoi", feature="DISTANCE_TO_EDGE", normalize=True)
    for kind in ("2D", "3D"):
        for output in ("Value", "Phase", "Intensity"):
            found[f"gabor {kind} {output}"] = texture("Gabor", output, gabor_type=kind)
    return found


#: texture -> values of its inputs
_GIVEN = {
    "Checker": {"Color1": (0.9, 0.2, 0.1, 1), "Color2": (0.1, 0.3, 0.8, 1)},
    "Brick": {"Mortar Smooth": 0.4, "Mortar Size": 0.08, "Bias": 0.1, "Color1": (0.9, 0.2, 0.1, 1), "Scale": 5.0},
    "Magic": {"Distortion": 1.4},
    "Wave": {"Distortion": 1.3, "Detail": 1.5, "Detail Roughness": 0.4, "Detail Scale": 1.2, "Phase Offset": 0.3},
    "Noise": {"Detail": 2.4, "Roughness": 0.6, "Lacunarity": 2.2, "Distortion": 0.4, "Offset": 0.3, "Gain": 1.2},
    "Voronoi": {"Detail": 1.5, "Roughness": 0.6, "Lacunarity": 2.2, "Smoothness": 0.6, "Exponent": 0.8},
    "Gabor": {"Frequency": 2.3, "Anisotropy": 0.6, "Orientation 2D": 0.7, "Orientation 3D": (0.4, 0.5, 0.7)},
}


def test_each_procedural_texture_has_the_values_of_cycles(tmp_path):
    results = compared(procedural(), tmp_path, is_filtered=False)
    wrong = {name: round(result.db) for name, result in results.items() if result.db < 32}
    assert wrong == {}


def test_a_checker_finer_than_the_pixels_is_averaged(tmp_path):
    """Four checks lie in each pixel, two of them black."""

    def fine(c):
        given = {"Vector": c.uv, "Color1": (1, 1, 1, 1), "Color2": (0, 0, 0, 1), "Scale": 2.0 * SIDE}
        return c.add("TexChecker", given).outputs[0]

    assert np.allclose(compared({"fine": fine}, tmp_path)["fine"].ours, 0.5)


@pytest.fixture
def surface(add_square):
    """surface(build) -> the `Surface` of a square, and what was not read of it. build: as of `compared`."""

    def made(build):
        chain = Chain("one")
        chain.ends_in(build(chain))
        square = add_square()
        square.data.materials.append(chain.material)
        bpy.context.view_layer.update()
        read = read_mesh(square.evaluated_get(bpy.context.evaluated_depsgraph_get()), square.data)
        return read.triangles.surfaces[0], read.notes

    return made


def test_images_and_colour_nodes_at_one_place_become_one_image(surface):
    """Such an image can be drawn on polygons, and is filtered like any other."""

    def tinted(c):
        hue = c.add("HueSaturation", {"Hue": 0.7, "Color": flat_image(c, "first", 8)}).outputs[0]
        small = c.add("MixRGB", {0: 0.0, 1: hue, 2: flat_image(c, "small", 4)}).outputs[0]
        return c.add(
            "Mix", {"Factor_Float": 0.5, "A_Color": small, "B_Color": flat_image(c, "second", 8)}, data_type="RGBA"
        ).outputs[2]

    found, notes = surface(tinted)
    (texture,) = found.emission.factors
    first, second = (np.reshape(bpy.data.images[name].pixels, (64, 4))[:, :3].T for name in ("first", "second"))
    expected = (hue_saturation(0.7, 1.0, 1.0, 1.0, first) + second) / 2
    assert notes == [] and texture.image.pixels.shape == (8, 8, 4)
    assert np.allclose(texture.image.pixels[..., :3].reshape(64, 3).T, expected, atol=1e-5)


def test_nodes_see_what_lies_between_the_pixels_of_a_small_image(tmp_path):
    """A steep ramp after a magnified image has its steps where Cycles has them."""

    def steep(c):
        node = c.add("ValToRGB", {0: flat_image(c, "small", 4, "Linear")})
        node.color_ramp.elements[0].position, node.color_ramp.elements[1].position = 0.4, 0.6
        return node.outputs[0]

    assert compared({"steep": steep}, tmp_path)["steep"].db > 32


def flat_image(c, name, size, interpolation="Closest"):
    found = bpy.data.images.new(name, size, size, float_buffer=True)
    found.pixels.foreach_set(np.random.default_rng(len(name)).random(size * size * 4).astype(np.float32))
    found.alpha_mode = "CHANNEL_PACKED"
    return c.add("TexImage", image=found, interpolation=interpolation).outputs[0]


def test_what_depends_on_the_view_is_as_seen_straight_on(surface):
    """The mix of red and green by Facing shows red, and Fresnel is that of the index of refraction."""
    colors = {"A_Color": (1, 0, 0, 1), "B_Color": (0, 1, 0, 1)}
    facing = lambda c: c.add("LayerWeight").outputs["Facing"]  # noqa: E731
    found, notes = surface(lambda c: c.add("Mix", {"Factor_Float": facing(c), **colors}, data_type="RGBA").outputs[2])
    assert np.allclose(found.emission.value, (1, 0, 0)) and "Layer Weight node, which depends on the view" in notes[0]
    assert notes[0].endswith("it looks as if seen straight on")
    found, _ = surface(lambda c: c.add("Fresnel", {0: 1.5}).outputs[0])
    assert np.allclose(found.emission.value, 0.04)


def unread(c):
    return c.add("ParticleInfo").outputs["Location"]


@pytest.mark.parametrize(
    "build",
    [
        lambda c: c.add("HueSaturation", {"Hue": c.add("Wireframe").outputs[0], "Color": flat_image(c, "left", 4)}),
        lambda c: c.add("MixRGB", {1: flat_image(c, "left", 4), 2: unread(c)}),
        lambda c: c.add("AmbientOcclusion", {0: flat_image(c, "left", 4)}),
        lambda c: c.add("Gamma", {0: c.add("MixRGB", {0: 1.0, 1: unread(c), 2: flat_image(c, "left", 4)}).outputs[0]}),
    ],
)
def test_what_can_be_read_is_shown_and_the_rest_is_named(surface, build):
    found, notes = surface(lambda c: build(c).outputs[0])
    (texture,) = found.emission.factors
    image = np.array(bpy.data.images["left"].pixels).reshape(4, 4, 4)
    assert np.allclose(texture.image.pixels[..., :3], image[..., :3], atol=1e-5)
    assert len(notes) == 1 and notes[0].endswith("what can be read of its nodes is used")


def test_what_nodes_feed_a_shader_everywhere_alike_is_no_plain_value():
    """Roughness by a Math node is a number of the whole material; by a texture or an object it is none."""
    material = Chain("rough").material
    principled = material.node_tree.nodes.new("ShaderNodeBsdfPrincipled")
    material.node_tree.links.new(principled.outputs[0], material.node_tree.get_output_node("ALL").inputs[0])
    math = material.node_tree.nodes.new("ShaderNodeMath")
    math.inputs[0].default_value, math.inputs[1].default_value = 0.1, 0.2
    material.node_tree.links.new(math.outputs[0], principled.inputs["Roughness"])
    assert np.allclose(constant_of(surface_shader(material), "Roughness"), 0.3)
    for kind, output in (("UVMap", 0), ("ObjectInfo", 3)):
        node = material.node_tree.nodes.new(f"ShaderNode{kind}")
        material.node_tree.links.new(node.outputs[output], math.inputs[1])
        assert constant_of(surface_shader(material), "Roughness") is None


def test_shaders_mixed_by_nodes_show_each_where_it_is(surface):
    """By an image's colour, two shaders are mixed pixel by pixel; what is transparent takes none of the colour."""

    def mixed_shaders(c):
        mix, diffuse = (c.tree.nodes.new(f"ShaderNode{kind}") for kind in ("MixShader", "BsdfDiffuse"))
        diffuse.inputs["Color"].default_value = (1, 0, 0, 1)
        principled = c.tree.nodes.new("ShaderNodeBsdfPrincipled")
        principled.inputs["Base Color"].default_value, principled.inputs["Alpha"].default_value = (0, 1, 0, 1), 0.5
        c.tree.links.new(flat_image(c, "mask", 4), mix.inputs[0])
        c.tree.links.new(diffuse.outputs[0], mix.inputs[1])
        c.tree.links.new(principled.outputs[0], mix.inputs[2])
        c.tree.links.new(mix.outputs[0], c.tree.get_output_node("ALL").inputs["Surface"])
        return c.add("RGB").outputs[0]

    found, notes = surface(mixed_shaders)
    mask = np.reshape(bpy.data.images["mask"].pixels, (4, 4, 4))[..., :3] @ luminance()[:3]
    opacity = 1 - mask / 2
    assert notes == []
    assert np.allclose(found.opacity.factors[0].image.pixels[..., 0], opacity, atol=1e-5)
    color = found.color.factors[0].image.pixels
    assert np.allclose(color[..., 0], (1 - mask) / opacity, atol=1e-5) and np.allclose(color[..., 2], 0)
    assert np.allclose(color[..., 1], mask / 2 / opacity, atol=1e-5)


@pytest.mark.parametrize("scale", [0.0, np.inf])
def test_vectors_in_the_space_of_an_object_without_one_are_named(scale):
    owner = bpy.data.objects.new("flat", bpy.data.meshes.new("flat"))
    owner.matrix_world = np.diag((1, scale, 1, 1))
    with pytest.raises(UnreadableError, match="the transform of 'flat', which has a scale of 0 or is not finite"):
        inverse_of(owner)
