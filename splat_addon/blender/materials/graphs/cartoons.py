# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads materials of EEVEE that make a colour of the light on a surface (Shader to RGB): as a ramp of colours from no
light to full light, over the colours in full light.

Whatever nodes follow are evaluated at many amounts of light. That is exact if the colours do not vary over the surface,
or if they multiply what the light becomes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import bpy
import numpy as np

from ....sampling import Image
from ....shading_nodes import ATTRIBUTE, Inputs, evaluate
from ...geometry.node_groups import nodes_in
from ..mesh_layers import MeshLayers
from ..node_products import ImageSource
from ..node_trees import uses_nodes
from ..node_walks import Node, Socket
from ..ramps import PLACES
from ..surface_shaders import Shader, shader_at, surface_shader
from ..texture_images import UnreadableError
from .channels import ReadGraph, constant_of, limited
from .reading import GraphReading, Value

_LIGHT_TO_COLOR = "ShaderNodeShaderToRGB"

#: The largest factor by which a colour in less light is brighter than in full light.
_BRIGHTER = 100.0


@dataclass(frozen=True, eq=False)
class Cartoon:
    """colors: (PLACES, 3) from no light to full light; of a surface that varies, as factors of those in full light.
    varies: whether it does. socket, groups: the colour that is sent out."""

    colors: np.ndarray
    varies: bool
    socket: Socket
    groups: tuple[Node, ...]

    def in_full_light(self, layers: MeshLayers) -> ReadGraph:
        """The colours of a surface that varies. Raises UnreadableError if nothing of them can be read."""
        reading = _Reading(layers, self.groups, is_lit_fully=True)
        color = reading.three(reading.read_strictly(self.socket), True)
        return ReadGraph(*reading.graph(color), reading.doubts, reading.asks_owner)


def cartoon_of(material: bpy.types.Material) -> Cartoon | None:
    """The ramp of a material that makes a colour of light; None for any other."""
    if not uses_nodes(material) or all(n.bl_idname != _LIGHT_TO_COLOR for n in nodes_in(material.node_tree)):
        return None
    shader = surface_shader(material)
    if shader is None or shader.node.mute:
        return None
    is_color = shader.node.outputs[0].type != "SHADER"
    if not is_color and shader.node.bl_idname != "ShaderNodeEmission":
        return None
    socket = shader.into if is_color else shader.node.inputs["Color"]
    layers = _White()
    reading = _Reading(layers, shader.groups)
    try:
        graph, _ = reading.graph(reading.three(reading.read_strictly(socket), True))
    except UnreadableError:
        return None
    strength = (1.0,) if is_color else constant_of(shader, "Strength")
    if not reading.is_lit or strength is None:
        return None
    light = np.concatenate([np.tile(np.linspace(0, 1, PLACES, dtype=np.float32), (3, 1)), np.ones((5, PLACES))])
    colors = np.broadcast_to(evaluate(graph, Inputs(PLACES, colors=np.float32(light))), (3, PLACES)).T * strength[0]
    if layers.is_asked:
        full = colors[-1]
        colors = np.where(full > 1e-6, colors / np.maximum(full, 1e-6), 0).clip(0, _BRIGHTER)
    return Cartoon(colors.clip(0), layers.is_asked, socket, shader.groups)


class _White:
    """Stands for a mesh whose layers and images are white. Of its attributes, the first is the light."""

    mesh = material = owner = None
    asks_owner = False

    def __init__(self):
        self.is_asked = False
        self.kept_images: dict = {}

    def uv(self, name: str) -> int:
        self.is_asked = True
        return 0

    def color(self, name: str) -> int:
        self.is_asked = True
        return 1

    derived = color

    def image(self, source: ImageSource, keep_alpha: bool, any_projection: bool = False) -> Image:
        self.is_asked = True
        return Image(np.ones((1, 1, 4), np.float32))


class _Reading(GraphReading):
    """is_lit_fully: whether light is 1, and not an attribute. is_lit: whether any was read."""

    def __init__(self, layers, groups: tuple[Node, ...], is_lit_fully: bool = False):
        super().__init__(layers, groups)
        self._is_lit_fully, self.is_lit = is_lit_fully, False

    def reader(self, node: Node, output: str) -> Callable[[], Value] | None:
        if node.bl_idname == _LIGHT_TO_COLOR:
            return partial(self._lit, node) if output == node.outputs[0].identifier else lambda: Value((1.0,))
        return super().reader(node, output)

    def _lit(self, node: Node) -> Value:
        """The colour of a surface in this light."""
        shader = shader_at(node.inputs[0], tuple(self._groups))
        self.is_lit = True
        color = Value((0.0,) * 3, 3, True) if shader is None else self._own_color(shader)
        if self._is_lit_fully:
            return color
        return self.color("multiplied", color, self.color(ATTRIBUTE, settings=(0,)))

    def _own_color(self, shader: Shader) -> Value:
        name = next((name for name in ("Color", "Base Color") if name in shader.node.inputs), None)
        if name is None:
            raise UnreadableError("a shader without a colour")
        inner = self.inside(shader.groups)
        return inner.three(limited(inner, shader, name), True)
