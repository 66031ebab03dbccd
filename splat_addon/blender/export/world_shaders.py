# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the shaders of a world, mixed and added, as a sum of Background nodes: one for the light that surfaces receive,
and one for what the camera sees.
"""

from __future__ import annotations

from functools import partial

import bpy

from ..materials.node_products import product
from ..materials.node_walks import linked, outer
from ..materials.surface_shaders import Part, Shader, mix_factor, parts, surface_shader
from ..materials.texture_images import UnreadableError

#: Outputs of a Light Path node that are 1 for the rays: those that bring light to surfaces, and the camera's.
_LIGHT, _CAMERA = "Is Diffuse Ray", "Is Camera Ray"


def backgrounds(world: bpy.types.World, notes) -> tuple[list[Part], list[Part]]:
    """What lights the scene, and what the camera sees: Background nodes, and Emission nodes, which do the same."""
    shader, owner = surface_shader(world), f"The world {world.name!r}"
    if shader is None:
        return [], []
    light, seen = (list(parts(shader, factor_of=partial(_factor, owner, rays, notes))) for rays in (_LIGHT, _CAMERA))
    for part in (*light, *seen):
        if not _shines(part):
            notes.add(f"{owner} has a {part.shader.node.bl_label} node, which counts as black")
    return list(filter(_shines, light)), list(filter(_shines, seen))


def _shines(part: Part) -> bool:
    return part.shader.node.type in ("BACKGROUND", "EMISSION")


def _factor(owner: str, rays: str, notes, mix: Shader) -> tuple[float, bool]:
    """The factor of a Mix Shader for some rays, as `mix_factor`. owner: the subject of a sentence."""
    source = linked(outer(mix.node.inputs[0], mix.groups)[0])
    if source is not None and source[0].type == "LIGHT_PATH" and source[1].startswith("Is "):
        if source[1] not in (_LIGHT, _CAMERA):
            notes.add(f"{owner} asks for {source[1]}; everything is lit by what diffuse rays meet")
        return float(source[1] == rays), True
    factor, is_constant = mix_factor(mix)
    if not is_constant:
        notes.add(f"{owner} mixes its shaders by {_what_feeds(mix)}; the plain value of the factor's socket is used")
    return factor, True


def _what_feeds(mix: Shader) -> str:
    """What a factor comes from, if it is not a constant."""
    try:
        product(mix.node.inputs[0], mix.groups)
    except UnreadableError as error:
        return str(error)
    return "a texture"
