# SPDX-License-Identifier: GPL-3.0-or-later
"""File > Export > Surfels (.ply): surfel objects, as their modifiers make them, in world coordinates plus the
scene's offset."""

from __future__ import annotations

from dataclasses import replace

import bpy
from bpy.props import BoolProperty, EnumProperty, StringProperty
from bpy_extras.io_utils import ExportHelper

from ...interchange import write_gaussian_ply, write_ply
from ..conversion.color_watch import refresh
from ..geometry.attributes import has_surfels
from ..geometry.scene_offset import scene_offset
from ..geometry.surfel_files import file_of
from ..geometry.world_surfels import world_surfels
from ..ids import EXPORT_PLY
from ..spoken import said
from .file_paths import absolute, file_sentence, path_property
from .menu_entry import with_menu_entry

#: The operator's choice -> function that writes sets of surfels to a path, optionally as text, and returns what to say.
_WRITERS = {
    "SURFELS": write_ply,
    "GAUSSIANS": lambda path, parts, ascii: write_gaussian_ply(path, parts),
}


class EXPORT_SCENE_OT_surfels_ply(ExportHelper, bpy.types.Operator):
    """Write surfels to a PLY file, either losslessly or as Gaussian splats"""

    bl_idname = EXPORT_PLY
    bl_label = "Export Surfels"
    bl_options = {"PRESET"}  # noqa: RUF012 - Blender reads a set

    filename_ext = ".ply"
    filepath: path_property("writing to")
    filter_glob: StringProperty(default="*.ply", options={"HIDDEN"})
    layout_kind: EnumProperty(
        name="Layout",
        description="What the file holds",
        items=(
            ("SURFELS", "Surfels", "All properties, exactly; other programs read the positions, normals and colours"),
            ("GAUSSIANS", "Gaussian Splats", "Flat 3D Gaussians, which viewers of Gaussian splats read"),
        ),
        default="SURFELS",
    )
    ascii: BoolProperty(
        name="Text",
        description="Write a text file, which is several times as large. Surfels only",
        default=False,
    )
    use_selection: BoolProperty(
        name="Selected Only",
        description="Write the selected surfel objects, and not all visible ones",
        default=False,
    )

    @classmethod
    def poll(cls, context):
        if any(map(_may_hold_surfels, context.visible_objects)):
            return True
        cls.poll_message_set(said("No visible object holds surfels; convert one first"))
        return False

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        for name in ("layout_kind", "use_selection"):
            self.layout.prop(self, name)
        row = self.layout.row()
        row.active = self.layout_kind == "SURFELS"
        row.prop(self, "ascii")

    def execute(self, context):
        refresh(context)
        candidates = context.selected_objects if self.use_selection else context.visible_objects
        try:
            parts, unusable = world_surfels(candidates, context.evaluated_depsgraph_get())
            if not parts:
                raise ValueError(
                    said("No selected object is surfels; convert one first, or choose others")
                    if self.use_selection
                    else said("No visible object is surfels; convert one first, or choose others")
                )
            offset = scene_offset(context.scene)
            parts = [replace(part, origin=part.origin + offset) for part in parts]
            path = absolute(self.filepath)
            notes = _WRITERS[self.layout_kind](path, parts, self.ascii)
        except OSError as error:
            why = file_sentence(error)
            self.report({"ERROR"}, said("{path} cannot be written: {why}", path=self.filepath, why=why))
            return {"CANCELLED"}
        except Exception as error:
            self.report({"ERROR"}, file_sentence(error))
            return {"CANCELLED"}
        if unusable:
            self.report({"WARNING"}, said("Skipped {count:,} unusable surfels", count=unusable))
        if coarse := [candidate.name for candidate in candidates if file_of(candidate)]:
            why = said(
                "The surfels of {names} are in files of their own; only the coarsest were written",
                names=", ".join(coarse),
            )
            self.report({"WARNING"}, why)
        for note in notes:
            self.report({"WARNING"}, note)
        values = {"count": sum(map(len, parts)), "objects": len(parts), "path": path}
        self.report({"INFO"}, said("{count:,} surfels of {objects} objects -> {path}", **values))
        return {"FINISHED"}


def _may_hold_surfels(candidate: bpy.types.Object) -> bool:
    """Whether the object stores surfels, or has modifiers that may make some. It looks at no evaluated data, because
    menus ask each time they are drawn."""
    if candidate.type not in {"MESH", "POINTCLOUD"}:
        return False
    return has_surfels(candidate.data) or any(modifier.type == "NODES" for modifier in candidate.modifiers)


def draw_menu_entry(menu, context):
    menu.layout.operator(EXPORT_PLY, text="Surfels (.ply)")


register, unregister = with_menu_entry(EXPORT_SCENE_OT_surfels_ply, bpy.types.TOPBAR_MT_file_export, draw_menu_entry)
