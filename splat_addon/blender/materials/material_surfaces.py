# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads Blender's materials as `sampling.Surface`, with the mesh layers that they use.

Each input of the output's shader is read as a product (`node_products`). An input that cannot be read takes the value
of its socket and is recorded, so that it can be reported or baked.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import bpy
import numpy as np

from ...sampling import Channel, Image, NormalMap, Surface, Texture, VertexColors
from ...sampling.attributes.surfaces import ALPHA, RED
from .. import working_space
from ..geometry.attributes import has_surfels_beside_faces
from .mean_surfaces import mean_of
from .node_products import AttributeSource, ImageSource, Product, linked, outer, product
from .node_trees import called, uses_nodes
from .shader_mixes import channels
from .socket_ranges import finite_factors, in_range, is_radiance
from .surface_shaders import METALS, SHADERS, Shader, is_holdout, surface_shader, why_unseen
from .texture_images import UnreadableError, linear_pixels
from .texture_placement import placement, uv_layer
from .transparent_mixes import TransparentMix, transparent_mix


@dataclass(frozen=True)
class Unread:
    """An input that could not be read. channel: a field of `Surface`. reason: the end of "it comes from ..."."""

    channel: str
    reason: str

    def __str__(self) -> str:
        return f"{CHANNEL_NAMES[self.channel]} comes from {self.reason}"


#: field of `Surface` -> its name for users
CHANNEL_NAMES = {
    "color": "base colour",
    "opacity": "alpha",
    "roughness": "roughness",
    "metallic": "metallic",
    "emission": "emission",
    "normal_map": "normal",
}

#: data type of an attribute that can be used as a colour -> its property, and its number of components
ATTRIBUTE_TYPES = {
    "FLOAT_COLOR": ("color", 4),
    "BYTE_COLOR": ("color", 4),  # scene-linear, this one too
    "FLOAT_VECTOR": ("vector", 3),
    "FLOAT2": ("vector", 2),
    "FLOAT": ("value", 1),
}
ATTRIBUTE_DOMAINS = ("POINT", "CORNER", "FACE")


@dataclass
class MeshLayers:
    """The layers of a mesh that its materials use, without duplicates, in the order of first use."""

    mesh: bpy.types.Mesh
    uvs: list[str] = field(default_factory=list)
    colors: list[str] = field(default_factory=list)
    _images: dict = field(default_factory=dict)

    def uv(self, name: str) -> int:
        return _index(self.uvs, name)

    def color(self, name: str) -> int:
        name = name or default_color_layer(self.mesh) or ""
        attribute = self.mesh.attributes.get(name)
        if attribute is None:
            raise UnreadableError(f"the attribute {name!r}, which the mesh does not have")
        if attribute.data_type not in ATTRIBUTE_TYPES or attribute.domain not in ATTRIBUTE_DOMAINS:
            raise UnreadableError(f"the attribute {name!r}, which is {attribute.data_type} on {attribute.domain}")
        return _index(self.colors, name)

    def image(self, source: ImageSource, keep_alpha: bool) -> Image:
        """The pixels of an Image Texture node; the same object for the same pixels."""
        node = source.node
        if node.image is None:
            raise UnreadableError("an Image Texture node without an image")
        if node.projection != "FLAT":
            raise UnreadableError(f"an image texture in {node.projection.lower()} projection")
        # Blender's Cubic and Smart equal Linear where a texture is not magnified.
        interpolation = "Closest" if node.interpolation == "Closest" else "Linear"
        is_apart = not keep_alpha and any(not link.is_muted for link in node.outputs["Alpha"].links)
        space = working_space.to_xyz().tobytes()
        key = node.image.session_uid, keep_alpha, node.extension, interpolation, is_apart, space
        if key not in self._images:
            self._images[key] = Image(linear_pixels(node.image, keep_alpha, is_apart), node.extension, interpolation)
        return _mapped(self._images[key], source) if source.functions else self._images[key]


def _index(names: list[str], name: str) -> int:
    if name not in names:
        names.append(name)
    return names.index(name)


def _mapped(image: Image, source: ImageSource) -> Image:
    """The image with the source's functions applied to its pixels; a single number is stored in the red channel."""
    pixels = image.pixels.copy()
    values = pixels[..., :3] if source.weights is None else (pixels @ np.float32(source.weights))[..., None]
    for function in source.functions:
        values = function(values)
    pixels[..., :3] = finite_factors(values)
    if source.weights is not None:
        pixels[..., 3] = 1
    return replace(image, pixels=pixels)


