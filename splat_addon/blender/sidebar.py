# SPDX-License-Identifier: GPL-3.0-or-later
"""The Surfels tab in the 3D view's sidebar: the conversion, and what it will make before it is pressed."""

from __future__ import annotations

import bpy

from .conversion_settings import PROPERTY_NAMES, choices, draw_properties
from .ids import CONVERSION_SETTINGS, SIDEBAR_PANEL, SIDEBAR_TAB, SURFELS_FROM_MESH
from .operators.surfels_from_mesh import selected_meshes
from .prediction import Extent, known_extents


class VIEW3D_PT_surfels_from_mesh(bpy.types.Panel):
    bl_idname = SIDEBAR_PANEL
    bl_label = "From Meshes"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = SIDEBAR_TAB

    def draw(self, context):
        settings = getattr(context.scene, CONVERSION_SETTINGS)
        draw_properties(self.layout, settings)
        sources = selected_meshes(context)
        if sources and context.mode == "OBJECT":
            text = prediction_text(known_extents(sources), choices(settings).fineness)
        else:
            text = "Select a mesh with faces, in object mode"
        self.layout.label(text=text, icon="INFO")
        button = self.layout.operator(SURFELS_FROM_MESH, icon="OUTLINER_OB_POINTCLOUD")
        for name in PROPERTY_NAMES:
            setattr(button, name, getattr(settings, name))


def prediction_text(extents: list[Extent] | None, fineness: dict[str, float]) -> str:
    """One line: the number of surfels that the sources will become, and how far apart those will lie."""
    if extents is None:
        return "Counting …"
    counts, spacings = zip(*(extent.predict(fineness) for extent in extents), strict=True)
    if not sum(counts):
        return "Nothing to sample: no faces, or a density of 0"
    low, high = (f"{bound(spacings):.3g}" for bound in (min, max))
    return f"≈ {sum(counts):,} surfels, spacing {low if low == high else f'{low} to {high}'}"


register, unregister = bpy.utils.register_classes_factory((VIEW3D_PT_surfels_from_mesh,))
