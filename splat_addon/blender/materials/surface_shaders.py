# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the shader at a material's output, also inside node groups, and the shaders that it mixes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import Any

import bpy

from ..working_space import luminance
from .node_products import NUMBERS, Product, constant, product
from .node_trees import uses_nodes
from .node_walks import MAX_CHAIN, has_volume, linked, outer, passed_through_link, within
from .socket_ranges import finite_factors, has_range, in_range

Node = bpy.types.Node
Socket = bpy.types.NodeSocket

_GLOSSY = {"color": ("Color",), "roughness": ("Roughness",), "normal_map": ("Normal",)}

#: shader node -> field of `Surface` -> its sockets, which are multiplied
SHADERS = {
    "ShaderNodeBsdfPrincipled": {
        "color": ("Base Color",),
        "opacity": ("Alpha",),
        "roughness": ("Roughness",),
        "metallic": ("Metallic",),
        "emission": ("Emission Color", "Emission Strength"),
        "normal_map": ("Normal",),
    },
    "ShaderNodeBsdfDiffuse": {"color": ("Color",), "normal_map": ("Normal",)},
    "ShaderNodeEmission": {"emission": ("Color", "Strength")},
    "ShaderNodeBsdfAnisotropic": _GLOSSY,
    "ShaderNodeBsdfMetallic": {"color": ("Base Color",), "roughness": ("Roughness",), "normal_map": ("Normal",)},
    "ShaderNodeBsdfGlass": _GLOSSY,
    "ShaderNodeBsdfRefraction": _GLOSSY,
    "ShaderNodeBsdfTransparent": {"color": ("Color",)},
    "ShaderNodeBsdfTranslucent": {"color": ("Color",), "normal_map": ("Normal",)},
    "ShaderNodeSubsurfaceScattering": {"color": ("Color",), "normal_map": ("Normal",)},
    "ShaderNodeBsdfToon": {"color": ("Color",), "normal_map": ("Normal",)},
    "ShaderNodeBsdfSheen": {"color": ("Color",), "normal_map": ("Normal",)},
}

#: Shader nodes that are metals.
METALS = ("ShaderNodeBsdfAnisotropic", "ShaderNodeBsdfMetallic")

#: Shaders that let everything through and cover nothing where they are mixed with others.
CLEAR = ("BSDF_TRANSPARENT", "HOLDOUT")

#: How far from white a Transparent BSDF's colour may be: a tinted one filters what is behind it.
_WHITE_ENOUGH = 1e-3


