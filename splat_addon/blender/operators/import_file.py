# SPDX-License-Identifier: GPL-3.0-or-later
"""File > Import > Surfels and Scans: turns a file of surfels, Gaussian splats or points into a surfel object."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import suppress
from functools import partial
from pathlib import Path

import bpy
import numpy as np
from bpy.props import BoolProperty, CollectionProperty, EnumProperty, IntProperty, StringProperty
from bpy_extras.io_utils import ImportHelper, poll_file_object_drop

from ...interchange import SHARED_SUFFIXES, SUFFIXES, numbered_files, text_columns_of
from ...streaming import SCAN_COLUMNS, id_of
from ...streaming.layout import SUFFIX
from ..conversion.blocks_opening import holds_blocks, open_blocks
from ..conversion.file_import import FileImport, Reading, show_scan
from ..conversion.file_storing import FileStoring
from ..conversion.points_settings import (
    PointsProperties,
    draw_gaussian_properties,
    draw_points_properties,
    is_mild,
    viewpoint,
)
from ..conversion.series import begin_series, first_shown
from ..conversion.surfel_objects import select_only
from ..geometry.scene_offset import Surroundings, keep_offset
from ..geometry.stored_surfels import read_surfels
from ..geometry.surfel_files import relative_path
from ..ids import IMPORT_FILE, OBJECT_SETTINGS
from ..scan_color_settings import ATTRIBUTE_OF, IMPORT_ITEMS
from ..spoken import said
from .file_paths import absolute, file_sentence, path_property
from .menu_entry import with_menu_entry
from .modal_work import FileWork, ModalWork, Writing

#: What is shown without being stored as colours.
_SHOWN = ("HEIGHT", *(name for name, column in ATTRIBUTE_OF.items() if column in SCAN_COLUMNS))


class IMPORT_SCENE_OT_surfels_ply(PointsProperties, ModalWork, ImportHelper, bpy.types.Operator):
    """Read surfels from files: those written by this extension, Gaussian splats, or scans; what a file is, its \