def material_surface(material: bpy.types.Material | None, layers: MeshLayers) -> tuple[Surface, list[Unread]]:
    """The material's surface on the mesh of `layers`, and the inputs that could not be read.

    Without a material: the mesh's colour attribute if it has one, otherwise Blender's grey.
    """
    if material is None:
        return _bare_surface(layers), []
    plain = Surface(Channel(_display_color(material)))
    if not uses_nodes(material):
        return plain, []
    shader = surface_shader(material)
    if (found := _behind_holes(shader, layers)) is not None:
        return found, []
    if why_unseen(material) is not None:
        return Surface(Channel((0.0, 0.0, 0.0, 0.0))), []
    if is_holdout(material):
        return Surface(Channel((0.0, 0.0, 0.0, 1.0))), []
    if shader is None:
        return plain, [Unread("color", "no shader at its output")]
    if shader.node.bl_idname in SHADERS:
        return _Reader(shader, layers).surface()
    mean = mean_of(shader)
    if mean.only is not None:
        surface, unread = _Reader(mean.only, layers).surface()
        if not unread:
            return surface, []
    unread = [Unread(channel, called(shader.node)) for channel in channels(shader) if mean.unsure]
    return mean.surface, unread


def _behind_holes(shader: Shader | None, layers: MeshLayers) -> Surface | None:
    """The surface of a shader mixed with a Transparent BSDF; None for anything else, or if not all of it can be read,
    so that the mix is baked as a whole."""
    mix = transparent_mix(shader)
    if mix is None or "color" not in SHADERS.get(mix.shader.node.bl_idname, ()):
        return None
    surface, unread = _Reader(mix.shader, layers, mix).surface()
    return None if unread else surface


def plain_color(material: bpy.types.Material) -> tuple[tuple[float, float, float, float], bool]:
    """The colour and opacity of a material without its textures, and whether it has textures."""
    shader = surface_shader(material) if uses_nodes(material) else None
    if shader is None:
        is_unseen = why_unseen(material) is not None
        return (0.0, 0.0, 0.0, 0.0) if is_unseen else _display_color(material), False
    mean = mean_of(shader)
    return mean.surface.color.value, not mean.unsure.isdisjoint(("color", "opacity"))


def _display_color(material: bpy.types.Material) -> tuple[float, float, float, float]:
    """What a material without nodes looks like."""
    *color, alpha = material.diffuse_color
    return *in_range("Base Color", color), *in_range("Alpha", (alpha,))


def _bare_surface(layers: MeshLayers) -> Surface:
    if not default_color_layer(layers.mesh):
        return Surface()
    return Surface(Channel((1.0, 1.0, 1.0, 1.0), VertexColors(layers.color(""))))


