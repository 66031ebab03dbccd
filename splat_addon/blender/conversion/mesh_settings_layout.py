# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the settings of a conversion, in parts: for the sidebar, the redo panel and the preferences."""

from __future__ import annotations

import bpy

from ...sampling import REDUCTIONS
from ..density_properties import DENSITIES
from .mesh_settings import ConversionProperties


def draw_properties(layout: bpy.types.UILayout, properties: ConversionProperties) -> None:
    """All settings in Blender's own style, for the redo panel and the preferences."""
    layout.use_property_split = True
    layout.use_property_decorate = False
    draw_density(layout, properties)
    draw_looks(layout, properties)
    layout.prop(properties, "follow")
    draw_edges(layout, properties)
    draw_advanced(layout, properties)
    draw_once(layout, properties)


def draw_looks(layout: bpy.types.UILayout, properties: ConversionProperties) -> None:
    """Draw how the look of materials comes to the surfels."""
    layout.prop(properties, "bake_materials")
    layout.prop(properties, "texture_mapped")


def draw_edges(layout: bpy.types.UILayout, properties: ConversionProperties) -> None:
    layout.prop(properties, "clips_edges")
    if properties.clips_edges:
        layout.prop(properties, "crease_angle")


def draw_density(layout: bpy.types.UILayout, properties: ConversionProperties) -> None:
    layout.prop(properties, "density")
    layout.prop(properties, DENSITIES[properties.density].property)


def draw_advanced(layout: bpy.types.UILayout, properties: ConversionProperties) -> None:
    """Draw what few conversions need."""
    layout.prop(properties, "use_adaptive")
    if properties.use_adaptive:
        layout.prop(properties, "tolerance")
    layout.prop(properties, "normal_fields")
    layout.prop(properties, "splat_size")
    layout.prop(properties, "reduction")
    if REDUCTIONS[properties.reduction.lower()].has_angle:
        layout.prop(properties, "grazing_angle")


def draw_once(layout: bpy.types.UILayout, properties: ConversionProperties) -> None:
    """Draw what a conversion settles for good: an update cannot change it."""
    layout.prop(properties, "join")
    if not properties.join:
        layout.row().prop(properties, "space", expand=True)
    layout.row().prop(properties, "source", expand=True)
