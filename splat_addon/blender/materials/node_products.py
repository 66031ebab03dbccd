# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads a socket of a shader's node tree as a product of constants, image textures and attributes.

Importers and painters make such products. Anything else raises `UnreadableError`, whose text ends the sentence "it
comes from ...", and is read as a graph.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import bpy
import numpy as np

from ...sampling.materials.surfaces import ALPHA, BLUE, GREEN, RED
from ..working_space import luminance
from .node_trees import called
from .node_walks import Node, Socket, Walk, input_of, linked
from .texture_images import UnreadableError


@dataclass(frozen=True)
class ImageSource:
    """An Image Texture node. weights: for its r, g, b, a, to make one number; None: the colour."""

    node: bpy.types.ShaderNodeTexImage
    weights: tuple[float, ...] | None = None


@dataclass(frozen=True)
class AttributeSource:
    """A named attribute of the mesh, "" for the render attribute. weights: as in `ImageSource`."""

    name: str
    weights: tuple[float, ...] | None = None


@dataclass(frozen=True)
class Product:
    """value: 3 numbers of a colour, or 1. sources: its factors."""

    value: tuple[float, ...]
    sources: tuple[ImageSource | AttributeSource, ...] = ()

    def __mul__(self, other: Product) -> Product:
        value = np.multiply(self.value, other.value)
        if not value.any():
            return Product(tuple(value.tolist()))
        product = Product(tuple(value.tolist()), self.sources + other.sources)
        for kind in (ImageSource, AttributeSource):
            if sum(isinstance(source, kind) for source in product.sources) > 1:
                raise UnreadableError("a product of two textures or two attributes")
        return product

    def weighted(self, weights: tuple[float, ...]) -> Product:
        """One number of a colour."""
        if len(self.value) == 1:
            return self
        if not self.sources:
            return Product((float(np.dot(self.value, weights[:3])),))
        kept = [k for k in range(3) if weights[k]]
        # Factors of the colour must scale its components alike, so that the sum is a product again.
        if len(self.sources) > 1 or self.sources[0].weights is not None or len({self.value[k] for k in kept}) > 1:
            raise UnreadableError("one number of a product of colours")
        return Product((self.value[kept[0]],), (replace(self.sources[0], weights=weights),))


def product(socket: Socket, groups: tuple[Node, ...] = ()) -> Product:
    """A colour or number socket as a product. groups: the group nodes around its node, the innermost last.

    Raises UnreadableError.
    """
    return _Reading(groups).read(socket)


class _Reading(Walk):
    """Reads products; anything else ends the walk."""

    def constant(self, socket: Socket) -> Product:
        return constant(socket)

    def arrived(self, read: Product, socket: Socket) -> Product:
        return read.weighted(luminance()) if socket.type in NUMBERS else read

    def reader(self, node: Node, output: str) -> Callable[[], Product] | None:
        found = _READERS.get((node.bl_idname, output))
        return found and partial(found, node, self.read)


#: Types of sockets with a single number.
NUMBERS = ("VALUE", "BOOLEAN")


def constant(socket: Socket) -> Product:
    """The socket's own value."""
    value = socket.default_value
    return Product((float(value),)) if socket.type in NUMBERS else Product(tuple(float(c) for c in value[:3]))


#: Reads a socket farther up the tree.
Read = Callable[[Socket], Product]
#: Reads the output of a node.
Reader = Callable[[Node, Read], Product]


def _output(node: Node, read: Read) -> Product:
    """The constant of an RGB or Value node."""
    return constant(node.outputs[0])


def _color(node: Node, read: Read) -> Product:
    return Product((1.0, 1.0, 1.0), (ImageSource(node),))


def _alpha(node: Node, read: Read) -> Product:
    return Product((1.0,), (ImageSource(node, ALPHA),))


def _attribute_name(node: Node) -> str:
    if node.bl_idname == "ShaderNodeVertexColor":
        return node.layer_name
    if node.attribute_type != "GEOMETRY":
        raise UnreadableError(f"an attribute of the {node.attribute_type.lower()}")
    return node.attribute_name


def _attribute_color(node: Node, read: Read) -> Product:
    return Product((1.0, 1.0, 1.0), (AttributeSource(_attribute_name(node)),))


def _attribute_number(weights: tuple[float, ...]) -> Reader:
    return lambda node, read: Product((1.0,), (AttributeSource(_attribute_name(node), weights),))


#: For colours and vectors, the Attribute node's Factor; linked to a number, its Color becomes the luminance.
_MEAN = (1 / 3, 1 / 3, 1 / 3, 0.0)


def _component(weights: tuple[float, ...]) -> Reader:
    def component(node: Node, read: Read) -> Product:
        if getattr(node, "mode", "RGB") != "RGB":
            raise UnreadableError(f"{called(node)} in {node.mode}")
        return read(node.inputs[0]).weighted(weights)

    return component


def _luminance(node: Node, read: Read) -> Product:
    return read(node.inputs[0]).weighted(luminance())


def _mix(node: Node, read: Read) -> Product:
    factor, a, b = (input_of(node, name) for name in _MIX_INPUTS[node.bl_idname])
    is_product = getattr(node, "data_type", "RGBA") == "RGBA" and node.blend_type == "MULTIPLY"
    if not is_product or linked(factor) is not None or not np.isclose(factor.default_value, 1.0):
        raise UnreadableError(f"{called(node)} other than a full Multiply")
    return read(a) * read(b)


#: mix node -> identifiers of its factor and two colours
_MIX_INPUTS = {
    "ShaderNodeMix": ("Factor_Float", "A_Color", "B_Color"),
    "ShaderNodeMixRGB": ("Fac", "Color1", "Color2"),
}


#: (node, output) -> function of the node, and of a reader for its input sockets, that returns its `Product`
_READERS: dict[tuple[str, str], Reader] = {
    ("ShaderNodeRGB", "Color"): _output,
    ("ShaderNodeValue", "Value"): _output,
    ("ShaderNodeTexImage", "Color"): _color,
    ("ShaderNodeTexImage", "Alpha"): _alpha,
    ("ShaderNodeVertexColor", "Color"): _attribute_color,
    ("ShaderNodeVertexColor", "Alpha"): _attribute_number(ALPHA),
    ("ShaderNodeAttribute", "Color"): _attribute_color,
    ("ShaderNodeAttribute", "Fac"): _attribute_number(_MEAN),
    ("ShaderNodeAttribute", "Alpha"): _attribute_number(ALPHA),
    ("ShaderNodeSeparateColor", "Red"): _component(RED),
    ("ShaderNodeSeparateColor", "Green"): _component(GREEN),
    ("ShaderNodeSeparateColor", "Blue"): _component(BLUE),
    ("ShaderNodeSeparateRGB", "R"): _component(RED),
    ("ShaderNodeSeparateRGB", "G"): _component(GREEN),
    ("ShaderNodeSeparateRGB", "B"): _component(BLUE),
    ("ShaderNodeRGBToBW", "Val"): _luminance,
    ("ShaderNodeMix", "Result_Color"): _mix,
    ("ShaderNodeMixRGB", "Color"): _mix,
}
