# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads Blender's materials as `sampling.Surface`, with the mesh layers that they use.

Each input of the output's shader is read as a product (`node_products`), or else as a graph of its nodes (`graphs`). An
input of which nothing can be read takes the value of its socket. What was not read is recorded, so that it can be
reported or baked.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy

from ...sampling import Channel, Computed, NormalMap, Surface, Texture, VertexColors
from ...sampling.materials.surfaces import ALPHA, RED
from ...shading_nodes import constant_value
from .graphs.cartoons import Cartoon, cartoon_of
from .graphs.channels import ReadGraph, read_channel, read_color, read_normal
from .graphs.flattened import flattened
from .graphs.mixes import read_mixed
from .graphs.reading import STRAIGHT_ON
from .mean_surfaces import mean_of
from .mesh_layers import MeshLayers, default_color_layer
from .node_products import AttributeSource, ImageSource, Product, product
from .node_trees import uses_nodes
from .node_walks import linked, outer
from .shader_mixes import channels
from .socket_ranges import in_range, is_radiance
from .surface_shaders import METALS, SHADERS, Shader, is_holdout, surface_shader, why_unseen
from .texture_images import UnreadableError
from .texture_placement import placement, uv_layer
from .transparent_mixes import TransparentMix, transparent_mix

#: How a sentence about an input ends of which nothing was read.
PLAIN = "the plain value of its socket is used"


@dataclass(frozen=True)
class Unread:
    """What could not be read of an input. channel: a field of `Surface`. reason: the end of "it comes from ...". used:
    what is shown instead."""

    channel: str
    reason: str
    used: str = PLAIN

    def __str__(self) -> str:
        return f"{CHANNEL_NAMES[self.channel]} comes from {self.reason}; {self.used}"

    @property
    def can_be_baked(self) -> bool:
        """Whether a bake knows better."""
        return self.used != STRAIGHT_ON


#: field of `Surface` -> its name for users
CHANNEL_NAMES = {
    "color": "base colour",
    "opacity": "alpha",
    "roughness": "roughness",
    "metallic": "metallic",
    "emission": "emission",
    "normal_map": "normal",
}


def material_surface(material: bpy.types.Material | None, layers: MeshLayers) -> tuple[Surface, list[Unread]]:
    """The material's surface on the mesh of `layers`, and the inputs that could not be read.

    Without a material: the mesh's colour attribute if it has one, otherwise Blender's grey.
    """
    layers.material = material
    if material is None:
        return _bare_surface(layers), []
    plain = Surface(Channel(_display_color(material)))
    if not uses_nodes(material):
        return plain, []
    shader = surface_shader(material)
    if (found := _behind_holes(shader, layers)) is not None:
        return found
    if why_unseen(material) is not None:
        return Surface(Channel((0.0, 0.0, 0.0, 0.0))), []
    if is_holdout(material):
        return Surface(Channel((0.0, 0.0, 0.0, 1.0))), []
    if shader is None:
        return plain, [Unread("color", "no shader at its output")]
    if (cartoon := cartoon_of(material)) is not None:
        return _in_full_light(cartoon, layers)
    if shader.node.bl_idname in SHADERS:
        return _Reader(shader, layers).surface()
    mean = mean_of(shader)
    if mean.only is not None:
        surface, unread = _Reader(mean.only, layers).surface()
        if not any(each.can_be_baked for each in unread):
            return surface, unread
    return _mixture(shader, layers) if mean.unsure else (mean.surface, [])


def _in_full_light(cartoon: Cartoon, layers: MeshLayers) -> tuple[Surface, list[Unread]]:
    """The colours that the ramp of a material multiplies."""
    white = Surface(Channel((1.0, 1.0, 1.0, 1.0)))
    if not cartoon.varies:
        return white, []
    try:
        read = cartoon.in_full_light(layers)
    except UnreadableError as error:
        return white, [Unread("color", str(error), "it is white")]
    made = _channel_of("color", read, layers)
    return Surface(Channel((*made.value, 1.0), made.factors)), _doubted("color", read)


def _behind_holes(shader: Shader | None, layers: MeshLayers) -> tuple[Surface, list[Unread]] | None:
    """The surface of a shader mixed with a Transparent BSDF; None for anything else, or if not all of it can be read,
    so that the mix is baked as a whole."""
    mix = transparent_mix(shader)
    if mix is None or "color" not in SHADERS.get(mix.shader.node.bl_idname, ()):
        return None
    surface, unread = _Reader(mix.shader, layers, mix).surface()
    return None if any(each.can_be_baked for each in unread) else (surface, unread)


