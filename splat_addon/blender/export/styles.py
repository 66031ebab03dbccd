# SPDX-License-Identifier: GPL-3.0-or-later
"""The toon shading and the lines of materials and objects as the renderer's styles."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import bpy

from ...rendering import LineStyle, Material, Ramp, Style
from ..ids import MATERIAL_SETTINGS, OBJECT_SETTINGS, RENDER_SETTINGS
from ..materials.graphs.cartoons import cartoon_of
from ..materials.ramps import kept_ramp, ramp_of
from ..style_properties import StyleProperties

#: Objects whose numbers are alike in this remainder count as one where lines between objects are drawn, so that there
#: is room for all.
_GROUPS = 61


class ObjectStyle(NamedTuple):
    """What an object's style replaces of that of its materials; None: nothing. group: as of `Style`."""

    ramp: Ramp | None = None
    line: LineStyle | None = None
    group: int = 0

    def on(self, materials: tuple[Material, ...]) -> tuple[Material, ...]:
        if self == OF_MATERIALS:
            return materials
        return tuple(replace(material, style=self._over(material.style)) for material in materials)

    def _over(self, style: Style) -> Style:
        return Style(self.ramp or style.ramp, self.line or style.line, self.group)


OF_MATERIALS = ObjectStyle()


def style_of(owner: bpy.types.Object, scene: bpy.types.Scene) -> ObjectStyle:
    """What an object in the file replaces."""
    settings, of_scene = getattr(owner, OBJECT_SETTINGS).style, getattr(scene, RENDER_SETTINGS)
    group = 1 + owner.session_uid % _GROUPS if of_scene.use_lines and of_scene.lines_meet else 0
    return ObjectStyle(_ramp(settings), _line(settings), group)


def style_of_material(material: bpy.types.Material) -> Style:
    settings = getattr(material.original, MATERIAL_SETTINGS)
    cartoon = cartoon_of(material) if settings.shading == "ABOVE" else None
    return Style(kept_ramp(cartoon.colors) if cartoon else _ramp(settings), _line(settings))


def _ramp(settings: StyleProperties) -> Ramp | None:
    if settings.shading == "STEPS":
        return kept_ramp(Ramp.of_steps(settings.steps).colors)
    return ramp_of(settings.ramp) if settings.shading == "RAMP" else None


def _line(settings: StyleProperties) -> LineStyle | None:
    if settings.lines == "OWN":
        return LineStyle(settings.line_width, tuple(settings.line_color))
    return LineStyle(0.0) if settings.lines == "NONE" else None
