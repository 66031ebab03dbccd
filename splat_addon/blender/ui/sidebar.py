# SPDX-License-Identifier: GPL-3.0-or-later
"""The Surfels tab in the 3D view's sidebar. Its status, its large button and what is shown come first and keep their
place; below are the settings of the conversion, with a prediction of its result."""

from __future__ import annotations

import bpy

from ..conversion.color_watch import why_out_of_date
from ..conversion.mesh_settings import PROPERTY_NAMES, choices
from ..conversion.mesh_settings_layout import draw_advanced, draw_density, draw_edges, draw_looks, draw_once
from ..conversion.points_settings import (
    POINTS_NAMES,
    draw_estimates,
    draw_gaussian_properties,
    draw_points_edges,
)
from ..conversion.quality import QUALITIES, expected_error
from ..conversion.series import series_of
from ..conversion.source_record import record_of, sources_of
from ..doors import register_classes_factory
from ..geometry.scan_attributes import scanner_path_of
from ..geometry.scene_offset import scene_offset, shown
from ..geometry.surfel_files import file_of
from ..ids import (
    CAMERA_OF_SCANNER,
    CONVERSION_SETTINGS,
    EXPORT_PLY,
    FILTER_SCAN,
    IMPORT_FILE,
    MESH_SETTINGS,
    OBJECT_SETTINGS,
    POINTS_SETTINGS,
    SCAN_LOOK,
    SELECT_STRAYS,
    SHOW_SURFELS,
    SIDEBAR_PANEL,
    SIDEBAR_TAB,
    STORE_SURFELS,
    UPDATE_SURFELS,
)
from ..operators.show_surfels import shows_surfels
from ..operators.surfels_from_mesh import selected_sources
from ..operators.surfels_or_source import draw_choice
from ..spoken import said
from .chosen import MESHES, NOTHING, POINTS, SURFELS, Chosen, chosen, status
from .predicted import prediction
from .preset_panels import VIEW3D_PT_surfel_conversion_presets
from .wrapped_text import write

#: The height of the large button, in those of others.
_LARGE = 1.6


class VIEW3D_PT_surfels(bpy.types.Panel):
    bl_idname = SIDEBAR_PANEL
    bl_label = "Surfels"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = SIDEBAR_TAB

    def draw_header_preset(self, context):
        VIEW3D_PT_surfel_conversion_presets.draw_panel_header(self.layout)

    def draw(self, context):
        layout, what = self.layout, chosen(context)
        layout.label(text=status(what), icon=what.kind.icon)
        _draw_button(layout, what, context)
        layout.operator(SHOW_SURFELS, icon="SHADING_RENDERED", depress=shows_surfels(context))
        draw_choice(layout, what.made if what.can_update and context.mode == "OBJECT" else None)
        for line in advice(what, context):
            write(layout, line, context, "INFO")
        _draw_scan(layout, what)
        _draw_settings(layout, what, context)
        _draw_files(layout, what, context)


def advice(what: Chosen, context: bpy.types.Context) -> list[str]:
    """What to do that the button does not say."""
    if what.kind is SURFELS and what.made is not None and (why := why_out_of_date(what.made)):
        return [said("The colours are out of date: {why}", why=why)]
    if what.kind is SURFELS and what.lead == what.made and context.mode in _BRUSHES:
        if what.source is None:
            return [said("Brushes need faces, and surfels have none")]
        return [said("Brushes need faces: paint {name}, or sculpt it and press Update", name=what.source.name)]
    if what.kind in (MESHES, NOTHING):
        return [said("Meshes need no conversion: choose the engine and press F12")]
    return []


#: Modes of brushes that need faces.
_BRUSHES = frozenset({"SCULPT", "PAINT_VERTEX", "PAINT_WEIGHT", "PAINT_TEXTURE"})


def settings_of(what: Chosen, context: bpy.types.Context):
    """The settings that the button will use: those of the scene, or of the surfels that it updates; None if it is
    disabled for good. The kind of surfels is in their record."""
    if what.kind is SURFELS:
        record = record_of(what.made)
        return {"MESH": record.mesh, "POINTS": record.points}[record.kind] if what.can_update else None
    return getattr(context.scene, POINTS_SETTINGS if what.kind is POINTS else CONVERSION_SETTINGS)


def _is_of_points(what: Chosen) -> bool:
    return what.kind is POINTS or (what.kind is SURFELS and record_of(what.made).kind == "POINTS")


def _draw_button(layout: bpy.types.UILayout, what: Chosen, context: bpy.types.Context) -> None:
    row = layout.row()
    row.scale_y = _LARGE
    if what.kind is SURFELS:
        row.enabled = what.can_update
        row.operator(UPDATE_SURFELS, text="Update", icon="FILE_REFRESH")
        return
    # For surfels its poll is true, because Adjust Last Operation asks it before it undoes the conversion.
    row.enabled = what.kind is not NOTHING and context.mode == "OBJECT"
    button = row.operator(what.kind.operator, icon="OUTLINER_OB_POINTCLOUD")
    settings = settings_of(what, context)
    for name in POINTS_NAMES if what.kind is POINTS else PROPERTY_NAMES:
        setattr(button, name, getattr(settings, name))


