# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the shaders of a world, mixed and added, as a sum of Background nodes: one for the light that surfaces receive,
and one for what the camera sees. Shaders that something mixes by direction stay a tree."""

from __future__ import annotations

from dataclasses import dataclass, field

import bpy

from ..materials.graphs.channels import constant_number
from ..materials.graphs.worlds import SHINING
from ..materials.node_walks import linked, outer
from ..materials.surface_shaders import Part, Shader, parts, surface_shader

#: Outputs of a Light Path node that are 1 for the rays: those that bring light to surfaces, and the camera's.
_LIGHT, _CAMERA = "Is Diffuse Ray", "Is Camera Ray"


@dataclass
class Backgrounds:
    """What some rays meet. added: Background nodes, and Emission nodes, which do the same. tree: the shader that mixes
    them by direction, if there is one; then the shares of those that are added are not known."""

    rays: str
    added: list[Part] = field(default_factory=list)
    tree: Shader | None = None
    #: whether a factor depends on the rays
    is_asked: bool = False

    def factor(self, mix: Shader) -> float | None:
        """The factor of a Mix Shader for these rays, 0 to 1; None if it depends on the direction."""
        source = linked(outer(mix.node.inputs[0], mix.groups)[0])
        if source is not None and source[0].type == "LIGHT_PATH" and source[1].startswith("Is "):
            self.is_asked = True
            return float(source[1] == self.rays)
        factor = constant_number(mix.node.inputs[0], mix.groups)
        return None if factor is None else min(max(factor, 0.0), 1.0)


def backgrounds(world: bpy.types.World, notes) -> tuple[Backgrounds, Backgrounds]:
    """What lights the scene, and what the camera sees."""
    shader, owner = surface_shader(world), f"The world {world.name!r}"
    found = Backgrounds(_LIGHT), Backgrounds(_CAMERA)
    for each in found if shader is not None else ():
        for part in parts(shader, factor_of=lambda mix, each=each: _share(each, mix, owner, notes)):
            if part.shader.node.type in SHINING:
                each.added.append(part)
            else:
                notes.add(f"{owner} has a {part.shader.node.bl_label} node, which counts as black")
            if not part.is_sure:
                each.tree = shader
    return found


def _share(rays: Backgrounds, mix: Shader, owner: str, notes) -> tuple[float, bool]:
    """The factor of a Mix Shader, as `parts` takes it. owner: the subject of a sentence."""
    source = linked(outer(mix.node.inputs[0], mix.groups)[0])
    if source is not None and source[0].type == "LIGHT_PATH" and source[1] not in (_LIGHT, _CAMERA):
        notes.add(f"{owner} asks for {source[1]}; everything is lit by what diffuse rays meet")
    factor = rays.factor(mix)
    # a share of something that varies: neither is left out
    return (0.5, False) if factor is None else (factor, True)