class _Reader:
    """Reads one shader node. mix: with a Transparent BSDF, if it is in one."""

    def __init__(self, shader: Shader, layers: MeshLayers, mix: TransparentMix | None = None):
        self._shader, self._layers, self._mix = shader, layers, mix
        self._sockets = SHADERS[shader.node.bl_idname]
        self._unread: list[Unread] = []

    def surface(self) -> tuple[Surface, list[Unread]]:
        alpha = self._product("opacity") if "opacity" in self._sockets else Product((1.0,))
        if self._mix is not None:
            alpha = self._in_mix(alpha)
        color, opacity = self._color(alpha) if "color" in self._sockets else (Channel((0.0, 0.0, 0.0, 1.0)), None)
        rest = {name: self._channel(name) for name in ("roughness", "metallic", "emission") if name in self._sockets}
        if self._shader.node.bl_idname in METALS:
            rest["metallic"] = Channel((1.0,))
        return Surface(color, opacity, normal_map=self._normal_map(), **rest), self._unread

    def _in_mix(self, alpha: Product) -> Product:
        try:
            return alpha * self._mix.opacity()
        except UnreadableError as error:
            self._unread.append(Unread("opacity", str(error)))
            return alpha

    def _color(self, alpha: Product) -> tuple[Channel, Channel | None]:
        """The colour, with the alpha if it comes from the same image, and the remaining part of the alpha."""
        read = self._product("color")
        own = [s for s in alpha.sources if isinstance(s, ImageSource) and s.weights == ALPHA and not s.functions]
        images = [s.node for s in read.sources if isinstance(s, ImageSource) and s.weights is None]
        joint = [s for s in own if s.node in images]
        rest = Product(alpha.value, tuple(s for s in alpha.sources if s not in joint))
        try:
            factors = tuple(self._factor(source, bool(joint)) for source in read.sources)
        except UnreadableError as error:
            read, factors, rest = self._plain("color", error), (), alpha
        opacity = self._made("opacity", rest)
        value = read.value if len(read.value) == 3 else read.value * 3
        if opacity is None or opacity.factors:
            return Channel((*value, 1.0), factors), opacity
        return Channel((*value, opacity.value[0]), factors), None

    def _channel(self, name: str) -> Channel:
        return self._made(name, self._product(name))

    def _made(self, name: str, read: Product) -> Channel | None:
        """The channel of a product; that of its plain socket if an image or a layer cannot be read."""
        try:
            factors = tuple(self._factor(source, _is_alpha(source) and source.is_number) for source in read.sources)
        except UnreadableError as error:
            read, factors = self._plain(name, error), ()
        if name != "emission":
            return Channel(read.value, factors)
        sent = read.value * (3 // len(read.value))
        return Channel(sent, factors) if is_radiance(sent) else Channel((0.0, 0.0, 0.0))

    def _product(self, name: str) -> Product:
        first, *others = self._sockets[name]
        try:
            read = self._shader.product(first)
            for socket in others:
                read = read * self._shader.product(socket)
        except UnreadableError as error:
            return self._plain(name, error)
        return read

    def _plain(self, name: str, error: UnreadableError) -> Product:
        self._unread.append(Unread(name, str(error)))
        read = Product((1.0,))
        for socket in self._sockets[name]:
            read = read * self._shader.plain(socket)
        return read

    def _factor(self, source: ImageSource | AttributeSource, uses_alpha: bool) -> Texture | VertexColors:
        if isinstance(source, AttributeSource):
            return VertexColors(self._layers.color(source.name), source.weights, uses_alpha=False)
        image = self._layers.image(source, uses_alpha or _is_alpha(source))
        name, matrix, wraps = placement(source.node, self._layers.mesh)
        weights = (RED if source.is_number else None) if source.functions else source.weights
        return Texture(image, self._layers.uv(name), matrix, weights, uses_alpha, wraps)

    def _normal_map(self) -> NormalMap | None:
        sockets = self._sockets.get("normal_map")
        if not sockets:
            return None
        socket, groups = outer(self._shader.node.inputs[sockets[0]], self._shader.groups)
        source = linked(socket)
        if source is None:
            return None
        try:
            return self._read_normal_map(source[0], groups)
        except UnreadableError as error:
            self._unread.append(Unread("normal_map", str(error)))
            return None

    def _read_normal_map(self, node: bpy.types.Node, groups: tuple[bpy.types.Node, ...]) -> NormalMap | None:
        if node.bl_idname != "ShaderNodeNormalMap" or node.mute:
            raise UnreadableError(called(node))
        if node.space not in _SPACES or getattr(node, "convention", "OPENGL") != "OPENGL":
            raise UnreadableError(f"a normal map in {node.space.replace('_', ' ').lower()} space, or of DirectX")
        strength, _ = outer(node.inputs["Strength"], groups)
        if linked(strength) is not None:
            raise UnreadableError("a normal map whose strength is linked")
        if not 0 <= strength.default_value <= _STRONGEST:
            raise UnreadableError(f"a normal map of strength {strength.default_value:g}")
        if linked(node.inputs["Color"]) is None:
            return None
        read = product(node.inputs["Color"], groups)
        color = Channel(read.value, tuple(self._factor(source, False) for source in read.sources))
        layer = self._layers.uv(uv_layer(node.uv_map, self._layers.mesh)) if node.space == "TANGENT" else 0
        return NormalMap(color, strength.default_value, layer, node.space)


#: Strength of a normal map beyond which float32 overflows.
_STRONGEST = 1e15

#: Spaces of a Normal Map node that `NormalMap` supports.
_SPACES = ("TANGENT", "OBJECT")


def _is_alpha(source) -> bool:
    return source.weights == ALPHA


def default_color_layer(mesh: bpy.types.Mesh) -> str | None:
    """The colour attribute used for rendering, or None. The attribute of surfels joined to the mesh is ignored."""
    if has_surfels_beside_faces(mesh):
        return None
    name = mesh.attributes.default_color_name or mesh.attributes.active_color_name
    return name if name in mesh.color_attributes else None
