# SPDX-License-Identifier: GPL-3.0-or-later
"""Radiance that worlds, lights and materials send out, within the renderer's limits."""

from __future__ import annotations

from ..materials.graphs.channels import constant_of
from ..materials.socket_ranges import is_radiance
from ..materials.surface_shaders import Shader


def color_times_strength(shader: Shader, owner: str, notes) -> tuple[float, float, float]:
    """Colour times strength of a Background or Emission shader. owner: the subject of a sentence."""
    read = {}
    for name, said in (("Color", "colour"), ("Strength", "strength")):
        read[name] = constant_of(shader, name) if shader.socket(name).is_linked else shader.plain(name).value
        if read[name] is None:
            notes.add(f"{owner} is textured; its {shader.node.bl_label} node's plain {said} is used")
            read[name] = shader.plain(name).value
    (strength,) = read["Strength"]
    return tuple(channel * strength for channel in read["Color"])


BLACK = (0.0, 0.0, 0.0)


def finite_radiance(radiance: tuple[float, float, float], owner: str, notes) -> tuple[float, float, float]:
    """The radiance; if pictures cannot represent it, black and a note. owner: the subject of a sentence."""
    if is_radiance(radiance):
        return radiance
    red, green, blue = radiance
    notes.add(f"{owner} emits {red:g}, {green:g}, {blue:g}, more than a picture can store; it is rendered black")
    return BLACK