@dataclass(frozen=True)
class Shader:
    """A shader node. into: a socket that it feeds. groups: the group nodes around it, the innermost last."""

    node: Node
    into: Socket = field(compare=False)
    groups: tuple[Node, ...] = ()

    def socket(self, name: str) -> Socket:
        """The socket that supplies the value of an input: of a group if the group passes it in."""
        return outer(self.node.inputs[name], self.groups)[0]

    def product(self, name: str) -> Product:
        """An input as a product. Raises UnreadableError."""
        read = product(self.node.inputs[name], self.groups)
        if read.sources:
            return replace(read, value=tuple(finite_factors(read.value).tolist()))
        return self._taken(name, read)

    def plain(self, name: str) -> Product:
        """The value of an input without what is linked to it."""
        return self._taken(name, self._own(name))

    def odd_numbers(self) -> Iterator[str]:
        """The inputs whose own values lie beyond what the shader takes, and what they count as."""
        for socket in self.node.inputs:
            # a node also has sockets of its other modes, which cannot be had by name
            if has_range(self.node, socket.name) and socket.name in self.node.inputs:
                given = self._own(socket.name).value
                if (taken := in_range(socket.name, given)) != given:
                    yield f"{socket.name} {_numbers(given)} counts as {_numbers(taken)}"

    def _own(self, name: str) -> Product:
        read = constant(self.socket(name))
        number = self.node.inputs[name].type in NUMBERS
        return read.weighted(luminance()) if number else Product(read.value * (3 // len(read.value)))

    def _taken(self, name: str, read: Product) -> Product:
        return replace(read, value=in_range(name, read.value)) if has_range(self.node, name) else read

    @property
    def is_clear(self) -> bool:
        """Whether it lets everything through unchanged."""
        if self.node.bl_idname != "ShaderNodeBsdfTransparent" or self.node.mute:
            return False
        return linked(self.socket("Color")) is None and all(
            abs(1 - channel) <= _WHITE_ENOUGH for channel in self.plain("Color").value
        )

    def feeding(self, socket: Socket) -> Shader | None:
        """The shader that feeds one of its sockets."""
        return shader_at(socket, self.groups)


def _numbers(value: tuple[float, ...]) -> str:
    return ", ".join(f"{number:g}" for number in value)


def surface_shader(owner: bpy.types.Material | bpy.types.World | bpy.types.Light) -> Shader | None:
    """The shader at the surface of the active output."""
    output = owner.node_tree.get_output_node("ALL")
    return shader_at(output.inputs["Surface"]) if output else None


def shader_at(socket: Socket, groups: tuple[Node, ...] = ()) -> Shader | None:
    """The shader that feeds a socket, which is in the innermost of `groups`."""
    for _ in range(MAX_CHAIN):
        socket, groups = outer(socket, groups)
        source = linked(socket)
        if source is None:
            return None
        node, output = source
        if node.bl_idname != "ShaderNodeGroup" or node.node_tree is None or node.mute:
            return Shader(node, socket, groups)
        inner = within(node, output)
        if inner is None:
            return None
        socket, groups = inner, (*groups, node)
    return None


def is_holdout(material: bpy.types.Material) -> bool:
    """Whether a material's surface is a Holdout, which cuts a hole."""
    shader = surface_shader(material) if uses_nodes(material) else None
    return shader is not None and shader.node.type == "HOLDOUT" and not shader.node.mute


def why_unseen(material: bpy.types.Material) -> str | None:
    """The end of a sentence about a material that covers nothing, so that its faces are not drawn."""
    if not uses_nodes(material):
        return None
    shader = surface_shader(material)
    if shader is None:
        return "has no surface but a volume, which is not drawn" if has_volume(material.node_tree) else None
    if shader.node.mute or shader.node.type != "BSDF_TRANSPARENT":
        return None
    return "is a Transparent BSDF, through which everything is seen" if shader.is_clear else None


@dataclass(frozen=True)
class Part:
    """A shader in a tree of mixed and added ones. share: by which it is multiplied, in all places together. is_sure:
    whether that is a constant."""

    shader: Shader
    share: float
    is_sure: bool


def parts(shader: Shader, factor_of: Callable[[Shader], tuple[float, bool]]) -> Iterator[Part]:
    """The shaders that a tree of shaders mixes and adds, each once, without those whose share is 0.

    factor_of: of a Mix Shader, 0 to 1, and whether it is a constant; called once for each.
    """
    shares = {shader: (1.0, True)}
    for each in reversed(_fed_first(shader, set())):
        share, is_sure = shares.get(each, (0.0, True))
        if is_sure and share == 0:
            continue
        sockets = mixed_sockets(each)
        if sockets is None:
            yield Part(each, share, is_sure)
            continue
        factors = (1.0,) * len(sockets)
        if each.node.type == "MIX_SHADER" and not each.node.mute:
            factor, is_constant = factor_of(each)
            factors, is_sure = (1 - factor, factor), is_sure and is_constant
        for socket, factor in zip(sockets, factors, strict=True):
            found = each.feeding(socket)
            if found is not None:
                before, was_sure = shares.get(found, (0.0, True))
                shares[found] = before + share * factor, was_sure and is_sure


def mixed_sockets(shader: Shader) -> list[Socket] | None:
    """The sockets of the shaders that this one mixes, adds or passes on; None if it does nothing of that."""
    node = shader.node
    if node.mute:
        link = passed_through_link(node)
        return [link.from_socket] if link else []
    return {"ADD_SHADER": node.inputs[:], "MIX_SHADER": node.inputs[1:]}.get(node.type)


def folded(
    shader: Shader | None,
    leaf: Callable[[Shader], Any],
    joined: Callable[[Shader, list[tuple[Shader | None, Any]]], Any],
    nothing: Any,
) -> Any:
    """What a tree of shaders comes to.

    leaf: of a shader that mixes no others. joined: of one that mixes, adds or passes on others, with what these come
    to. nothing: without a shader, and where a ring of shaders closes.
    """
    made: dict[Shader, Any] = {}

    def value(shader: Shader | None) -> Any:
        if shader is None:
            return nothing
        if shader not in made:
            made[shader] = nothing
            sockets = mixed_sockets(shader)
            fed = [shader.feeding(socket) for socket in sockets or ()]
            made[shader] = leaf(shader) if sockets is None else joined(shader, [(each, value(each)) for each in fed])
        return made[shader]

    return value(shader)


def _fed_first(shader: Shader, reached: set[Shader]) -> list[Shader]:
    """A tree of shaders, each once and before all that it is mixed into; in a ring, before all but one.

    reached: those that are listed already, to which these are added.
    """
    reached.add(shader)
    order = []
    for socket in reversed(mixed_sockets(shader) or ()):
        found = shader.feeding(socket)
        if found is not None and found not in reached:
            order += _fed_first(found, reached)
    return [*order, shader]