contents tell"""

    bl_idname = IMPORT_FILE
    bl_label = "Import Surfels"
    bl_options = {"REGISTER", "UNDO", "PRESET"}  # noqa: RUF012 - Blender reads a set

    filename_ext = ".ply"
    filepath: path_property("reading from", is_forgotten=True)
    directory: StringProperty(subtype="DIR_PATH", options={"HIDDEN", "SKIP_SAVE", "SKIP_PRESET"})
    files: CollectionProperty(type=bpy.types.OperatorFileListElement, options={"HIDDEN", "SKIP_SAVE", "SKIP_PRESET"})
    filter_glob: StringProperty(
        default=";".join(f"*{suffix}" for suffix in (*SUFFIXES, *SHARED_SUFFIXES, SUFFIX)), options={"HIDDEN"}
    )
    keeps_in_file: BoolProperty(
        name="Keep in a File",
        description=(
            "Store the surfels in a file beside the .blend, from which every view reads only what it needs, instead "
            "of in the .blend. For more surfels or points than memory holds"
        ),
        default=False,
    )

    is_series: BoolProperty(
        name="Numbered Series",
        description=(
            "Show each of the files whose names differ in their last number at the frame of its number, such as those "
            "of a scan that moves. A file is read when its frame is shown"
        ),
        default=False,
    )

    most_points: IntProperty(
        name="At Most",
        description=(
            "Take so many points of a scan that has more, evenly; 0 takes all. Of LAS and COPC the rest is not read; "
            "LAZ is read at some millions of points a second"
        ),
        default=0,
        min=0,
        soft_max=10_000_000,
    )

    text_columns: StringProperty(
        name="Columns",
        description=(
            "What the columns of a text file are, with blanks between: x y z, red green blue, nx ny nz, intensity; "
            "and - for one to leave out. Empty takes what the file says, or a guess"
        ),
    )

    float_colors: EnumProperty(
        name="Float Colors",
        description="What the file's colours mean if they are floats and the file does not say it",
        items=(
            ("DISPLAY", "Display", "Display values (sRGB), as in Blender's own PLY import"),
            ("LINEAR", "Linear", "Scene-linear values"),
        ),
        default="DISPLAY",
    )

    color_by: EnumProperty(
        name="Color by",
        description="What the surfels' colors show",
        items=IMPORT_ITEMS,
        default="COLOR",
    )

    has_scan_look: BoolProperty(
        name="Scan Look",
        description=(
            "Show the scan as it was captured, without any light: with Captured Color and Eye-Dome Lighting, if it is "
            "the scene's first; in colors of its intensity or height, if it has none; from a new camera, if the scene "
            "has none that sees it"
        ),
        default=True,
    )

    def invoke(self, context, event):
        self._is_asked = True
        if not self.filepath:
            return super().invoke(context, event)
        # dropped: show the settings without a file browser
        more = f" + {len(self.files) - 1:,}" if len(self.files) > 1 else ""
        title = Path(self.filepath).name + more
        return context.window_manager.invoke_props_dialog(self, title=title, confirm_text="Import")

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        for name in ("has_scan_look", "color_by", "keeps_in_file", "is_series", "most_points", "float_colors"):
            self.layout.prop(self, name)
        self._draw_text_columns()
        header, body = self.layout.panel("surfels_import_gaussians")
        header.label(text="Gaussian Splats")
        if body:
            draw_gaussian_properties(body, self)
        header, body = self.layout.panel("surfels_import_points")
        header.label(text="Points")
        if body:
            draw_points_properties(body, self)

    def _draw_text_columns(self):
        """Draw what the columns of the chosen file are taken as, if it is text, and what corrects it."""
        with suppress(OSError, ValueError):
            if found := text_columns_of(absolute(self.filepath)):
                self.layout.prop(self, "text_columns", placeholder=" ".join(found))

    @property
    def _name(self) -> str:
        """The name of the chosen file."""
        return Path(self.filepath.removeprefix("//")).name

    def execute(self, context):
        # confirmed in the file browser or a dialog; the same operator may be repeated from the redo panel
        is_asked, self._is_asked = getattr(self, "_is_asked", False), False
        if self.keeps_in_file and self.most_points:
            self.report({"ERROR"}, said("A file of blocks takes all points; set At Most to 0"))
            return {"CANCELLED"}
        return self.run_in_thread(context) if is_asked else self.run_now(context)

    def _beginnings(self, context):
        return [partial(self._begin_file, context, path) for path in self._paths()]

    def _paths(self) -> Iterator[str]:
        """The chosen files; of a series only one."""
        seen = set()
        for path in [os.path.join(self.directory, file.name) for file in self.files if file.name] or [self.filepath]:
            if path not in seen:
                yield path
                seen |= self._series_of(path) if self.is_series else {path}

    def _series_of(self, path: str) -> set[str]:
        """A file and those that are shown with it. What cannot be found is told when it is read."""
        with suppress(OSError, ValueError):
            return {path, *map(str, numbered_files(Path(absolute(path))).values())}
        return {path}

    def _begin_file(self, context, path: str) -> FileWork:
        self.filepath = path
        return self._begin(context)

    def _begin(self, context):
        path = absolute(self.filepath)
        if self.is_series and (self.keeps_in_file or holds_blocks(path)):
            raise ValueError(said("The files of a series are shown from memory; they cannot be files of blocks"))
        if holds_blocks(path):
            return Opening()
        if self.is_series:
            path, self._frame_offset = first_shown(path, context.scene)
        if not self.keeps_in_file:
            return FileImport(path, self, context.scene, Reading.of(self))
        # repeated from the redo panel, it replaces the file whose object was undone
        own = self._kept_as().get(path, "")
        kept = absolute(f"//{Path(self._name).stem}{SUFFIX}")
        stored = "COLOR" if self.color_by in _SHOWN else self.color_by
        return Keeping(path, kept, self, context.scene, Reading.of(self), own, stored)

    def _kept_as(self) -> dict[str, str]:
        """Path of a file -> id of the file of blocks that was made of it."""
        if not hasattr(self, "_kept"):
            self._kept = {}
        return self._kept

    def _finish(self, context, work):
        if isinstance(work, Opening):
            count = self._open(context, absolute(self.filepath), is_own=False)
            self._color(context.view_layer.objects.active)
            self.report({"INFO"}, said("{name}: {count:,} surfels", name=self._name, count=count))
        elif isinstance(work, FileImport):
            made = work.place(context)
            if self.has_scan_look:
                work.show(context, made)
            self._color(made)
            select_only(context, [made])
            self.report({"INFO"}, said("{name}: {count:,} surfels", name=self._name, count=len(work.surfels)))
            self._tell(work.notes)
            if self.is_series:
                path = relative_path(absolute(self.filepath))
                self._tell([begin_series(made, path, self._frame_offset, self, Reading.of(self), work.path)])
        else:
            self._finish_keeping(context, work)

    def _color(self, made):
        """Let a new object show what was chosen."""
        if self.color_by != "COLOR":
            getattr(made, OBJECT_SETTINGS).color_by = self.color_by

    def _finish_keeping(self, context, keeping):
        if keeping.offset is not None and (note := keep_offset(context.scene, keeping.offset)):
            self._tell([note])
        count = self._open(context, keeping.path, is_own=True)
        self._kept_as()[absolute(self.filepath)] = id_of(keeping.path)
        made = context.view_layer.objects.active
        if self.color_by in _SHOWN:
            self._color(made)
        if keeping.offset is not None and self.has_scan_look:
            self._tell(show_scan(context, made, read_surfels(made.data)[0].positions))
        self.report({"INFO"}, said("{count:,} surfels -> {path}", count=count, path=keeping.path))
        self._tell(keeping.notes())

    def _tell(self, notes):
        for note in notes:
            which = f"{self._name}: " if len(self.files) > 1 else ""
            self.report({"INFO" if is_mild(note) else "WARNING"}, which + note)

    def _open(self, context, path: str, is_own: bool) -> int:
        """Add an object whose surfels are in a file of blocks; returns how many. Raises OSError or ValueError."""
        made, count, notes = open_blocks(context, path, self._name, is_own)
        select_only(context, [made])
        self._tell(notes)
        return count

    def _sentence(self, error):
        return f"{self._name}: {file_sentence(error)}"


class Opening:
    """A file of blocks, of which nothing need be read before it is shown."""

    share, is_cancelled = 1.0, False

    def run(self, told=None) -> None:
        pass

    def status(self) -> str:
        return ""

    def cancelled(self) -> str:
        return said("The import was cancelled; nothing was changed")


class Keeping(Writing):
    """A file on its way to a file of blocks. offset: as of `FileStoring`."""

    def __init__(self, source: str, path: str, properties: PointsProperties, scene: bpy.types.Scene, reading: Reading,
                 own="", color_by="COLOR"):  # fmt: skip
        """The arguments are those of `FileImport`, `Writing` and `FileStoring`. Raises OSError if the file cannot be
        read."""
        os.stat(source)
        super().__init__(path, (), 0, own)
        eye = viewpoint(properties, scene)
        eye = None if eye is None else np.array(eye)
        self._storing = FileStoring(source, properties, reading, color_by, eye, Surroundings.of(scene))

    @property
    def offset(self) -> np.ndarray | None:
        return self._storing.offset

    def _write(self, progress):
        self._storing.write(self.path, progress)

    def notes(self) -> list[str]:
        """A sentence about each thing that was left out, assumed or found doubtful."""
        return self._storing.notes


def draw_menu_entry(menu, context):
    menu.layout.operator(IMPORT_FILE, text="Surfels and Scans (.ply, .las, ...)")


class IO_FH_surfels(bpy.types.FileHandler):
    """Handles files dropped on the 3D view or the Outliner; Blender asks which importer to use if its own accepts them
    too."""

    bl_idname = "IO_FH_surfels"
    bl_label = "Surfels and Scans"
    bl_import_operator = IMPORT_FILE
    bl_file_extensions = ";".join((*SUFFIXES, SUFFIX))

    @classmethod
    def poll_drop(cls, context):
        return poll_file_object_drop(context)


register, unregister = with_menu_entry(
    IMPORT_SCENE_OT_surfels_ply, bpy.types.TOPBAR_MT_file_import, draw_menu_entry, (IO_FH_surfels,)
)
