# SPDX-License-Identifier: GPL-3.0-or-later
"""The Surfels tab in the 3D view's sidebar: conversion, with a prediction of its result."""

from __future__ import annotations

import bpy

from ...faults import sentence_of
from ...sampling import UNKNOWN_FLAT_EXTENTS
from ..conversion.automatic_density import automatic_spacing
from ..conversion.camera_density import without_camera
from ..conversion.density_reason import Reason, sentences
from ..conversion.gathering import frame_of, groups
from ..conversion.mesh_conversion import Choices
from ..conversion.mesh_settings import PROPERTY_NAMES, choices, draw_properties
from ..conversion.prediction import Extent, known_extents
from ..conversion.source_record import record_of, sources_of
from ..doors import register_classes_factory
from ..export.object_detail import detail_of, finer
from ..geometry.sources import is_surfel_object
from ..geometry.surfel_files import file_of
from ..ids import (
    CONVERSION_SETTINGS,
    MESH_SETTINGS,
    OBJECT_SETTINGS,
    SHOW_SURFELS,
    SIDEBAR_PANEL,
    SIDEBAR_TAB,
    STORE_SURFELS,
    SURFELS_FROM_MESH,
    UPDATE_SURFELS,
)
from ..operators.show_surfels import shows_surfels
from ..operators.surfels_from_mesh import selected_sources
from ..operators.update_surfels import updatable
from ..spoken import said
from .preset_panels import VIEW3D_PT_surfel_conversion_presets
from .wrapped_text import write


class VIEW3D_PT_surfels_from_mesh(bpy.types.Panel):
    bl_idname = SIDEBAR_PANEL
    bl_label = "From Meshes"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = SIDEBAR_TAB

    def draw_header_preset(self, context):
        VIEW3D_PT_surfel_conversion_presets.draw_panel_header(self.layout)

    def draw(self, context):
        settings = getattr(context.scene, CONVERSION_SETTINGS)
        draw_properties(self.layout, settings)
        sources = selected_sources(context)
        if context.active_object in sources:
            self.layout.prop(getattr(context.active_object, OBJECT_SETTINGS), "detail")
        for k, line in enumerate(advice(context, sources, choices(settings)).splitlines()):
            write(self.layout, line, context, "BLANK1" if k else "INFO")
        row = self.layout.row()
        # For surfels its poll is true, because Adjust Last Operation asks it before it undoes the conversion.
        row.enabled = bool(sources)
        button = row.operator(SURFELS_FROM_MESH, icon="OUTLINER_OB_POINTCLOUD")
        for name in PROPERTY_NAMES:
            setattr(button, name, getattr(settings, name))
        self._draw_surfels(context)

    def _draw_unread(self, sentences: list[str], context):
        """Draw the material inputs that could not be read, and the button that bakes them."""
        if not sentences:
            return
        box = self.layout.box()
        for sentence in sentences:
            write(box, sentence, context)
        box.operator(UPDATE_SURFELS, text="Bake Materials", icon="RENDER_STILL").bake = True

    def _draw_surfels(self, context):
        """Draw the actions for the active object if it is surfels."""
        if context.active_object in updatable(context):
            names = ", ".join(source.name for source in sources_of(context.active_object))
            self.layout.operator(UPDATE_SURFELS, text=said("Update from {names}", names=names), icon="FILE_REFRESH")
            self._draw_unread(record_of(context.active_object).unread.splitlines(), context)
        owner = context.active_object
        if owner is not None and file_of(owner):
            self.layout.prop(getattr(owner.data, MESH_SETTINGS), "file")
        elif owner is not None and is_surfel_object(owner):
            self.layout.operator(STORE_SURFELS, icon="FILE_NEW")
        # Other engines show a surfel object as points.
        if context.active_object is not None and is_surfel_object(context.active_object) and not shows_surfels(context):
            self.layout.operator(SHOW_SURFELS, icon="SHADING_RENDERED")


def advice(context: bpy.types.Context, sources: list[bpy.types.Object], asked: Choices) -> str:
    """Lines about what the sources will become, or what to select. Nothing is missing while surfels are selected."""
    if sources and context.mode == "OBJECT":
        return prediction(context, sources, asked)
    if context.mode == "OBJECT" and any(map(is_surfel_object, context.selected_objects)):
        return ""
    return said("Select objects with surfaces, in Object Mode")


def prediction(context: bpy.types.Context, sources: list[bpy.types.Object], asked: Choices) -> str:
    """Lines about what the sources will become and why at that density, or why they cannot be converted."""
    parts = groups(sources, context.active_object, asked.join)
    extents = known_extents(parts, asked)
    if extents is None:
        return said("Counting …")
    try:
        found = [_density_of(*pair, asked, context.view_layer.depsgraph) for pair in zip(parts, extents, strict=True)]
    except Exception as error:
        return sentence_of(error)
    text = prediction_text([extent.predict(f) for extent, (f, _) in zip(extents, found, strict=True)])
    if asked.tolerance or any(extent.flat is UNKNOWN_FLAT_EXTENTS for extent in extents):
        text = said("{count}, fewer where flat", count=text)
    return "\n".join([text, *sentences(reason for _, reason in found if reason)])


def _density_of(sources, extent: Extent, asked: Choices, depsgraph) -> tuple[dict[str, float], Reason | None]:
    """The density in the form that `Extent.predict` takes, and the reason if it is automatic. Raises ValueError."""
    detail, frame = detail_of(sources[0]), frame_of(sources[0], asked.in_world_units)
    if "automatic" not in asked.density:
        return without_camera(finer(asked.density, detail), lambda: extent.surface, frame, depsgraph), None
    what = asked.density["automatic"], lambda: extent.surface, extent.area, extent.longest_edge
    spacing, reason = automatic_spacing(*what, frame, depsgraph, sources, detail, extent.flat.saved)
    return {"spacing": spacing}, reason


def prediction_text(predictions: list[tuple[int, float]]) -> str:
    """A text with the total number of surfels and their spacing."""
    counts, spacings = zip(*predictions, strict=True)
    if not sum(counts):
        return said("Nothing to sample: no faces, or a density of 0")
    low, high = (f"{bound(spacings):.3g}" for bound in (min, max))
    if low == high:
        return said("≈ {count:,} surfels, spacing {spacing}", count=sum(counts), spacing=low)
    return said("≈ {count:,} surfels, spacing {low} to {high}", count=sum(counts), low=low, high=high)


register, unregister = register_classes_factory((VIEW3D_PT_surfels_from_mesh,))
