# SPDX-License-Identifier: GPL-3.0-or-later
"""Forty small materials, each with one family of nodes before Base Color, Roughness or Normal, and two that depend on
the view."""

from __future__ import annotations

import bpy

from .chains import Chain, Socket

_TEAL, _RUST, _SAND = (0.05, 0.35, 0.4, 1), (0.5, 0.12, 0.04, 1), (0.7, 0.55, 0.3, 1)


def _curves(c: Chain) -> Socket:
    node = c.add("RGBCurve", {"Color": c.image("color")})
    for curve, y in zip(node.mapping.curves, (0.6, 0.4, 0.3, 0.7), strict=True):
        curve.points.new(0.4, y)
    node.mapping.update()
    return node.outputs[0]


def _packed_roughness(c: Chain) -> Socket:
    return c.add("SeparateColor", {0: c.image("packed")}).outputs["Green"]


def _recombined(c: Chain) -> Socket:
    parts = c.add("SeparateColor", {0: c.image("color")}, mode="HSV").outputs
    given = {0: c.math("ADD", parts[0], 0.2), 1: c.math("MULTIPLY", parts[1], 0.7), 2: parts[2]}
    return c.add("CombineColor", given, mode="HSV").outputs[0]


def _by_object(c: Chain) -> Socket:
    hue = c.math("MULTIPLY_ADD", c.add("ObjectInfo").outputs["Random"], 0.4, 0.3)
    return c.add("HueSaturation", {"Hue": hue, "Color": c.image("color")}).outputs[0]


def _by_height(c: Chain) -> Socket:
    height = c.part(c.add("NewGeometry").outputs["Position"], "Z")
    share = c.add("MapRange", {"Value": height, "From Min": -1.0, "From Max": 1.0}).outputs[0]
    return c.ramp(share, (0.2, _RUST[:3]), (0.5, _SAND[:3]), (0.8, _TEAL[:3]))


def _by_slope(c: Chain) -> Socket:
    up = c.part(c.add("NewGeometry").outputs["Normal"], "Z")
    return c.mix(c.add("MapRange", {"Value": up, "From Min": 0.2, "From Max": 0.9}).outputs[0], _RUST, _SAND)


def _grouped(c: Chain) -> Socket:
    """A group with a reroute in it, after a muted node."""
    tree = bpy.data.node_groups.new("tint", "ShaderNodeTree")
    for name, kind, way in (("Color", "Color", "INPUT"), ("Share", "Float", "INPUT"), ("Color", "Color", "OUTPUT")):
        tree.interface.new_socket(name, in_out=way, socket_type=f"NodeSocket{kind}")
    begin, end, way = (tree.nodes.new(f"Node{kind}") for kind in ("GroupInput", "GroupOutput", "Reroute"))
    inner = Chain(tree)
    tree.links.new(begin.outputs[0], way.inputs[0])
    tree.links.new(inner.mix(begin.outputs[1], way.outputs[0], _TEAL, "OVERLAY"), end.inputs[0])
    muted = c.add("Invert", {"Color": c.image("color")})
    muted.mute = True
    group = c.add("Group", node_tree=tree)
    c.feed(group.inputs[0], muted.outputs[0])
    c.feed(group.inputs[1], 0.7)
    return group.outputs[0]


def _normal_map(c: Chain) -> Socket:
    return c.add("NormalMap", {"Strength": 0.8, "Color": c.image("normal")}).outputs[0]


def _number(c: Chain) -> Socket:
    """-1 to 2 along one direction of the object."""
    return c.math("MULTIPLY_ADD", c.part(c.coordinates("Generated"), "X"), 3.0, -1.0)


