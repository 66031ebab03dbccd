# SPDX-License-Identifier: GPL-3.0-or-later
"""What was measured in the scene, in the render properties: a row for each choice, which a click applies."""

from __future__ import annotations

import bpy

from ...trade.page import frontier
from ..doors import register_classes_factory
from ..engine.measuring import measured
from ..ids import MEASURE, SAVE_MEASURED, SHOW_DIFFERENCE, USE_MEASURED
from .engine_panel import EnginePanel

#: The share of a line that the names of choices take.
_NAMES = 0.58


class RENDER_PT_surfel_measured(EnginePanel, bpy.types.Panel):
    bl_context = "render"
    bl_label = "Speed and Accuracy"
    bl_parent_id = "RENDER_PT_surfel_sampling"
    bl_options = frozenset({"DEFAULT_CLOSED"})

    def draw(self, context):
        layout, found = self.layout, measured(context.scene)
        layout.operator(MEASURE, icon="TIME").goes_on = False
        if found is None:
            return
        if not found.is_whole:
            layout.operator(MEASURE, text="Go On", icon="PLAY").goes_on = True
        column, best = layout.column(align=True), frontier(found.rows)
        head = column.split(factor=_NAMES, align=True)
        head.label(text="Click to use")
        numbers = head.row(align=True)
        for title in ("Error", "Seconds", ""):
            numbers.label(text=title)
        for place, row in enumerate(found.rows):
            line = column.split(factor=_NAMES, align=True)
            icon = "SOLO_ON" if place in best else "BLANK1"
            line.operator(USE_MEASURED, text=row.choice.name, icon=icon, translate=False).row = place
            numbers = line.row(align=True)
            numbers.label(text=f" {row.flip:.4f}", translate=False)
            numbers.label(text=f"{row.seconds:.2g}", translate=False)
            numbers.operator(SHOW_DIFFERENCE, text="", icon="IMAGE_DATA").row = place
        layout.operator(SAVE_MEASURED, icon="FILE_TICK")


register, unregister = register_classes_factory((RENDER_PT_surfel_measured,))
