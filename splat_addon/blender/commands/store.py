# SPDX-License-Identifier: GPL-3.0-or-later
"""`surfels store`: stores surfels in a file of blocks, from which views read what they need."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import bpy

from ...claims import claimed
from ...doubts import doubts_of_rounding
from ...interchange import PlyPortions
from ...streaming import PORTION, described, write_blocks
from ...streaming.layout import SUFFIX
from ...surfels import Surfels, portions
from ..geometry.sources import is_surfel_object
from ..geometry.surfel_files import file_of
from ..geometry.world_surfels import world_surfels
from .convert import add_density_arguments, batch_of, refuse, sources_of
from .out_paths import file_at, made_room

HELP = "store surfels in a file that views stream"
DESCRIPTION = (
    "Stores surfels, in world coordinates, in a file from which views read only what they need: those of a PLY file, "
    "or of objects, which are converted first if they are no surfels. File > Import > Surfels opens it."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--out", required=True, help=f"the new file, NAME{SUFFIX}, or its FOLDER/")
    source = parser.add_mutually_exclusive_group(required=True)
    source.add_argument("--objects", nargs="+", help="names of surfel objects, or of objects to convert")
    source.add_argument("--ply", type=Path, help="a PLY file of surfels, of any size")
    add_density_arguments(parser)
    parser.add_argument("--again", action="store_true", help="store even where the file is there already")


def run(options: argparse.Namespace) -> Iterator[Path]:
    """Store, and yield the written file. Raises ValueError or OSError; then there is no file."""
    out = file_at(options.out, SUFFIX, options.ply.stem if options.ply else "")
    with claimed(made_room(out)):
        if not options.again and _is_there(out):
            print(f"there already: {out}", flush=True)
            return
        parts = PlyPortions(options.ply) if options.ply else _of_objects(options)
        expected = len(parts) if options.ply else sum(map(len, parts))
        count = write_blocks(out, parts, _printed(), expected=expected)
        for note in (f"{count:,} surfels", *(parts.notes() if options.ply else ())):
            print(note, flush=True)
        yield out


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


def _printed() -> Callable[[float, str], None]:
    """A progress that prints each tenth of the way."""
    said = -1

    def told(share: float, step: str) -> None:
        nonlocal said
        if int(10 * share) > said:
            said = int(10 * share)
            print(f"{step}: {share:.0%}", flush=True)

    return told