def plain_color(material: bpy.types.Material) -> tuple[tuple[float, float, float, float], bool]:
    """The colour and opacity of a material without its textures, and whether it has textures."""
    shader = surface_shader(material) if uses_nodes(material) else None
    if (cartoon := cartoon_of(material)) is not None:
        return (1.0, 1.0, 1.0, 1.0), cartoon.varies
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


def _mixture(shader: Shader, layers: MeshLayers) -> tuple[Surface, list[Unread]]:
    """The surface of a tree of shaders whose parts or shares vary."""
    read = {name: read_mixed(shader, name, layers) for name in channels(shader)}
    unread = [each for name, graph in read.items() for each in _doubted(name, graph)]
    made = {name: _channel_of(name, graph, layers, is_mixed=True) for name, graph in read.items()}
    color, opacity = made["color"], made.get("opacity")
    if opacity is None or opacity.factors:
        color = Channel((*color.value, 1.0), color.factors)
        return Surface(color, opacity, emission=made.get("emission")), unread
    color = Channel((*color.value, opacity.value[0]), color.factors)
    return Surface(color, emission=made.get("emission")), unread


def _doubted(name: str, read: ReadGraph) -> list[Unread]:
    return [Unread(name, reason, used) for reason, used in read.doubts.items()]


def _channel_of(
    name: str, read: ReadGraph, layers: MeshLayers, alpha_of: bpy.types.Node | None = None, is_mixed: bool = False
) -> Channel:
    """The channel of a graph: a constant, one image, or the graph.

    alpha_of: an image whose alpha goes along. is_mixed: whether it is of several shaders.
    """
    # such a constant the renderer knows of one shader, if it is the same for all objects
    is_known = name not in ("roughness", "metallic", "emission") or not (read.asks_owner or is_mixed)
    one = (1.0,) * _WIDTHS[name]
    if read.graph.is_constant and is_known:
        value = constant_value(read.graph)
        return Channel(value if len(one) == len(value) else value * 3)
    flat = flattened(read.graph, read.images, layers, alpha_of)
    try:
        if flat is not None:
            layer, matrix, wraps = placement(flat[1], layers.mesh)
            weights = RED if len(one) == 1 else None
            return Channel(one, Texture(flat[0], layers.uv(layer), matrix, weights, alpha_of is not None, wraps))
    except UnreadableError:
        pass  # the image lies where only the graph can place it
    return Channel(one, Computed(read.graph))


