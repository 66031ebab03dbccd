# SPDX-License-Identifier: GPL-3.0-or-later
"""`surfels merge`: joins the results of several workers, or reports what is missing."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import count
from pathlib import Path

import bpy

from ...claims import claimed, remove_leftovers
from ...rendering.assembly.frame_parts import joined_parts
from ...sampling import joined_blocks, read_block, read_request
from ..cameras import picture_size
from ..engine.exchange import exchanging
from .convert import (
    add_blocks_argument,
    batch_of,
    block_file,
    is_blend_there,
    is_request,
    place,
    refuse,
    request_of,
    result,
    settings_of,
    sources_of,
)
from .out_paths import made_room
from .pictures import (
    add_picture_arguments,
    files_of,
    frames_of,
    is_there,
    picture_file,
    prepare_scene,
    tile_file,
    tile_place,
)
from .render import write_picture
from .written_files import save_blend

HELP = "join tiles or blocks, or check that all frames exist"
DESCRIPTION = (
    "With --tiles, puts the tiles of each frame together, lets the compositor and the file format have the whole "
    "picture, and removes the tiles. With --blocks, joins the blocks of converted objects in a new file, and removes "
    "them. With neither, checks that all frames exist, lists the missing ones, and removes what killed workers left."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_picture_arguments(parser)
    add_blocks_argument(parser)


def run(options: argparse.Namespace) -> Iterator[Path]:
    """Yield the files as they are written. Raises ValueError, RuntimeError or OSError."""
    if options.blocks is not None:
        yield from _blocks(options)
        return
    scene, frames = prepare_scene(options.out), frames_of(options)
    if options.tiles:
        yield from _tiles(scene, frames, options.tiles)
    remove_leftovers(picture_file(scene, frame) for frame in frames)
    if missing := [frame for frame in frames if not is_there(scene, frame)]:
        raise ValueError(f"{len(missing):,} of {len(frames):,} frames are missing: {_shortened(missing)}; render them.")
    if not options.tiles:
        print(f"{len(frames):,} frames are there", flush=True)


def _tiles(scene: bpy.types.Scene, frames: list[int], tiles: tuple[int, int]) -> Iterator[Path]:
    for frame in frames:
        parts = list(_tile_files(scene, frame, tiles))
        with claimed(made_room(picture_file(scene, frame))), _consumed(parts, files_of(scene, frame)):
            if is_there(scene, frame):
                print(f"there already: {picture_file(scene, frame)}", flush=True)
                continue
            if missing := [part for part in parts if not part.is_file()]:
                raise ValueError(f"{len(missing)} of {len(parts)} tiles are missing, first {missing[0]}; render them.")
            _merge(scene, frame, parts)
            yield from files_of(scene, frame)


def _tile_files(scene: bpy.types.Scene, frame: int, tiles: tuple[int, int]) -> Iterator[Path]:
    columns, rows = tiles
    for row in range(1, rows + 1):
        for column in range(1, columns + 1):
            tile_place(scene, (column, row), tiles)
            yield tile_file(picture_file(scene, frame), (column, row), tiles)


def _merge(scene: bpy.types.Scene, frame: int, parts: list[Path]) -> None:
    wholes = joined_parts(parts, picture_size(scene.render), frame)
    with exchanging(given=lambda layer, view: wholes.pop((layer, view), None)):
        write_picture(scene, frame)


def _blocks(options: argparse.Namespace) -> Iterator[Path]:
    if not options.out:
        raise ValueError("Blocks are joined in a new file; give its path with --out, as for convert.")
    out = result(options)
    files = [block_file(out, number, options.blocks) for number in range(1, options.blocks + 1)]
    with claimed(made_room(out)), _consumed(files, [out]):
        if is_blend_there(out):
            print(f"there already: {out}", flush=True)
            return
        if missing := [file for file in files if not file.is_file()]:
            raise ValueError(f"{len(missing)} of {len(files)} blocks are missing, first {missing[0]}; convert them.")
        _join(files)
        save_blend(out)
        yield out


@contextmanager
def _consumed(parts: list[Path], results: list[Path]) -> Iterator[None]:
    """Delete the parts of which the results consist, if the context ends without an error; one that was written again
    meanwhile stays.

    Raises ValueError, and deletes nothing, if results that were there before are older than a part.
    """
    parts_before, results_before = _times(parts), _times(results)
    yield
    if _times(results) == results_before:
        oldest = min(results_before.values(), default=0)
        if younger := [part for part, time in parts_before.items() if time > oldest]:
            raise ValueError(
                f"{results[0]} was there already and is older than {younger[0]}, so it lacks that; delete one of the "
                "two, and run this again."
            )
    for part, time in parts_before.items():
        if _times([part]).get(part) == time:
            part.unlink()
    remove_leftovers(parts)


def _times(files: list[Path]) -> dict[Path, int]:
    """When each of the files that are there was written, in nanoseconds."""
    return {file: file.stat().st_mtime_ns for file in files if file.is_file()}


def _join(files: list[Path]) -> None:
    """Join the blocks of each object and add the surfel objects. Raises ValueError."""
    options, sources = _converted(files)
    turns = count()

    def joined(mesh, **how):
        turn = next(turns)
        return joined_blocks(mesh, (read_block(file, turn) for file in files), **how)

    batch = batch_of(sources, options, joined)
    for conversion in batch.prepared(bpy.context):
        refuse(batch)
        batch.sample(conversion)
    place(batch, settings_of(options))


def _converted(files: list[Path]) -> tuple[argparse.Namespace, list[bpy.types.Object]]:
    """The options with which all blocks were converted, and the objects. Raises ValueError if these differ."""
    request = read_request(files[0])
    if not is_request(request):
        raise ValueError(f"{files[0]} is damaged or is not a file of blocks; convert the block again.")
    for file in files:
        if read_request(file) != request:
            raise ValueError(
                f"{file.name} was not converted with the options of {files[0].name}; convert one of them again."
            )
    options = argparse.Namespace(**request)
    sources = sources_of(options.objects)
    if (now := request_of(sources, options)["names"]) != options.names:
        raise ValueError(
            f"The blocks were made from {_shortened(options.names)}, but what is visible now is {_shortened(now)}; "
            "convert them again."
        )
    return options, sources


def _shortened(frames: list) -> str:
    return ", ".join(map(str, frames[:10])) + (" ..." if len(frames) > 10 else "")
