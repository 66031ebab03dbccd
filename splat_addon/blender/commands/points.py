# SPDX-License-Identifier: GPL-3.0-or-later
"""`surfels points`: makes surfels of files, or of the points and Gaussian splats of objects, and saves a new .blend."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Iterator
from pathlib import Path

import bpy

from ...claims import claimed
from ...interchange import FLOAT_COLORS
from ..conversion.blocks_opening import holds_blocks, open_blocks
from ..conversion.file_import import FileImport, Reading, show_scan
from ..conversion.points_conversion import PointsBatch
from ..conversion.points_settings import PointsProperties, keywords, viewpoint
from ..conversion.series import begin_series, first_shown
from ..conversion.source_record import SurfelPointsSettings
from ..geometry.points_extraction import has_points
from ..geometry.stored_surfels import read_surfels
from ..ids import OBJECT_SETTINGS
from ..operators.file_paths import file_sentence
from ..scan_color_settings import IMPORT_ITEMS
from .convert import is_blend_there, named, place, result
from .out_paths import file_at, made_room
from .written_files import save_blend

HELP = "make surfels of scans and other points, in a new file"
DESCRIPTION = (
    "Makes surfels of files, as File > Import does; or of every point of point clouds and of meshes without faces, as "
    "Object > Convert Points to Surfels does, and leaves the points out of renders. It saves the result as a new file."
)


#: argument about how files are read or shown -> how it is written
_OF_FILES = {
    "most_points": "--most",
    "series": "--series",
    "plain": "--plain",
    "float_colors": "--float-colors",
    "text_columns": "--columns",
    "color_by": "--color-by",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--out", required=True, help="the new .blend, or its FOLDER/")
    source = parser.add_mutually_exclusive_group()
    about = "scans, Gaussian splats or surfels, also in blocks"
    source.add_argument("files", nargs="*", default=[], metavar="FILE", help=about)
    source.add_argument("--objects", nargs="+", help="names; without them and files, all visible points")
    parser.add_argument(
        "--most",
        type=int,
        default=0,
        dest="most_points",
        metavar="NUMBER",
        help="points to take of a scan that has more",
    )
    parser.add_argument(
        "--series", action="store_true", help="show the numbered files beside FILE at the frames of their numbers"
    )
    parser.add_argument(
        "--plain", action="store_true", help="leave render settings, colours and the camera of files as they are"
    )
    add_points_arguments(parser)
    parser.add_argument("--again", action="store_true", help="convert even where the file is there already")


def add_points_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the settings of points, and what the file says or shows of colours."""
    for name in PointsProperties.__annotations__:
        setting = SurfelPointsSettings.bl_rna.properties[name]
        parser.add_argument(f"--{name.replace('_', '-')}", **_KINDS[setting.type](setting), help=setting.description)
    parser.add_argument(
        "--float-colors",
        type=str.upper,
        choices=FLOAT_COLORS,
        default=FLOAT_COLORS[0],
        help="what a file's colours mean if they are floats",
    )
    parser.add_argument(
        "--columns",
        default="",
        dest="text_columns",
        metavar="NAMES",
        help="what the columns of a text are, in quotes and with blanks between; - leaves one out",
    )
    parser.add_argument(
        "--color-by",
        type=str.upper,
        choices=[name for name, *_ in IMPORT_ITEMS],
        help="what the colours of files show, if not their own",
    )


def refuse_those_of_files(options: argparse.Namespace) -> None:
    """Raise ValueError for an argument about files, where objects are given: it would have no effect."""
    without = (None, 0, "", FLOAT_COLORS[0])
    for name, flag in _OF_FILES.items():
        if getattr(options, name, None) not in without:
            raise ValueError(f"{flag} is about files and changes nothing of objects; leave it out, or name files.")


def run(options: argparse.Namespace) -> Iterator[Path]:
    """Convert, and yield the written file. Raises ValueError or OSError; nothing is saved if any object cannot be
    converted."""
    if not options.files:
        refuse_those_of_files(options)
    out = file_at(options.out, ".blend", Path(options.files[0]).stem) if options.files else result(options)
    with claimed(made_room(out)):
        if not options.again and is_blend_there(out):
            print(f"there already: {out}", flush=True)
            return
        if options.files:
            _import_files(options)
        else:
            _convert_objects(options)
        save_blend(out)
        yield out