class _Reader:
    """Reads one shader node. mix: with a Transparent BSDF, if it is in one."""

    def __init__(self, shader: Shader, layers: MeshLayers, mix: TransparentMix | None = None):
        self._shader, self._layers, self._mix = shader, layers, mix
        self._sockets = SHADERS[shader.node.bl_idname]
        self._unread: list[Unread] = []

    def surface(self) -> tuple[Surface, list[Unread]]:
        color, opacity = self._color(*self._alpha())
        rest = {name: self._channel(name) for name in ("roughness", "metallic", "emission") if name in self._sockets}
        if self._shader.node.bl_idname in METALS:
            rest["metallic"] = Channel((1.0,))
        return Surface(color, opacity, normal_map=self._normal_map(), **rest), self._unread

    def _alpha(self) -> tuple[Product, Channel | None]:
        """The opacity as a product, or 1 and a channel."""
        try:
            alpha = self._product("opacity") if "opacity" in self._sockets else Product((1.0,))
            return alpha if self._mix is None else alpha * self._mix.opacity(), None
        except UnreadableError:
            return Product((1.0,)), self._computed("opacity", self._mix)

    def _color(self, alpha: Product, opacity: Channel | None) -> tuple[Channel, Channel | None]:
        """The colour, with the alpha if it comes from the same image, and the remaining part of the alpha."""
        if "color" not in self._sockets:
            return Channel((0.0, 0.0, 0.0, 1.0)), None
        own = [s for s in alpha.sources if isinstance(s, ImageSource) and s.weights == ALPHA]
        try:
            read = self._product("color")
            images = [s.node for s in read.sources if isinstance(s, ImageSource) and s.weights is None]
            joint = [s for s in own if s.node in images]
            color = Channel(
                read.value * (3 // len(read.value)), tuple(self._factor(s, bool(joint)) for s in read.sources)
            )
        except UnreadableError:
            color = self._computed("color", alpha_of=own[0].node if own else None)
            joint = own[:1] if own and _uses_alpha(color) else []
        if opacity is None:
            opacity = self._made("opacity", Product(alpha.value, tuple(s for s in alpha.sources if s not in joint)))
        if opacity.factors:
            return Channel((*color.value, 1.0), color.factors), opacity
        return Channel((*color.value, opacity.value[0]), color.factors), None

    def _channel(self, name: str) -> Channel:
        try:
            return self._made(name, self._product(name))
        except UnreadableError:
            return self._sent(name, self._computed(name))

    def _made(self, name: str, read: Product) -> Channel:
        """The channel of a product; of a graph if an image or a layer cannot be read."""
        try:
            factors = tuple(self._factor(source, _is_alpha(source)) for source in read.sources)
        except UnreadableError:
            return self._sent(name, self._computed(name, self._mix if name == "opacity" else None))
        value = read.value * (3 // len(read.value)) if name == "emission" else read.value
        return self._sent(name, Channel(value, factors))

    def _sent(self, name: str, made: Channel) -> Channel:
        """A channel; black for an emission that no picture can represent."""
        return made if name != "emission" or is_radiance(made.value) else Channel((0.0, 0.0, 0.0))

    def _product(self, name: str) -> Product:
        first, *others = self._sockets[name]
        read = self._shader.product(first)
        for socket in others:
            read = read * self._shader.product(socket)
        return read

    def _computed(
        self, name: str, mix: TransparentMix | None = None, alpha_of: bpy.types.Node | None = None
    ) -> Channel:
        """The channel as a graph; that of its plain socket if nothing of it can be read.

        alpha_of: an image whose alpha the colour takes along if it is one image.
        """
        try:
            return self._of_graph(name, read_channel(self._shader, name, self._layers, mix), alpha_of)
        except UnreadableError as error:
            self._unread.append(Unread(name, str(error)))
        read = Product((1.0,))
        for socket in self._sockets.get(name, ()):
            read = read * self._shader.plain(socket)
        return Channel(read.value if _WIDTHS[name] == len(read.value) else read.value * 3)

    def _of_graph(self, name: str, read: ReadGraph, alpha_of: bpy.types.Node | None = None) -> Channel:
        self._unread += _doubted(name, read)
        return _channel_of(name, read, self._layers, alpha_of)

    def _factor(self, source: ImageSource | AttributeSource, uses_alpha: bool) -> Texture | VertexColors:
        if isinstance(source, AttributeSource):
            return VertexColors(self._layers.color(source.name), source.weights, uses_alpha=False)
        image = self._layers.image(source, uses_alpha or _is_alpha(source))
        name, matrix, wraps = placement(source.node, self._layers.mesh)
        return Texture(image, self._layers.uv(name), matrix, source.weights, uses_alpha, wraps)

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
            normal = self._shader.node.inputs[self._sockets["normal_map"][0]]
            read = read_normal(normal, self._shader.groups, self._layers)
            return NormalMap(self._of_graph("normal_map", read), space="OBJECT")
        if node.space not in _SPACES or getattr(node, "convention", "OPENGL") != "OPENGL":
            raise UnreadableError(f"a normal map in {node.space.replace('_', ' ').lower()} space, or of DirectX")
        strength, _ = outer(node.inputs["Strength"], groups)
        if linked(strength) is not None:
            raise UnreadableError("a normal map whose strength is linked")
        if not 0 <= strength.default_value <= _STRONGEST:
            raise UnreadableError(f"a normal map of strength {strength.default_value:g}")
        if linked(node.inputs["Color"]) is None:
            return None
        try:
            read = product(node.inputs["Color"], groups)
            color = Channel(read.value, tuple(self._factor(source, False) for source in read.sources))
        except UnreadableError:
            color = self._of_graph("normal_map", read_color(node.inputs["Color"], groups, self._layers))
        layer = self._layers.uv(uv_layer(node.uv_map, self._layers.mesh)) if node.space == "TANGENT" else 0
        return NormalMap(color, strength.default_value, layer, node.space)


#: Strength of a normal map beyond which float32 overflows.
_STRONGEST = 1e15

#: Spaces of a Normal Map node that `NormalMap` supports.
_SPACES = ("TANGENT", "OBJECT")


#: Numbers of a channel.
_WIDTHS = {"color": 3, "opacity": 1, "roughness": 1, "metallic": 1, "emission": 3, "normal_map": 3}


def _uses_alpha(channel: Channel) -> bool:
    return any(isinstance(factor, Texture) and factor.uses_alpha for factor in channel.factors)


def _is_alpha(source) -> bool:
    return source.weights == ALPHA
