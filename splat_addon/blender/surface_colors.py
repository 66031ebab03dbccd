# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a Blender material's base colour comes from: its nodes -> `sampling.SurfaceColor`.

A base colour is read when it is a product of a constant, one image texture on a UV map and one colour attribute,
which is what importers and painters make. Anything else falls back to the socket's own value, and says so.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ..sampling import Image, SurfaceColor
from .texture_images import UnreadableColorError, linear_pixels


@dataclass(frozen=True, eq=False)
class BaseColor:
    """A surface, and the mesh layers that its image and its colour attribute are looked up by."""

    surface: SurfaceColor
    uv_layer: str | None = None
    color_layer: str | None = None


def base_color(material: bpy.types.Material | None, mesh: bpy.types.Mesh) -> tuple[BaseColor, list[str]]:
    """The base colour of `material` on `mesh`, and what could not be read, as "base colour comes from a Noise node".

    Without a material: the mesh's colour attribute where it has one, else Blender's grey.
    """
    if material is None:
        layer = default_color_layer(mesh)
        return BaseColor(SurfaceColor((1, 1, 1, 1), vertex_colors=True) if layer else SurfaceColor(), None, layer), []
    plain = tuple(material.diffuse_color)
    if not _uses_nodes(material):
        return BaseColor(SurfaceColor(plain)), []
    shader = _surface_shader(material)
    if shader is None or shader.bl_idname not in _COLOR_SOCKETS:
        name = f"a {shader.bl_label} node" if shader else "no shader at its output"
        return BaseColor(SurfaceColor(plain)), [f"base colour comes from {name}"]
    return _shader_color(shader, mesh)


def default_color_layer(mesh: bpy.types.Mesh) -> str | None:
    """The colour attribute that renders, or None."""
    name = mesh.attributes.default_color_name or mesh.attributes.active_color_name
    return name if name in mesh.color_attributes else None


#: shader node -> its colour socket
_COLOR_SOCKETS = {"ShaderNodeBsdfPrincipled": "Base Color", "ShaderNodeBsdfDiffuse": "Color"}


@dataclass(frozen=True)
class _Factors:
    """A product: constant times image times colour attribute."""

    color: tuple[float, ...] = (1.0, 1.0, 1.0)
    image: bpy.types.ShaderNodeTexImage | None = None
    color_layer: str | None = None

    def __mul__(self, other: _Factors) -> _Factors:
        if (self.image and other.image) or (self.color_layer and other.color_layer):
            raise UnreadableColorError("a product of two textures or two colour attributes")
        return _Factors(
            tuple(a * b for a, b in zip(self.color, other.color, strict=True)),
            self.image or other.image,
            self.color_layer or other.color_layer,
        )


def _shader_color(shader: bpy.types.ShaderNode, mesh: bpy.types.Mesh) -> tuple[BaseColor, list[str]]:
    socket = shader.inputs[_COLOR_SOCKETS[shader.bl_idname]]
    unread = []
    try:
        factors = _read(socket, mesh)
        opacity, keep_alpha, unread_alpha = _alpha(shader, factors.image)
        image, uv_layer = _texture(factors.image, mesh, keep_alpha) if factors.image else (None, None)
        unread += unread_alpha
    except UnreadableColorError as error:
        factors, image, uv_layer = _Factors(tuple(socket.default_value)[:3]), None, None
        opacity, _, unread_alpha = _alpha(shader, None)
        unread += [f"base colour comes from {error}", *unread_alpha]
    surface = SurfaceColor((*factors.color, opacity), image, factors.color_layer is not None)
    return BaseColor(surface, uv_layer, factors.color_layer), unread


def _alpha(shader: bpy.types.ShaderNode, image: bpy.types.Node | None) -> tuple[float, bool, list[str]]:
    """The constant opacity, whether the image texture node of the base colour gives its alpha to it, what is unread."""
    socket = shader.inputs.get("Alpha")
    if socket is None:
        return 1.0, False, []
    source = _source(socket)
    if source is None:
        return float(socket.default_value), False, []
    if source == (image, "Alpha"):
        return 1.0, True, []
    return float(socket.default_value), False, [f"alpha comes from a {source[0].bl_label} node"]


def _texture(node: bpy.types.ShaderNodeTexImage, mesh: bpy.types.Mesh, keep_alpha: bool) -> tuple[Image, str]:
    """The image of an Image Texture node, and the UV layer that it is looked up by."""
    if node.image is None:
        raise UnreadableColorError("an Image Texture node without an image")
    if node.projection != "FLAT":
        raise UnreadableColorError(f"an image texture in {node.projection.lower()} projection")
    # Blender's Cubic and Smart are Linear where a texture is not magnified.
    interpolation = "Closest" if node.interpolation == "Closest" else "Linear"
    return Image(linear_pixels(node.image, keep_alpha), node.extension, interpolation), _uv_layer(node, mesh)


