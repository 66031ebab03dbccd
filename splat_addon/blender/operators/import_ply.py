# SPDX-License-Identifier: GPL-3.0-or-later
"""File > Import > Surfels (.ply): turns a file of surfels, Gaussian splats or bare points into a surfel object."""

from __future__ import annotations

from pathlib import Path

import bpy
from bpy.props import StringProperty
from bpy_extras.io_utils import ImportHelper, poll_file_object_drop
from mathutils import Matrix

from ...interchange import Gaussians, Points, StoredSurfels, read_contents
from ...sampling import surfels_from_points
from ...surfels import Surfels
from ..conversion.points_settings import (
    PointsProperties,
    draw_gaussian_properties,
    draw_points_properties,
    keywords,
    viewpoint,
)
from ..conversion.surfel_objects import add_surfel_object, select_only
from ..ids import IMPORT_PLY
from ..spoken import said
from .file_paths import absolute, file_sentence, path_property
from .menu_entry import with_menu_entry


class IMPORT_SCENE_OT_surfels_ply(PointsProperties, ImportHelper, bpy.types.Operator):
    """Read surfels from a PLY file: one written by this extension, flat Gaussian splats, or any other points"""

    bl_idname = IMPORT_PLY
    bl_label = "Import Surfels"
    bl_options = {"REGISTER", "UNDO", "PRESET"}  # noqa: RUF012 - Blender reads a set

    filename_ext = ".ply"
    filepath: path_property("reading from", is_forgotten=True)
    filter_glob: StringProperty(default="*.ply", options={"HIDDEN"})

    def invoke(self, context, event):
        if not self.filepath:
            return super().invoke(context, event)
        # dropped: show the settings without a file browser
        return context.window_manager.invoke_props_dialog(self, title=Path(self.filepath).name, confirm_text="Import")

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        header, body = self.layout.panel("surfels_ply_gaussians")
        header.label(text="Gaussian Splats")
        if body:
            draw_gaussian_properties(body, self)
        header, body = self.layout.panel("surfels_ply_points")
        header.label(text="Points")
        if body:
            draw_points_properties(body, self)

    def execute(self, context):
        name = Path(self.filepath.removeprefix("//")).name
        try:
            contents = read_contents(absolute(self.filepath), self.flatness)
            surfels, notes = _READERS[type(contents)](contents, self, context)
            if not len(surfels):
                raise ValueError(f"The file gives no surfels{': ' if notes else ''}{'; '.join(notes)}.")
        except (ValueError, OSError, MemoryError) as error:
            self.report({"ERROR"}, f"{name}: {file_sentence(error)}")
            return {"CANCELLED"}
        made = add_surfel_object(Path(name).stem, surfels, Matrix(), [context.collection])
        select_only(context, [made])
        self.report({"INFO"}, said("{name}: {count:,} surfels", name=name, count=len(surfels)))
        for note in notes:
            self.report({"WARNING" if note.startswith("Skipped") else "INFO"}, note)
        return {"FINISHED"}


def _from_surfels(contents: StoredSurfels, properties, context) -> tuple[Surfels, list[str]]:
    return contents.surfels, [f"Skipped {contents.unusable:,} unusable surfels"] * bool(contents.unusable)


def _from_gaussians(contents: Gaussians, properties, context) -> tuple[Surfels, list[str]]:
    return contents.surfels, contents.notes()


def _from_points(contents: Points, properties, context) -> tuple[Surfels, list[str]]:
    eye = viewpoint(properties, context)
    surfels, report = surfels_from_points(
        contents.positions,
        contents.normals,
        contents.radii,
        contents.colors,
        viewpoint=None if eye is None else tuple(eye),
        **keywords(properties),
    )
    return surfels, list(report.notes())


#: What a file can contain -> function of it, the operator and the context that returns surfels and notes.
_READERS = {StoredSurfels: _from_surfels, Gaussians: _from_gaussians, Points: _from_points}


def draw_menu_entry(menu, context):
    menu.layout.operator(IMPORT_PLY, text="Surfels (.ply)")


class IO_FH_surfels_ply(bpy.types.FileHandler):
    """Handles files dropped on the 3D view or the Outliner; Blender asks which importer to use if its own accepts them
    too."""

    bl_idname = "IO_FH_surfels_ply"
    bl_label = "Surfels (.ply)"
    bl_import_operator = IMPORT_PLY
    bl_file_extensions = ".ply"

    @classmethod
    def poll_drop(cls, context):
        return poll_file_object_drop(context)


register, unregister = with_menu_entry(
    IMPORT_SCENE_OT_surfels_ply, bpy.types.TOPBAR_MT_file_import, draw_menu_entry, (IO_FH_surfels_ply,)
)
