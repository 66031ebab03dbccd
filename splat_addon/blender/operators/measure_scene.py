# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators of Measure This Scene: measure, use a row, show its difference, save the page."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
from bpy.props import BoolProperty, IntProperty
from bpy_extras.io_utils import ExportHelper

from ...trade import Choice
from ...trade.page import magma
from ...whole_files import write_whole
from ..doors import register_classes_factory, unattended, with_handlers
from ..engine.exchange import exchange, exchanging
from ..engine.measuring import Measuring, forget_measurements, measured
from ..ids import ENGINE, MEASURE, RENDER_SETTINGS, SAVE_MEASURED, SHOW_DIFFERENCE, USE_MEASURED
from ..spoken import said
from .file_paths import absolute, file_sentence, path_property

#: Fields of `Settings` -> the properties that have another name.
_NAMES = {"sum_format": "accumulation"}


def use_choice(scene: bpy.types.Scene, choice: Choice) -> None:
    """Give a scene's render settings the values of a choice."""
    properties = getattr(scene, RENDER_SETTINGS)
    for name, value in choice.changes.items():
        setattr(properties, _NAMES.get(name, name), value)


class RENDER_OT_surfel_measure(bpy.types.Operator):
    bl_idname = MEASURE
    bl_label = "Measure This Scene"
    bl_description = (
        "Render the scene with many settings and compare each picture with the exact one, for a table of what they "
        "cost and gain. It takes as long as a hundred small renders; Esc ends it and keeps what was measured"
    )

    pictures: IntProperty(
        name="Exact Pictures",
        description="Pictures that the exact one is the mean of, a multiple of 8",
        min=8,
        max=1024,
        step=8,
        default=32,
    )
    turns: IntProperty(
        name="Turns", description="How often each picture is drawn to measure its time", min=1, max=100, default=1
    )
    goes_on: BoolProperty(
        name="Go On", description="Keep what was measured before, if settings and size are the same", default=False
    )

    @classmethod
    def poll(cls, context):
        if context.engine == ENGINE:
            return True
        cls.poll_message_set(said("Choose the engine Surfel Splatting first"))
        return False

    def execute(self, context):
        try:
            with exchanging(drawn_by=self._measuring(context)):
                bpy.ops.render.render()
        except RuntimeError as error:  # which says what the render reported
            self.report({"ERROR"}, str(error).removeprefix("Error: ").strip())
            return {"CANCELLED"}
        return {"FINISHED"}

    def invoke(self, context, event):
        if bpy.app.background:
            return self.execute(context)
        global _is_begun
        _is_begun = True
        exchange(drawn_by=self._measuring(context))
        if "CANCELLED" in bpy.ops.render.render("INVOKE_DEFAULT"):
            _after_render()
            return {"CANCELLED"}
        return {"FINISHED"}

    def _measuring(self, context) -> Measuring:
        if self.pictures % 8:
            raise ValueError(f"The number of exact pictures must be a multiple of 8, not {self.pictures}.")
        return Measuring(context.scene, self.pictures, self.turns, self.goes_on)


#: Whether a render that goes on in the window is measured.
_is_begun = False


@unattended("Ending a measurement")
def _after_render(*_) -> None:
    """A render has ended, or was cancelled."""
    global _is_begun
    if _is_begun:
        _is_begun = False
        exchange()


@unattended("Forgetting measurements")
def _after_load(*_) -> None:
    """Another file's scenes may have the names of those that were measured."""
    forget_measurements()


class _OfRow:
    """A row of what was measured in the scene."""

    row: IntProperty(name="Row", description="Which row of the table", min=0, default=0)

    @classmethod
    def poll(cls, context):
        return _is_measured(cls, context)

    def _row(self, context):
        """Raises ValueError with a sentence."""
        rows = measured(context.scene).rows
        if self.row >= len(rows):
            raise ValueError(
                said("The table has {count} rows, from 0 on, and no row {row}", count=len(rows), row=self.row)
            )
        return rows[self.row]


def _is_measured(operator: type, context) -> bool:
    """Whether an operator that uses the table can be called."""
    if measured(context.scene):
        return True
    operator.poll_message_set(said("Nothing was measured in this scene yet: measure it first"))
    return False


class RENDER_OT_surfel_measured_use(_OfRow, bpy.types.Operator):
    """Render with the settings of this row"""

    bl_idname = USE_MEASURED
    bl_label = "Use"
    bl_options = frozenset({"REGISTER", "UNDO"})

    def execute(self, context):
        use_choice(context.scene, self._row(context).choice)
        return {"FINISHED"}


class RENDER_OT_surfel_measured_difference(_OfRow, bpy.types.Operator):
    """Show in an image editor where this row's picture differs from the exact one: black where it is equal"""

    bl_idname = SHOW_DIFFERENCE
    bl_label = "Show Difference"

    def execute(self, context):
        row = self._row(context)
        image = _image(f"Difference: {row.choice.name}", magma(row.difference))
        editors = [area for area in context.screen.areas if area.type == "IMAGE_EDITOR"] if context.screen else []
        for area in editors[:1]:
            area.spaces.active.image = image
        if not editors:
            self.report({"INFO"}, said("Open an image editor and choose {name!r} there", name=image.name))
        return {"FINISHED"}


def _image(name: str, shown: np.ndarray) -> bpy.types.Image:
    """A picture in the file. shown: (h, w, 3) as a screen shows it."""
    height, width = shown.shape[:2]
    image = bpy.data.images.get(name)
    if image is None or tuple(image.size) != (width, height):
        if image is not None:
            bpy.data.images.remove(image)
        image = bpy.data.images.new(name, width, height)
    opaque = np.ones((height, width, 1))
    image.pixels.foreach_set(np.concatenate([shown, opaque], axis=2).astype(np.float32).ravel())
    image.update()
    return image


class RENDER_OT_surfel_measured_page(ExportHelper, bpy.types.Operator):
    """Save the table, a plot and the pictures as one HTML page, which needs no other file"""

    bl_idname = SAVE_MEASURED
    bl_label = "Save Page"

    filename_ext = ".html"
    filepath: path_property("writing to")

    @classmethod
    def poll(cls, context):
        return _is_measured(cls, context)

    def execute(self, context):
        scene = context.scene
        try:
            write_whole(Path(absolute(self.filepath)), measured(scene).page(scene.name).encode("utf-8"))
        except (OSError, ValueError) as error:
            self.report({"ERROR"}, file_sentence(error))
            return {"CANCELLED"}
        return {"FINISHED"}


_classes = register_classes_factory(
    (
        RENDER_OT_surfel_measure,
        RENDER_OT_surfel_measured_use,
        RENDER_OT_surfel_measured_difference,
        RENDER_OT_surfel_measured_page,
    )
)
_handlers = with_handlers(
    (bpy.app.handlers.render_complete, _after_render),
    (bpy.app.handlers.render_cancel, _after_render),
    (bpy.app.handlers.load_post, _after_load),
)


def register():
    for part in (_classes, _handlers):
        part[0]()


def unregister():
    for part in (_handlers, _classes):
        part[1]()
