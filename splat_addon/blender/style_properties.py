# SPDX-License-Identifier: GPL-3.0-or-later
"""The toon shading and the lines of a material or an object, where these are not those of the scene."""

from __future__ import annotations

import bpy
from bpy.props import EnumProperty, FloatProperty, FloatVectorProperty, IntProperty, PointerProperty

from ..rendering import LineStyle, Settings
from ..rendering.scene.lines import MAX_WIDTH
from ..rendering.settings import MAX_TOON_STEPS
from .ids import MATERIAL_SETTINGS
from .registration import OVERRIDABLE, with_property


def _shading(above: str, described: str) -> EnumProperty:
    return EnumProperty(
        name="Shading",
        description="How the amount of light becomes a color",
        items=(
            ("ABOVE", above, described),
            ("STEPS", "Steps", "Show the light in even steps"),
            ("RAMP", "Color Ramp", "Look up the light in the color ramp of a texture"),
        ),
        default="ABOVE",
        override=OVERRIDABLE,
    )


def _lines(above: str, described: str) -> EnumProperty:
    return EnumProperty(
        name="Lines",
        description="The lines along its silhouettes and creases",
        items=(
            ("ABOVE", above, described),
            ("OWN", "Own", "Draw lines of a width and a color of their own"),
            ("NONE", "None", "Draw no lines"),
        ),
        default="ABOVE",
        override=OVERRIDABLE,
    )


class StyleProperties:
    """What a material and an object have alike."""

    steps: IntProperty(
        name="Steps",
        description="Levels of brightness",
        min=2,
        max=MAX_TOON_STEPS,
        default=Settings.toon_steps,
        override=OVERRIDABLE,
    )
    ramp: PointerProperty(
        name="Ramp",
        description=(
            "Texture whose color ramp is looked up by the amount of light, from none at the left to full light at "
            "the right. Without a texture, three even greys are used"
        ),
        type=bpy.types.Texture,
        override=OVERRIDABLE,
    )
    line_width: FloatProperty(
        name="Width",
        description="Width of the lines",
        subtype="PIXEL",
        min=0.1,
        max=MAX_WIDTH,
        soft_max=6.0,
        default=LineStyle.width,
        override=OVERRIDABLE,
    )
    line_color: FloatVectorProperty(
        name="Color",
        description="Color of the lines",
        subtype="COLOR",
        min=0.0,
        max=1.0,
        default=LineStyle.color,
        override=OVERRIDABLE,
    )


class SurfelMaterialStyle(StyleProperties, bpy.types.PropertyGroup):
    """A material's: `material.surfel_splatting`."""

    shading: _shading("From Scene", "Shade it as the render properties say, or by the ramp that its nodes have")
    lines: _lines("From Scene", "Draw the lines that the render properties say")


class SurfelObjectStyle(StyleProperties, bpy.types.PropertyGroup):
    """An object's, which replaces that of its materials: `object.surfel_splatting.style`."""

    shading: _shading("From Materials", "Shade it as its materials say")
    lines: _lines("From Materials", "Draw the lines that its materials say")


def draw_style(layout: bpy.types.UILayout, style: SurfelMaterialStyle | SurfelObjectStyle) -> None:
    layout.prop(style, "shading")
    if style.shading == "STEPS":
        layout.prop(style, "steps")
    elif style.shading == "RAMP":
        layout.template_ID(style, "ramp", new="texture.new")
        if style.ramp is not None and style.ramp.use_color_ramp:
            layout.template_color_ramp(style.ramp, "color_ramp")
    layout.prop(style, "lines")
    if style.lines == "OWN":
        layout.prop(style, "line_width")
        layout.prop(style, "line_color")


register, unregister = with_property(bpy.types.Material, MATERIAL_SETTINGS, SurfelMaterialStyle)
