# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads an input of a shader, or a product of two, as a graph."""

from __future__ import annotations

from dataclasses import dataclass

from ....shading_nodes import Graph, constant_value
from ..mesh_layers import MeshLayers
from ..node_walks import Node
from ..socket_ranges import range_of
from ..surface_shaders import SHADERS, Shader
from ..texture_images import UnreadableError
from ..transparent_mixes import TransparentMix
from . import converters, seen_straight_on, skies, sources, textures, vector_readers  # noqa: F401 they register what nodes become
from .reading import GraphReading, Value
from .vector_readers import as_direction, inverse_of


@dataclass(frozen=True, eq=False)
class ReadGraph:
    """images: number of a step that looks up an image -> its node, and whether it keeps its alpha. doubts: what was not
    read -> how a sentence about it ends. asks_owner: whether it depends on the object that shows the mesh."""

    graph: Graph
    images: dict[int, tuple[Node, bool]]
    doubts: dict[str, str]
    asks_owner: bool = False


def read_channel(shader: Shader, name: str, layers: MeshLayers, mix: TransparentMix | None = None) -> ReadGraph:
    """A field of `Surface` of a shader; mix: with a Transparent BSDF, whose factor multiplies the opacity.

    Raises UnreadableError if nothing of it can be read.
    """
    reading = GraphReading(layers, shader.groups)
    given = [limited(reading, shader, socket) for socket in SHADERS[shader.node.bl_idname].get(name, ())]
    if mix is not None and name == "opacity":
        inner = reading.inside(mix.mix.groups)
        factor = inner.add("in range", inner.read_strictly(mix.mix.node.inputs[0]), settings=(0.0, 1.0))
        given.append(inner.add("invert", Value((1.0,)), factor) if mix.is_first else factor)
    value, *others = given
    for other in others:
        width = max(value.width, other.width)
        value = reading.add("multiplied", value, other, width=width, is_color=width == 3)
    return ReadGraph(*reading.graph(value), reading.doubts, reading.asks_owner)


class _Nothing:
    """Stands for the layers of a mesh, and is asked for none of them if an input is the same everywhere."""

    mesh = material = owner = None

    def __init__(self):
        self.is_asked = False

    def __getattr__(self, name: str):
        self.is_asked = True
        raise UnreadableError("the mesh")


def constant_of(shader: Shader, name: str) -> tuple[float, ...] | None:
    """The 1 or 3 numbers of a shader's socket that nodes feed; None if they vary, or nothing of them can be read."""
    layers = _Nothing()
    reading = GraphReading(layers, shader.groups)
    try:
        graph, _ = reading.graph(limited(reading, shader, name))
    except UnreadableError:
        return None
    return None if layers.is_asked or reading.asks_owner else constant_value(graph)


def constant_number(socket, groups: tuple[Node, ...]) -> float | None:
    """The number of a socket of any node; None if it varies, or nothing of it can be read."""
    layers = _Nothing()
    reading = GraphReading(layers, groups)
    try:
        graph, _ = reading.graph(reading.number(reading.read_strictly(socket)))
    except UnreadableError:
        return None
    return None if layers.is_asked or reading.asks_owner else constant_value(graph)[0]


def mix_factor(mix: Shader) -> tuple[float, bool]:
    """The factor of a Mix Shader, 0 to 1, and whether it is a constant; if not, its socket's value."""
    socket = mix.node.inputs[0]
    factor = constant_number(socket, mix.groups)
    value = socket.default_value if factor is None else factor
    return min(value, 1.0) if value > 0 else 0.0, factor is not None


def read_color(socket, groups: tuple[Node, ...], layers: MeshLayers) -> ReadGraph:
    """A colour socket of any node. Raises UnreadableError if nothing of it can be read."""
    reading = GraphReading(layers, groups)
    return ReadGraph(*reading.graph(reading.read_strictly(socket)), reading.doubts)


def read_normal(socket, groups: tuple[Node, ...], layers: MeshLayers) -> ReadGraph:
    """A Normal socket as the colour of a normal map in object space. Raises UnreadableError."""
    reading = GraphReading(layers, groups)
    normal = as_direction(reading, reading.read_strictly(socket), inverse_of(reading.owner), "NORMAL")
    shown = reading.vector("halved", normal)
    return ReadGraph(*reading.graph(shown), reading.doubts, reading.asks_owner)


def limited(reading: GraphReading, shader: Shader, name: str) -> Value:
    """An input of a shader, in the range that it takes."""
    value = reading.read_strictly(shader.node.inputs[name])
    limits = range_of(shader.node, name)
    return reading.add("in range", value, settings=limits, width=value.width, is_color=value.is_color)