def _draw_settings(layout: bpy.types.UILayout, what: Chosen, context: bpy.types.Context) -> None:
    settings = settings_of(what, context)
    if settings is None:
        return
    is_of_points, is_made = _is_of_points(what), what.kind is SURFELS
    if not is_of_points:
        _draw_quality(layout, what, settings, context)
    layout = layout.column()
    layout.use_property_split = True
    layout.use_property_decorate = False
    if is_of_points:
        draw_estimates(layout, settings)
    if not is_made:
        layout.prop(settings, "follow")
    if not is_of_points:
        draw_looks(layout, settings)
        _draw_unread(layout, what, context)
    header, edges = layout.panel("surfels_edges", default_closed=True)
    header.label(text="Edges")
    if edges:
        (draw_points_edges if is_of_points else draw_edges)(edges, settings)
    header, advanced = layout.panel("surfels_advanced", default_closed=True)
    header.label(text="Advanced")
    if advanced:
        (_draw_advanced_of_points if is_of_points else _draw_advanced)(advanced, what, settings)


def _draw_advanced(layout: bpy.types.UILayout, what: Chosen, settings) -> None:
    draw_density(layout, settings)
    if what.lead is not None:
        layout.prop(getattr(what.source or what.lead, OBJECT_SETTINGS), "detail")
    draw_advanced(layout, settings)
    if what.kind is not SURFELS:
        draw_once(layout, settings)


def _draw_advanced_of_points(layout: bpy.types.UILayout, what: Chosen, settings) -> None:
    layout.prop(settings, "flattens_noise")
    layout.prop(settings, "splat_size")
    draw_gaussian_properties(layout, settings)
    if what.kind is not SURFELS:
        layout.row().prop(settings, "source", expand=True)


def _draw_quality(layout: bpy.types.UILayout, what: Chosen, settings, context: bpy.types.Context) -> None:
    row = layout.row(align=True)
    for name in QUALITIES:
        row.prop_enum(settings, "quality", name)
    if error := expected_error(settings):
        layout.prop(settings, "error")
        worst = said("Error up to {worst} where detail is finer than a pixel", worst=f"{error[1]:.2g}")
        write(layout, worst, context, "BLANK1")
    if what.kind is NOTHING or context.mode != "OBJECT":
        return
    sources = sources_of(what.made) if what.kind is SURFELS else selected_sources(context)
    for line in prediction(context, sources, choices(settings)).splitlines():
        write(layout, line, context, "BLANK1")


def _draw_unread(layout: bpy.types.UILayout, what: Chosen, context: bpy.types.Context) -> None:
    """Draw the material inputs that could not be read, and the button that bakes them."""
    sentences = record_of(what.made).unread.splitlines() if what.kind is SURFELS else []
    if not sentences:
        return
    box = layout.box()
    for sentence in sentences:
        write(box, sentence, context)
    box.operator(UPDATE_SURFELS, text="Bake Materials", icon="RENDER_STILL").bake = True


def _draw_scan(layout: bpy.types.UILayout, what: Chosen) -> None:
    """Draw how the colours of surfels without a source are shown, which a scan may be."""
    if what.kind is not SURFELS or what.source is not None:
        return
    layout.operator(SCAN_LOOK, icon="SHADING_TEXTURE")
    layout.operator(SELECT_STRAYS, icon="RESTRICT_SELECT_OFF")
    layout.operator(FILTER_SCAN, icon="FILTER")
    if len(scanner_path_of(what.made.data)):
        layout.operator(CAMERA_OF_SCANNER, icon="OUTLINER_OB_CAMERA")
    column = layout.column()
    column.use_property_split = True
    column.use_property_decorate = False
    column.prop(getattr(what.made, OBJECT_SETTINGS), "color_by")


def _draw_files(layout: bpy.types.UILayout, what: Chosen, context: bpy.types.Context) -> None:
    header, files = layout.panel("surfels_files", default_closed=True)
    header.label(text="Files")
    if files is None:
        return
    if what.made is not None and file_of(what.made):
        files.prop(getattr(what.made.data, MESH_SETTINGS), "file")
    elif what.made is not None and (series := series_of(what.made.data)).path:
        files.prop(series, "path")
        files.prop(series, "frame_offset")
        if series.why_not:
            write(files, series.why_not, context)
    elif what.made is not None:
        files.operator(STORE_SURFELS, icon="FILE_NEW")
    row = files.row(align=True)
    # "Invoke" asks for the file; a sidebar's own way would run at once.
    row.operator_context = "INVOKE_DEFAULT"
    row.operator(IMPORT_FILE, icon="IMPORT")
    row.operator(EXPORT_PLY, icon="EXPORT")
    offset = scene_offset(context.scene)
    if offset.any():
        write(files, said("Offset of the coordinates: {offset}", offset=shown(offset)), context, "INFO")


register, unregister = register_classes_factory((VIEW3D_PT_surfels,))
