# SPDX-License-Identifier: GPL-3.0-or-later
"""Recognises the usual material of leaf cards: a Mix Shader between a Transparent BSDF and the shader of the leaf.

Its factor is opacity, and multiplies the alpha of that shader.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy

from .node_products import Product, product
from .node_walks import MAX_CHAIN, linked, outer
from .surface_shaders import Shader
from .texture_images import UnreadableError


@dataclass(frozen=True, eq=False)
class TransparentMix:
    """shader: what covers. mix: the Mix Shader. is_first: whether the shader is the first of the two, whose share is 1
    minus the factor."""

    shader: Shader
    mix: Shader
    is_first: bool

    def opacity(self) -> Product:
        """The shader's share. Raises UnreadableError."""
        share = product(self.mix.node.inputs[0], self.mix.groups)
        if share.sources:
            if self.is_first:
                raise UnreadableError("1 minus an image or an attribute")
            return share
        factor = min(max(share.value[0], 0.0), 1.0)
        return Product((1 - factor if self.is_first else factor,))

    def is_alpha_of(self, node: bpy.types.Node) -> bool:
        """Whether the share is the alpha of an Image Texture node."""
        return not self.is_first and linked(outer(self.mix.node.inputs[0], self.mix.groups)[0]) == (node, "Alpha")


def transparent_mix(shader: Shader | None) -> TransparentMix | None:
    """The mix that a shader is, or None. A muted node is none, and neither is a mix of two transparent shaders."""
    if shader is None or shader.node.bl_idname != "ShaderNodeMixShader" or shader.node.mute:
        return None
    mixed = [shader.feeding(socket) for socket in shader.node.inputs[1:]]
    if None in mixed or mixed[0].is_clear == mixed[1].is_clear:
        return None
    is_first = not mixed[0].is_clear
    return TransparentMix(mixed[0 if is_first else 1], shader, is_first)


def cuts_holes(shader: Shader | None) -> bool:
    """Whether a shader is as transparent as an image says, as for leaves on cards: by its Alpha, or by the factor of
    its mix with a Transparent BSDF."""
    mix = transparent_mix(shader)
    leaf, sockets = (mix.shader, [outer(mix.mix.node.inputs[0], mix.mix.groups)[0]]) if mix else (shader, [])
    if leaf is not None and "Alpha" in leaf.node.inputs:
        sockets.append(leaf.socket("Alpha"))
    return any(_shows_an_image(socket) for socket in sockets)


#: Operations of Math nodes whose result is 0 or 1.
_TESTS = frozenset({"GREATER_THAN", "LESS_THAN", "COMPARE", "ROUND"})


def _shows_an_image(socket) -> bool:
    """Whether an image feeds a socket, also through nodes that make an alpha test of it."""
    for _ in range(MAX_CHAIN):
        node, _output = linked(socket) or (None, "")
        if node is None or node.bl_idname != "ShaderNodeMath" or node.operation not in _TESTS:
            return node is not None and node.bl_idname == "ShaderNodeTexImage"
        socket = next((own for own in node.inputs if own.is_linked), node.inputs[0])
    return False
