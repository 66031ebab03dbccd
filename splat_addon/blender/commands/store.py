# SPDX-License-Identifier: GPL-3.0-or-later
"""`surfels store`: stores surfels in a file of blocks, from which views read what they need."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import bpy
import numpy as np

from ...claims import claimed
from ...doubts import doubts_of_rounding
from ...streaming import PORTION, described, write_blocks
from ...streaming.layout import SUFFIX
from ...surfels import Surfels, portions
from ..conversion.file_import import Reading
from ..conversion.file_storing import FileStoring
from ..conversion.points_settings import viewpoint
from ..geometry.sources import is_surfel_object
from ..geometry.surfel_files import file_of
from ..geometry.world_surfels import world_surfels
from ..operators.file_paths import file_sentence, storing_in
from .convert import add_density_arguments, batch_of, refuse, refuse_density, sources_of
from .out_paths import file_at, made_room
from .points import add_points_arguments, refuse_those_of_files

HELP = "store surfels in a file that views stream"
DESCRIPTION = (
    "Stores surfels, in world coordinates, in a file from which views read only what they need: those of objects, "
    "which are converted first if they are no surfels, or those of a file. The points of a scan become surfels without "
    "being in memory at once. File > Import > Surfels opens it."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--out", required=True, help=f"the new file, NAME{SUFFIX}, or its FOLDER/")
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--objects", nargs="+", help="names of surfel objects, or of objects to convert")
    source.add_argument("--file", "--ply", type=Path, help="surfels, Gaussian splats or a scan, of any size")
    add_density_arguments(parser)
    add_points_arguments(parser)
    parser.add_argument("--again", action="store_true", help="store even where the file is there already")


def run(options: argparse.Namespace) -> Iterator[Path]:
    """Store, and yield the written file. Raises ValueError or OSError; then there is no file."""
    if options.file:
        refuse_density(options)
    else:
        refuse_those_of_files(options)
    out = file_at(options.out, SUFFIX, options.file.stem if options.file else "")
    with claimed(made_room(out)):
        if not options.again and _is_there(out):
            print(f"there already: {out}", flush=True)
            return
        if options.file:
            count, notes = _store_file(options, out)
        else:
            parts = _of_objects(options)
            count, notes = write_blocks(out, parts, _printed(), expected=sum(map(len, parts))), []
        for note in (f"{count:,} surfels", *notes):
            print(note, flush=True)
        yield out


def _store_file(options: argparse.Namespace, out: Path) -> tuple[int, list[str]]:
    eye = viewpoint(options, bpy.context.scene)
    eye = None if eye is None else np.array(eye)
    reading = Reading(options.float_colors, text_columns=options.text_columns)
    storing = FileStoring(options.file, options, reading, options.color_by or "COLOR", eye)
    try:
        with storing_in(out):
            return storing.write(out, _printed()), storing.notes
    except OSError as error:
        raise ValueError(f"{options.file.name}: {file_sentence(error)}") from error


def _is_there(out: Path) -> bool:
    """Whether an earlier run made the file. Raises ValueError with a sentence for one that is not whole."""
    return out.is_file() and bool(described(out))


def _of_objects(options: argparse.Namespace) -> Sequence[Surfels]:
    """The surfels of the named objects, in portions; of those that are no surfels, what they are converted to."""
    scene = bpy.context.scene
    stored = [name for name in options.objects if name in scene.objects and is_surfel_object(scene.objects[name])]
    if there := [name for name in stored if file_of(scene.objects[name])]:
        raise ValueError(f"The surfels of {there[0]!r} are in a file already.")
    owners, others = [scene.objects[name] for name in stored], [n for n in options.objects if n not in stored]
    if others:
        batch = batch_of(sources_of(others), options)
        for conversion in batch.prepared(bpy.context):
            batch.sample(conversion)
        refuse(batch)
        owners += [made for _, made in batch.place_all(bpy.context)]
    surfels, skipped = world_surfels(owners, bpy.context.evaluated_depsgraph_get())
    if skipped:
        print(f"{skipped:,} unusable surfels skipped", flush=True)
    for note in doubts_of_rounding(surfels):
        print(note, flush=True)
    return [part for each in surfels for part in portions(each, PORTION)]


def _printed() -> Callable[[float, str], bool]:
    """A progress that prints each tenth of the way."""
    said = -1

    def told(share: float, step: str) -> bool:
        nonlocal said
        if int(10 * share) > said:
            said = int(10 * share)
            print(f"{step}: {share:.0%}", flush=True)
        return True

    return told
