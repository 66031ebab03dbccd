# SPDX-License-Identifier: GPL-3.0-or-later
"""Chooses whether the selected surfels are seen, or what they were made of."""

from __future__ import annotations

import bpy
from bpy.props import EnumProperty

from ..conversion.shown_instead import are_shown, show_sources, show_surfels
from ..conversion.source_record import sources_of
from ..doors import register_classes_factory
from ..ids import SURFELS_OR_SOURCE
from ..spoken import said
from .update_surfels import updatable

_ITEMS = (
    ("SOURCE", "Source", "Hide the surfels and show the object that they were made from"),
    ("SURFELS", "Surfels", "Show the surfels in place of the object that they were made from"),
)


class OBJECT_OT_surfels_or_source(bpy.types.Operator):
    """Show the surfels in place of their source, or the source in place of its surfels, in views and in renders"""

    bl_idname = SURFELS_OR_SOURCE
    bl_label = "Show Surfels or Source"
    bl_options = {"REGISTER", "UNDO"}  # noqa: RUF012 - Blender reads a set

    shown: EnumProperty(
        name="Show",
        description="What is seen in views and in renders",
        items=_ITEMS,
        default="SURFELS",
    )

    @classmethod
    def description(cls, context, properties):
        return next(description for name, _, description in _ITEMS if name == properties.shown)

    @classmethod
    def poll(cls, context):
        if context.mode == "OBJECT" and updatable(context):
            return True
        cls.poll_message_set(said("Select surfels or what they were made from, in Object Mode"))
        return False

    def execute(self, context):
        for made in updatable(context):
            if self.shown == "SOURCE":
                show_sources(made)
                stays = sources_of(made)
            else:
                show_surfels(made)
                stays = [made]
            # what is hidden is no longer selected
            for each in stays:
                each.select_set(True)
            context.view_layer.objects.active = stays[0]
        return {"FINISHED"}


def draw_choice(layout: bpy.types.UILayout, made: bpy.types.Object | None) -> None:
    """A row of two buttons; what is seen of a surfel object is shown pressed."""
    row = layout.row(align=True)
    row.enabled = made is not None
    is_shown = made is not None and are_shown(made)
    for name, text, is_pressed in (("SOURCE", "Source", not is_shown), ("SURFELS", "Surfels", is_shown)):
        row.operator(SURFELS_OR_SOURCE, text=text, depress=made is not None and is_pressed).shown = name


register, unregister = register_classes_factory((OBJECT_OT_surfels_or_source,))
