# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the shaders of a world, mixed and added, as a sum of Background nodes: one for the light that surfaces receive,
and one for what the camera sees.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import bpy

from ..materials.node_products import linked, passed_through_link, product
from ..materials.texture_images import UnreadableError


class Background(NamedTuple):
    """A Background node, or an Emission node, which does the same in a world. share: by which it is multiplied."""

    node: bpy.types.Node
    share: float


#: Outputs of a Light Path node that are 1 for the rays: those that bring light to surfaces, and the camera's.
_LIGHT, _CAMERA = frozenset({"Is Diffuse Ray"}), frozenset({"Is Camera Ray"})


def backgrounds(world: bpy.types.World, notes) -> tuple[list[Background], list[Background]]:
    """What lights the scene, and what the camera sees."""
    output = world.node_tree.get_output_node("ALL")
    if output is None:
        return [], []
    owner, surface = f"The world {world.name!r}", output.inputs["Surface"]
    light, seen = (list(_Reading(owner, rays, notes).read(surface, 1.0)) for rays in (_LIGHT, _CAMERA))
    return light, seen


class _Reading(NamedTuple):
    """owner: the subject of a sentence. rays: one of those above."""

    owner: str
    rays: frozenset[str]
    notes: object

    def read(
        self, socket: bpy.types.NodeSocket, share: float, followed: tuple[bpy.types.Node, ...] = ()
    ) -> Iterator[Background]:
        """The backgrounds that feed a socket and are not multiplied by 0. followed: the nodes that they are mixed
        into; a ring of them ends."""
        source = linked(socket)
        if source is None or share == 0 or source[0] in followed:
            return
        node = source[0]
        followed = (*followed, node)
        if node.mute:
            if link := passed_through_link(node):
                yield from self.read(link.from_socket, share, followed)
        elif node.type == "MIX_SHADER":
            factor, first, second = node.inputs
            part = self._factor(factor)
            yield from self.read(first, share * (1 - part), followed)
            yield from self.read(second, share * part, followed)
        elif node.type == "ADD_SHADER":
            for each in node.inputs:
                yield from self.read(each, share, followed)
        elif node.type in ("BACKGROUND", "EMISSION"):
            yield Background(node, share)
        else:
            self.notes.add(f"{self.owner} has a {node.bl_label} node, which counts as black")

    def _factor(self, socket: bpy.types.NodeSocket) -> float:
        """The factor of a Mix Shader, 0 to 1."""
        source = linked(socket)
        if source is not None and source[0].type == "LIGHT_PATH" and source[1].startswith("Is "):
            if source[1] not in _LIGHT | _CAMERA:
                self.notes.add(f"{self.owner} asks for {source[1]}; everything is lit by what diffuse rays meet")
            return float(source[1] in self.rays)
        reason = "a texture"
        try:
            read = product(socket)
            if not read.sources:
                return min(max(read.value[0], 0.0), 1.0)
        except UnreadableError as error:
            reason = str(error)
        self.notes.add(f"{self.owner} mixes its shaders by {reason}; the plain value of the factor's socket is used")
        return min(max(socket.default_value, 0.0), 1.0)
