# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes that show a series of numbered files, such as a 4D scan, each file when its frame is shown.

The mesh holds the surfels of one frame as ordinary attributes, so that every engine, modifier and colour treats them as
those of any scan. They are replaced before Blender evaluates another frame: in the viewport, in renders with and
without a window. A frame whose file cannot be read has none, and the engine says why.
"""

from __future__ import annotations

import math
import os
from pathlib import Path

import bpy
import numpy as np
from bpy.props import EnumProperty, IntProperty, StringProperty

from ...faults import sentence_of
from ...interchange import FLOAT_COLORS, file_numbered, numbered_files
from ...surfels import empty_surfels
from ..doors import on_change, unattended, with_handlers
from ..geometry.attributes import fill
from ..geometry.offsets import numbers_of, offset_of
from ..ids import SERIES, SERIES_ORIGIN
from ..registration import with_property
from ..spoken import said
from .file_import import FileImport, Reading
from .points_settings import PointsProperties


@on_change("Reading the file of a frame")
def _show_again(settings, context) -> None:
    show_frame(settings.id_data, context.scene)


class SurfelSeries(PointsProperties, bpy.types.PropertyGroup):
    """The series of a mesh, and how its files become surfels. shown: what the mesh holds, and how it was made. why_not:
    a sentence if it holds nothing."""

    path: StringProperty(
        name="Series",
        description="One of several numbered files, each of which is shown at the frame of its number",
        subtype="FILE_PATH",
        options={"PATH_SUPPORTS_BLEND_RELATIVE"},
        update=_show_again,
    )
    frame_offset: IntProperty(
        name="Frame Offset",
        description="Added to the number of a file to give the frame at which it is shown",
        update=_show_again,
    )
    float_colors: EnumProperty(
        name="Float Colors",
        description="What the files' colours mean if they are floats and the files do not say it",
        items=[(name, name.title(), "") for name in FLOAT_COLORS],
    )
    most_points: IntProperty(
        name="At Most", description="Points to take of a file that has more, evenly; 0 takes all", default=0, min=0
    )
    text_columns: StringProperty(name="Columns", description="What the columns of text files are, with blanks between")
    shown: StringProperty(options={"HIDDEN"})
    why_not: StringProperty(options={"HIDDEN"})


def series_of(mesh: bpy.types.Mesh) -> SurfelSeries:
    return getattr(mesh, SERIES)


def first_shown(path: str, scene: bpy.types.Scene) -> tuple[str, int]:
    """Which file of the series of `path` a scene shows now, and the series' frame offset: 0 if some file then has a
    frame of the scene's, or else so that the first frame shows the first file. Raises ValueError with a sentence if the
    name has no number, OSError."""
    files = numbered_files(Path(path))
    if not files:
        raise ValueError(
            said("The name has no number that counts the files of a series; import it without Numbered Series")
        )
    is_within = any(scene.frame_start <= number <= scene.frame_end for number in files)
    offset = 0 if is_within else scene.frame_start - min(files)
    try:
        return str(file_numbered(files, _frame_of(scene) - offset)), offset
    except ValueError:  # a gap, which the mesh tells once it is there
        return path, offset


def begin_series(
    made: bpy.types.Object, path: str, offset: int, properties: PointsProperties, reading: Reading, shown: str
) -> str:
    """Let the mesh of a new object show a series from now on. shown: the file whose surfels it has. Returns a
    sentence."""
    mesh, files = made.data, numbered_files(Path(bpy.path.abspath(path)))
    series = series_of(mesh)
    for name in PointsProperties.__annotations__:
        setattr(series, name, getattr(properties, name))
    for name, value in reading._asdict().items():
        setattr(series, name, value)
    series.frame_offset = offset
    mesh[SERIES_ORIGIN] = (np.array(made.matrix_world.translation, np.float64) + offset_of(mesh)).tolist()
    series.shown = _told(series, shown)
    series.path = path  # the last, because it begins to show frames
    for scene in made.users_scene:
        # Blender draws nothing else while a render reads its next frame
        scene.render.use_lock_interface = True
    return said(
        "Took {count:,} files as a series, for the frames {first:,} to {last:,}",
        count=len(files),
        first=min(files) + offset,
        last=max(files) + offset,
    )


def _frame_of(scene: bpy.types.Scene) -> int:
    """The frame that is shown, which all moments of a shutter that opens around it share."""
    return math.floor(scene.frame_current_final + 0.5)


def show_frame(mesh: bpy.types.Mesh, scene: bpy.types.Scene) -> None:
    """Read the file of the current frame into a mesh that shows a series, unless it is there already."""
    series = series_of(mesh)
    if not series.path:
        return
    told, frame = "", _frame_of(scene)
    try:
        path = Path(bpy.path.abspath(series.path, library=mesh.library))
        files = numbered_files(path)
        if not files:
            raise ValueError(f"There are no numbered files such as {path}.")
        path = str(file_numbered(files, frame - series.frame_offset))
        told = _told(series, path)
        if told == series.shown:
            return
        work = FileImport(path, series, scene, Reading.of(series))
        work.run()
        work.refill(mesh, scene, numbers_of(mesh, SERIES_ORIGIN, 3, np.zeros(3)))
        series.why_not = ""
    except Exception as error:
        fill(mesh, empty_surfels(), offset_of(mesh))
        why = error.strerror if isinstance(error, OSError) and error.strerror else sentence_of(error)
        series.why_not = f"Frame {frame:,} of {series.path} cannot be shown: {why}"
    series.shown = told


def _told(series: SurfelSeries, path: str) -> str:
    """What decides which surfels a mesh shows."""
    status = os.stat(path)
    settings = [getattr(series, name) for name in (*PointsProperties.__annotations__, *Reading._fields)]
    return f"{path} {status.st_mtime_ns} {status.st_size} {settings}"


def why_not_shown(mesh: bpy.types.ID | None) -> str:
    """A sentence if a mesh of the .blend has nothing to show, because the file of its frame is missing or damaged."""
    series = getattr(mesh, SERIES, None)
    return series.why_not if series is not None and series.path else ""


@unattended("Reading the files of a frame")
def _show(scene: bpy.types.Scene, *_) -> None:
    for mesh in bpy.data.meshes:
        show_frame(mesh, scene)


_register_settings, _unregister_settings = with_property(bpy.types.Mesh, SERIES, SurfelSeries)
_register_handlers, _unregister_handlers = with_handlers((bpy.app.handlers.frame_change_pre, _show))


def register():
    _register_settings()
    _register_handlers()


def unregister():
    _unregister_handlers()
    _unregister_settings()
