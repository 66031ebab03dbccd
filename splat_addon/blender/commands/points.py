# SPDX-License-Identifier: GPL-3.0-or-later
"""`surfels points`: makes surfels of bare points and of Gaussian splats, and saves a new file."""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Iterator
from pathlib import Path

import bpy

from ...claims import claimed
from ..conversion.points_conversion import PointsBatch
from ..conversion.points_settings import PointsProperties, keywords, viewpoint
from ..conversion.source_record import SurfelPointsSettings
from ..geometry.points_extraction import has_points
from .convert import is_blend_there, named, place, result
from .out_paths import made_room
from .written_files import save_blend

HELP = "make surfels of bare points, in a new file"
DESCRIPTION = (
    "Makes a surfel of every point of point clouds and of meshes without faces, as Object > Convert Points to Surfels "
    "does, and saves the result as a new file. The points are left out of its renders."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--out", required=True, help="the new .blend, or its FOLDER/")
    parser.add_argument("--objects", nargs="+", help="names; without them all visible points")
    for name in PointsProperties.__annotations__:
        setting = SurfelPointsSettings.bl_rna.properties[name]
        parser.add_argument(f"--{name.replace('_', '-')}", **_KINDS[setting.type](setting), help=setting.description)
    parser.add_argument("--again", action="store_true", help="convert even where the file is there already")


def run(options: argparse.Namespace) -> Iterator[Path]:
    """Convert, and yield the written file. Raises ValueError or OSError; nothing is saved if any object cannot be
    converted."""
    out = result(options)
    with claimed(made_room(out)):
        if not options.again and is_blend_there(out):
            print(f"there already: {out}", flush=True)
            return
        sources = _sources(options.objects)
        batch = PointsBatch(sources, keywords(options), lambda: viewpoint(options, bpy.context), options.flatness)
        for conversion in batch.prepared(bpy.context):
            batch.sample(conversion)
        place(batch, options, "POINTS")
        save_blend(out)
        yield out


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
    return {"action": "store_true"}


#: type of a property -> function of it that returns how its argument is read
_KINDS = {"INT": _number, "FLOAT": _number, "ENUM": _choice, "BOOLEAN": _switch}