#: name -> the input that it feeds, and its function of a `Chain`. Pictures of these are to have 38 dB.
PLAIN = {
    "Image Texture": ("Base Color", lambda c: c.image("color")),
    "Hue/Saturation": (
        "Base Color",
        lambda c: c.add(
            "HueSaturation", {"Hue": 0.7, "Saturation": 1.3, "Value": 0.9, "Color": c.image("color")}
        ).outputs[0],
    ),
    "RGB Curves": ("Base Color", _curves),
    "Brightness/Contrast": (
        "Base Color",
        lambda c: c.add("BrightContrast", {0: c.image("color"), 1: 0.1, 2: 0.4}).outputs[0],
    ),
    "Gamma": ("Base Color", lambda c: c.add("Gamma", {0: c.image("color"), 1: 1.8}).outputs[0]),
    "Invert Color": ("Roughness", lambda c: c.add("Invert", {1: c.image("occlusion")}).outputs[0]),
    "Mix, multiplied": ("Base Color", lambda c: c.mix(0.8, c.image("color"), c.image("occlusion"), "MULTIPLY")),
    "Mix, overlay": ("Base Color", lambda c: c.mix(0.7, c.image("color"), _TEAL, "OVERLAY")),
    "Mix, soft light": ("Base Color", lambda c: c.mix(0.9, c.image("color"), c.image("print"), "SOFT_LIGHT")),
    "Mix, screen": ("Base Color", lambda c: c.mix(0.5, c.image("color"), c.image("grunge"), "SCREEN")),
    "Mix, color": ("Base Color", lambda c: c.mix(0.8, c.image("color"), _TEAL, "COLOR")),
    "Mix by a mask": ("Base Color", lambda c: c.mix(c.image("grunge"), c.image("color"), _SAND)),
    "Color Ramp": (
        "Base Color",
        lambda c: c.ramp(c.image("occlusion"), (0.3, _RUST[:3]), (0.7, _SAND[:3]), (1, _TEAL[:3])),
    ),
    "Map Range": (
        "Roughness",
        lambda c: c.add("MapRange", {"Value": c.image("grunge"), "To Min": 0.2, "To Max": 0.7}).outputs[0],
    ),
    "Math": ("Roughness", lambda c: c.math("MULTIPLY", c.math("POWER", c.image("occlusion"), 2.0), 0.8, clamp=True)),
    "Separate Color": ("Roughness", _packed_roughness),
    "Separate and Combine, HSV": ("Base Color", _recombined),
    "Color Attribute": ("Base Color", lambda c: c.add("VertexColor", layer_name="Col").outputs[0]),
    "Object Info": ("Base Color", _by_object),
    "Geometry, position": ("Base Color", _by_height),
    "Geometry, normal": ("Base Color", _by_slope),
    "Blackbody": (
        "Base Color",
        lambda c: c.add("Blackbody", {0: c.math("MULTIPLY_ADD", _number(c), 1500.0, 3000.0)}).outputs[0],
    ),
    "Wavelength": (
        "Base Color",
        lambda c: c.add("Wavelength", {0: c.math("MULTIPLY_ADD", _number(c), 80.0, 500.0)}).outputs[0],
    ),
    "Mapping, turned": (
        "Base Color",
        lambda c: c.image("color", c.placed("UV", (0.2, 0.1, 0), (0, 0, 0.5), (1.5, 0.8, 1))),
    ),
    "Image, box": (
        "Base Color",
        lambda c: c.image(
            "color", c.placed("Object", (0.5, 0.5, 0.5), scale=(0.5,) * 3), projection="BOX", projection_blend=0.3
        ),
    ),
    "Image, sphere": ("Base Color", lambda c: c.image("color", c.coordinates("Generated"), projection="SPHERE")),
    "Group, reroute, muted": ("Base Color", _grouped),
    "Normal Map": ("Normal", _normal_map),
}


def _textured(kind: str, output: str, scale: float, from_: str = "Object", **settings):
    def build(c: Chain) -> Socket:
        node = c.add(f"Tex{kind}", {"Vector": c.coordinates(from_), "Scale": scale}, **settings)
        return next(socket for socket in node.outputs if socket.enabled and output in (socket.name, socket.identifier))

    return build


def _gradient(c: Chain) -> Socket:
    at = c.add("TexGradient", {"Vector": c.placed("Generated", (0, -0.5, -0.5))}, gradient_type="SPHERICAL")
    return c.ramp(at.outputs["Fac"], (0.1, _TEAL[:3]), (0.6, _SAND[:3]))


def _stepped_noise(c: Chain) -> Socket:
    at = c.add("VectorMath", {0: c.coordinates("Object"), 1: (0.25,) * 3}, operation="SNAP").outputs[0]
    return c.add("TexWhiteNoise", {"Vector": at}).outputs["Color"]


def _distorted(c: Chain) -> Socket:
    at = c.coordinates("UV")
    share = c.add("VectorMath", {0: c.noise(at, 4.0, output="Color"), "Scale": 0.1}, operation="SCALE").outputs[0]
    return c.image("color", c.add("VectorMath", {0: at, 1: share}, operation="ADD").outputs[0])


def _cracks(c: Chain) -> Socket:
    edges = c.voronoi(c.coordinates("Object"), 2.0, feature="DISTANCE_TO_EDGE")
    return c.bump(c.mask(edges, 0.0, 0.15), 0.5, 0.05)


#: Likewise; pictures of these are to have 32 dB.
PROCEDURAL = {
    "Noise": (
        "Base Color",
        lambda c: c.ramp(c.noise(c.coordinates("Object"), 3.0, 4.0), (0.35, _RUST[:3]), (0.65, _SAND[:3])),
    ),
    "Voronoi": ("Base Color", _textured("Voronoi", "Color", 3.0)),
    "Wave": ("Base Color", lambda c: c.ramp(_textured("Wave", "Fac", 1.0)(c), (0.2, _RUST[:3]), (0.8, _TEAL[:3]))),
    "Brick": ("Base Color", _textured("Brick", "Color", 3.0, "UV")),
    "Magic": ("Base Color", _textured("Magic", "Color", 1.5, turbulence_depth=3)),
    "Gradient": ("Base Color", _gradient),
    "Checker": ("Base Color", _textured("Checker", "Color", 3.0)),
    "White Noise": ("Base Color", _stepped_noise),
    "Gabor": ("Roughness", _textured("Gabor", "Value", 2.0, gabor_type="3D")),
    "Noise before an image": ("Base Color", _distorted),
    "Voronoi, bumped": ("Normal", _cracks),
    "Noise, bumped": ("Normal", lambda c: c.bump(c.noise(c.coordinates("Object"), 3.0, 1.0))),
}

#: Likewise of what depends on the view, of which surfels show what is seen straight on: without a goal.
OF_VIEWS = {
    "Layer Weight": ("Base Color", lambda c: c.mix(c.add("LayerWeight", {0: 0.4}).outputs["Facing"], _RUST, _SAND)),
    "Fresnel": ("Roughness", lambda c: c.add("Fresnel", {0: 1.45}).outputs[0]),
}
