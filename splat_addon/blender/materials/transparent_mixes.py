# SPDX-License-Identifier: GPL-3.0-or-later
"""Recognises the usual material of leaf cards: a Mix Shader between a Transparent BSDF and the shader of the leaf.

Its factor is opacity, and multiplies the alpha of that shader.
"""

from __future__ import annotations

from dataclasses import dataclass

import bpy

from .node_products import Product, linked, product

#: How far from white a Transparent BSDF's colour may be: a tinted one filters what is behind it.
_WHITE_ENOUGH = 1e-3


@dataclass(frozen=True, eq=False)
class TransparentMix:
    """shader: what covers. factor: the socket of its share. is_first: whether the shader is the first of the two, whose
    share is 1 minus the factor."""

    shader: bpy.types.Node
    factor: bpy.types.NodeSocket
    is_first: bool

    def opacity(self) -> Product:
        """The shader's share. Raises UnreadableError."""
        share = product(self.factor)
        if not share.sources:
            share = share.mapped(_clamped, "Mix Shader")
        return share.mapped(_rest, "Mix Shader") if self.is_first else share

    def is_alpha_of(self, node: bpy.types.Node) -> bool:
        """Whether the share is the alpha of an Image Texture node."""
        return not self.is_first and linked(self.factor) == (node, "Alpha")


def transparent_mix(shader: bpy.types.Node | None) -> TransparentMix | None:
    """The mix that a node is, or None. A muted node is none, and neither is a mix of two transparent shaders."""
    if shader is None or shader.bl_idname != "ShaderNodeMixShader" or shader.mute:
        return None
    factor, *sockets = shader.inputs
    sources = [linked(socket) for socket in sockets]
    nodes = [source and source[0] for source in sources]
    clear = [_is_clear(node) for node in nodes]
    if None in nodes or clear[0] == clear[1]:
        return None
    return TransparentMix(nodes[clear.index(False)], factor, is_first=not clear[0])


def _is_clear(node: bpy.types.Node | None) -> bool:
    if node is None or node.bl_idname != "ShaderNodeBsdfTransparent" or node.mute:
        return False
    color = node.inputs["Color"]
    return linked(color) is None and all(abs(1 - channel) <= _WHITE_ENOUGH for channel in color.default_value[:3])


def _clamped(values):
    return values.clip(0, 1)


def _rest(values):
    return 1 - values
