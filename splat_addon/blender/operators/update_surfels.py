# SPDX-License-Identifier: GPL-3.0-or-later
"""Object > Update Surfels from Source: converts the sources of surfel objects again, with the recorded settings."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty

from ..conversion.batch import Batch, ConversionBatch
from ..conversion.following import follow_visibility, follows
from ..conversion.made_of import surfels_of
from ..conversion.mesh_settings import choices
from ..conversion.points_conversion import PointsBatch
from ..conversion.points_settings import keywords, viewpoint
from ..conversion.source_record import record_of, sources_of
from ..conversion.ties import keep_unread, tie_shape
from ..ids import UPDATE_SURFELS
from ..spoken import said
from .menu_entry import with_menu_entry


def updatable(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The selected surfel objects that know their sources, and those of this view layer whose source is selected."""
    found = {}
    for selected in context.selected_objects:
        is_made = selected.type == "MESH" and sources_of(selected)
        found.update(dict.fromkeys([selected] if is_made else surfels_of(selected)))
    return list(found)


class OBJECT_OT_surfels_update(bpy.types.Operator):
    """Convert the sources of the selected surfels again, with the settings in the sidebar. It is also there while \
the source is edited, painted or sculpted"""

    bl_idname = UPDATE_SURFELS
    bl_label = "Update Surfels from Source"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 - Blender reads a set

    bake: BoolProperty(
        name="Bake Materials",
        description=(
            "Let Cycles bake the material inputs that cannot be read directly. This is slow: each input may take "
            "longer than the rest of the conversion"
        ),
        options={"SKIP_SAVE"},
    )

    @classmethod
    def poll(cls, context):
        if updatable(context):
            return True
        cls.poll_message_set(said("Select surfels that were converted from an object of this file, or that object"))
        return False

    def execute(self, context):
        mode = context.object.mode if context.object else "OBJECT"
        if mode != "OBJECT":  # which writes what was edited to the mesh
            bpy.ops.object.mode_set(mode="OBJECT")
        try:
            updated = sum(self._update(made, context) for made in updatable(context))
        finally:
            if mode != "OBJECT":
                bpy.ops.object.mode_set(mode=mode)
        return {"FINISHED"} if updated else {"CANCELLED"}

    def _update(self, made: bpy.types.Object, context: bpy.types.Context) -> bool:
        if self.bake:
            record_of(made).mesh.bake_materials = True
        try:
            batch = _batch(made, context)
        except ValueError as error:
            self.report({"ERROR"}, f"{made.name}: {error}")
            return False
        for conversion in batch.prepared(context):
            batch.sample(conversion)
        replaced = batch.replace(made, context)
        for conversion in replaced:
            keep_unread(made, conversion)
            if follows(made, conversion.sources[0]):
                shape = tie_shape(conversion, made, record_of(made).kind)
                for note in (*follow_visibility(made, conversion.sources), *shape):
                    self.report({"WARNING"}, note)
            self.report({"INFO"}, f"{made.name}: {conversion.summary()}")
            for note in conversion.notes:
                self.report({"WARNING" if conversion.is_warning(note) else "INFO"}, f"{made.name}: {note}")
        for _, sentence in batch.refused:
            self.report({"ERROR"}, f"{made.name}: {sentence}")
        return bool(replaced)


def _batch(made: bpy.types.Object, context: bpy.types.Context) -> Batch:
    """A batch of a surfel object's sources.

    Raises ValueError if one of them is no longer visible, or if the surfels would not be saved.
    """
    if made.data.library is not None:
        raise ValueError("Its surfels belong to a linked file; update them there.")
    sources, record = sources_of(made), record_of(made)
    for source in sources:
        if source.name not in context.view_layer.objects:
            raise ValueError(f"Its source {source.name!r} is not in this view layer; put it back into the scene first.")
    if record.kind == "POINTS":
        points = record.points
        return PointsBatch(sources, keywords(points), lambda: viewpoint(points, context.scene), points.flatness)
    return ConversionBatch(sources, choices(record.mesh), sources[0])


def draw_update_menu_entry(menu, context):
    menu.layout.operator(UPDATE_SURFELS)


register, unregister = with_menu_entry(OBJECT_OT_surfels_update, bpy.types.VIEW3D_MT_object, draw_update_menu_entry)