def _uv_layer(node: bpy.types.ShaderNodeTexImage, mesh: bpy.types.Mesh) -> str:
    source = _source(node.inputs["Vector"])
    wanted = ""
    if source is not None:
        placed_by, output = source
        if placed_by.bl_idname == "ShaderNodeUVMap":
            wanted = placed_by.uv_map
        elif (placed_by.bl_idname, output) != ("ShaderNodeTexCoord", "UV"):
            raise UnreadableColorError(f"an image texture that is placed by a {placed_by.bl_label} node")
    names = [layer.name for layer in mesh.uv_layers if layer.name == wanted or (not wanted and layer.active_render)]
    if not names:
        raise UnreadableColorError(f"an image texture on the UV map {wanted!r}, which the mesh does not have")
    return names[0]


def _read(socket: bpy.types.NodeSocket, mesh: bpy.types.Mesh) -> _Factors:
    """What a colour socket is the product of."""
    source = _source(socket)
    if source is None:
        return _Factors(tuple(socket.default_value)[:3])
    node, output = source
    reader = _READERS.get((node.bl_idname, output))
    if reader is None or node.mute:
        raise UnreadableColorError(f"a {'muted ' if node.mute else ''}{node.bl_label} node")
    return reader(node, mesh)


def _source(socket: bpy.types.NodeSocket) -> tuple[bpy.types.Node, str] | None:
    """The node that feeds a socket, past any reroutes, and the identifier of its output; None where nothing does."""
    while socket.links and not socket.links[0].is_muted:
        link = socket.links[0]
        if link.from_node.bl_idname != "NodeReroute":
            return link.from_node, link.from_socket.identifier
        socket = link.from_node.inputs[0]
    return None


def _read_constant(node, mesh) -> _Factors:
    return _Factors(tuple(node.outputs[0].default_value)[:3])


def _read_image(node, mesh) -> _Factors:
    return _Factors(image=node)


def _read_vertex_color(node, mesh) -> _Factors:
    return _Factors(color_layer=_color_layer(node.layer_name, mesh))


def _read_attribute(node, mesh) -> _Factors:
    if node.attribute_type != "GEOMETRY":
        raise UnreadableColorError(f"an attribute of the {node.attribute_type.lower()}")
    return _Factors(color_layer=_color_layer(node.attribute_name, mesh))


def _color_layer(name: str, mesh: bpy.types.Mesh) -> str:
    name = name or default_color_layer(mesh)
    if not name or name not in mesh.color_attributes:
        raise UnreadableColorError(f"the colour attribute {name or ''!r}, which the mesh does not have")
    return name


def _read_mix(node, mesh) -> _Factors:
    factor, a, b = (_input(node, name) for name in _MIX_INPUTS[node.bl_idname])
    is_product = getattr(node, "data_type", "RGBA") == "RGBA" and node.blend_type == "MULTIPLY"
    if not is_product or _source(factor) is not None or not np.isclose(factor.default_value, 1.0):
        raise UnreadableColorError(f"a {node.bl_label} node other than a full Multiply")
    return _read(a, mesh) * _read(b, mesh)


def _input(node: bpy.types.Node, identifier: str) -> bpy.types.NodeSocket:
    return next(socket for socket in node.inputs if socket.identifier == identifier)


#: mix node -> identifiers of its factor and two colours
_MIX_INPUTS = {
    "ShaderNodeMix": ("Factor_Float", "A_Color", "B_Color"),
    "ShaderNodeMixRGB": ("Fac", "Color1", "Color2"),
}

#: (node, output) -> function of (node, mesh) giving `_Factors`
_READERS = {
    ("ShaderNodeRGB", "Color"): _read_constant,
    ("ShaderNodeTexImage", "Color"): _read_image,
    ("ShaderNodeVertexColor", "Color"): _read_vertex_color,
    ("ShaderNodeAttribute", "Color"): _read_attribute,
    ("ShaderNodeMix", "Result_Color"): _read_mix,
    ("ShaderNodeMixRGB", "Color"): _read_mix,
}


def _uses_nodes(material: bpy.types.Material) -> bool:
    # From 5.0 every material does, and asking is deprecated.
    return bpy.app.version >= (5, 0, 0) or (material.use_nodes and material.node_tree is not None)


def _surface_shader(material: bpy.types.Material) -> bpy.types.Node | None:
    """The node at the surface of the active output."""
    output = material.node_tree.get_output_node("ALL")
    source = _source(output.inputs["Surface"]) if output else None
    return source[0] if source else None