def _import_files(options: argparse.Namespace) -> None:
    if not bpy.data.filepath:
        # nothing of Blender's startup file belongs to the scan
        bpy.ops.wm.read_homefile(use_empty=True)
    for path in options.files:
        path, scene = str(Path(path).absolute()), bpy.context.scene
        if holds_blocks(path):
            _open(path, options)
            continue
        shown, offset = first_shown(path, scene) if options.series else (path, 0)
        work = FileImport(shown, options, scene, Reading.of(options))
        try:
            work.run()
            made = work.place(bpy.context)
        except (ValueError, OSError) as error:
            raise ValueError(f"{work.name}: {file_sentence(error)}") from error
        if not options.plain:
            work.show(bpy.context, made)
        if options.color_by:
            getattr(made, OBJECT_SETTINGS).color_by = options.color_by
        if options.series:
            work.notes.append(begin_series(made, path, offset, options, Reading.of(options), shown))
        print(f"{work.name}: {len(work.surfels):,} surfels", flush=True)
        for note in work.notes:
            print(f"{work.name}: {note}", flush=True)


def _open(path: str, options: argparse.Namespace) -> None:
    """Let an object read its surfels from a file of blocks. Raises ValueError with a sentence."""
    name = Path(path).name
    if options.series or options.most_points:
        raise ValueError(f"{name} is a file of blocks, which views read as they need it; leave out --series, --most.")
    try:
        made, count, notes = open_blocks(bpy.context, path, name, is_own=False)
        surfels = read_surfels(made.data)[0]
    except (ValueError, OSError) as error:
        raise ValueError(f"{name}: {file_sentence(error)}") from error
    if not options.plain:
        notes += show_scan(bpy.context, made, surfels.positions)
    if options.color_by:
        getattr(made, OBJECT_SETTINGS).color_by = options.color_by
    for note in (f"{count:,} surfels", *notes):
        print(f"{name}: {note}", flush=True)


def _convert_objects(options: argparse.Namespace) -> None:
    sources = _sources(options.objects)
    batch = PointsBatch(sources, keywords(options), lambda: viewpoint(options, bpy.context.scene), options.flatness)
    for conversion in batch.prepared(bpy.context):
        batch.sample(conversion)
    place(batch, options, "POINTS")


def _sources(names: list[str] | None) -> list[bpy.types.Object]:
    """The objects to convert. Raises ValueError for a name that does not exist or an object that has no points."""
    if names:
        return named(names, has_points, "no points to convert")
    found = [each for each in bpy.context.view_layer.objects if each.visible_get() and _are_bare(each)]
    if not found:
        raise ValueError("Nothing visible is bare points; name objects with --objects.")
    return found


def _are_bare(source: bpy.types.Object) -> bool:
    return has_points(source) and not (source.type == "MESH" and len(source.data.polygons))


def _number(setting: bpy.types.Property) -> dict:
    """Arguments of a number within its limits; an angle is given in degrees."""
    is_angle = setting.subtype == "ANGLE"
    kind: Callable = int if setting.type == "INT" else float

    def read(text: str):
        value = math.radians(float(text)) if is_angle else kind(text)
        if not setting.hard_min <= value <= setting.hard_max:
            raise argparse.ArgumentTypeError(f"{text} is out of range")
        return value

    return {"type": read, "default": setting.default, "metavar": "DEGREES" if is_angle else "NUMBER"}


def _choice(setting: bpy.types.Property) -> dict:
    choices = [item.identifier for item in setting.enum_items]
    return {"type": str.upper, "choices": choices, "default": setting.default}


def _switch(setting: bpy.types.Property) -> dict:
    return {"action": argparse.BooleanOptionalAction, "default": setting.default}


#: type of a property -> function of it that returns how its argument is read
_KINDS = {"INT": _number, "FLOAT": _number, "ENUM": _choice, "BOOLEAN": _switch}
