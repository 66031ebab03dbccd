# SPDX-License-Identifier: GPL-3.0-or-later
"""Object > Convert Points to Surfels: the points of each selected mesh or point cloud become a surfel object."""

from __future__ import annotations

import time

import bpy
import numpy as np
from bpy.props import EnumProperty

from ...sampling import surfels_from_points
from ..ids import SURFELS_FROM_POINTS
from ..placement import without_shear
from ..points_extraction import extract_points, has_points, sheared
from ..points_settings import PointsProperties, draw_points_properties, keywords, viewpoint
from ..surfel_objects import add_surfel_object, collections_of, select_only


def selected_points(context: bpy.types.Context) -> list[bpy.types.Object]:
    """What the operator converts: point clouds, and meshes that are not surfels already."""
    return [source for source in context.selected_objects if has_points(source)]


class OBJECT_OT_surfels_from_points(PointsProperties, bpy.types.Operator):
    """Make a surfel of every point of the selected point clouds and meshes; what they lack, normals, sizes and \
directions, is estimated from neighbouring points"""

    bl_idname = SURFELS_FROM_POINTS
    bl_label = "Convert Points to Surfels"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 - Blender reads a set

    source: EnumProperty(
        name="Source",
        description="What happens to the points that were converted",
        items=(
            ("KEEP", "Keep", "Leave the points as they are; they and the surfels lie in the same place"),
            ("HIDE", "Hide", "Hide the points in the viewport and in renders, so that only the surfels are seen"),
        ),
        default="KEEP",
    )

    @classmethod
    def poll(cls, context):
        if context.mode != "OBJECT":
            cls.poll_message_set("Points are converted in object mode; leave the current mode first")
        elif not selected_points(context):
            cls.poll_message_set("Select a point cloud, or a mesh that is not surfels already")
        else:
            return True
        return False

    def draw(self, context):
        draw_points_properties(self.layout, self)
        self.layout.prop(self, "source")

    def execute(self, context):
        collection, made, refused = context.collection, [], []
        for source in selected_points(context):
            try:
                made.append((source, self._convert(context, source, collection)))
            except (ValueError, MemoryError) as error:
                refused.append((source.name, str(error) or "The memory does not suffice; convert fewer points."))
        if made:
            select_only(context, [new for _, new in made])
        if self.source == "HIDE":
            for source, _ in made:
                source.hide_set(True)
                source.hide_render = True
        # An error fails a script's call; where others were converted, that would hide them from it.
        for name, sentence in refused:
            self.report({"WARNING" if made else "ERROR"}, f"{name}: {sentence}")
        return {"FINISHED"} if made else {"CANCELLED"}

    def _convert(self, context, source, fallback) -> bpy.types.Object:
        start = time.perf_counter()
        depsgraph = context.evaluated_depsgraph_get()
        matrix_world, shear = without_shear(source.evaluated_get(depsgraph).matrix_world)
        points = extract_points(source, depsgraph)
        if not len(points.positions):
            raise ValueError("It has no points.")
        points = points if shear is None else sheared(points, shear)
        eye = viewpoint(self, context)
        surfels, report = surfels_from_points(
            points.positions,
            points.normals,
            points.radii,
            points.colors,
            viewpoint=None if eye is None else np.array(matrix_world.inverted() @ eye),
            **keywords(self),
        )
        made = add_surfel_object(
            f"{source.name} surfels", surfels, matrix_world, collections_of(source, fallback), points.materials
        )
        seconds = time.perf_counter() - start
        self.report({"INFO"}, f"{source.name}: {report.points:,} points -> {len(surfels):,} surfels in {seconds:.1f} s")
        for note in report.notes():
            self.report({"WARNING" if note.startswith("Skipped") else "INFO"}, f"{source.name}: {note}")
        return made


def draw_points_menu_entry(menu, context):
    menu.layout.operator(SURFELS_FROM_POINTS)


_register_classes, _unregister_classes = bpy.utils.register_classes_factory((OBJECT_OT_surfels_from_points,))


def register():
    _register_classes()
    bpy.types.VIEW3D_MT_object.append(draw_points_menu_entry)


def unregister():
    bpy.types.VIEW3D_MT_object.remove(draw_points_menu_entry)
    _unregister_classes()
