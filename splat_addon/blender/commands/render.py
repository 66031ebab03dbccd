# SPDX-License-Identifier: GPL-3.0-or-later
"""`surfels render`: renders missing frames, or a missing tile of each."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import bpy

from ...array_files import is_archive
from ...claims import claimed
from ...rendering import Frame
from ...rendering.assembly.frame_parts import Part, write_part
from ...whole_files import unfinished
from ..cameras import picture_size
from ..engine.exchange import exchanging
from .out_paths import made_room
from .pictures import (
    add_picture_arguments,
    expected_size,
    files_of,
    frames_of,
    is_there,
    look_through,
    pair,
    picture_file,
    prepare_scene,
    tile_file,
    tile_place,
)
from .written_files import check_picture

HELP = "draw frames, or a tile of each"
DESCRIPTION = (
    "Draws the frames whose pictures are not there yet, with this engine. With --tile, draws only that tile and "
    "writes it beside the picture, for `merge`."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_picture_arguments(parser)
    parser.add_argument(
        "--tile", type=pair, help="column and row of the tile, from 1,1 at the bottom left; with --tiles"
    )
    parser.add_argument("--again", action="store_true", help="draw what is there already too")


def run(options: argparse.Namespace) -> Iterator[Path]:
    """Yield the files as they are written. Raises ValueError, RuntimeError or OSError."""
    if bool(options.tile) != bool(options.tiles):
        raise ValueError("A tile needs both --tile and --tiles.")
    scene, frames = prepare_scene(options.out), frames_of(options)
    return _tiles(scene, frames, options) if options.tile else _frames(scene, frames, options.again)


def _frames(scene: bpy.types.Scene, frames: list[int], again: bool) -> Iterator[Path]:
    missing = [frame for frame in frames if again or not is_there(scene, frame)]
    for frame in frames:
        if frame not in missing:
            print(f"there already: {', '.join(map(str, files_of(scene, frame)))}", flush=True)
            continue
        # Data on the device is reused for the next frame; the last frame frees it, because it must not outlive the
        # render.
        scene.render.use_persistent_data = frame != missing[-1]
        write_picture(scene, frame)
        yield from files_of(scene, frame)


def write_picture(scene: bpy.types.Scene, frame: int) -> None:
    """Write the frame's files, either all or none. Raises as `unfinished`, and RuntimeError with Blender's message."""
    place, pattern = made_room(picture_file(scene, frame)), scene.render.filepath
    scene.frame_set(frame)
    try:
        with unfinished(place, partial(check_picture, size=expected_size(scene.render))) as folder:
            scene.render.filepath = str(folder / place.name)
            _render(write_still=True)
    finally:
        scene.render.filepath = pattern


def _tiles(scene: bpy.types.Scene, frames: list[int], options: argparse.Namespace) -> Iterator[Path]:
    place = tile_place(scene, options.tile, options.tiles)
    for frame in frames:
        file = tile_file(picture_file(scene, frame), options.tile, options.tiles)
        with claimed(made_room(file)):
            if not options.again and (is_archive(file) or is_there(scene, frame)):
                print(f"there already: {file if is_archive(file) else picture_file(scene, frame)}", flush=True)
                continue
            scene.frame_set(frame)
            with look_through(scene, place):
                drawn = _drawn()
            write_part(file, Part(picture_size(scene.render), place, frame), drawn)
            yield file


def _drawn() -> dict[tuple[str, str], Frame]:
    """Collect what the engine draws, by view layer and view."""
    drawn = {}
    with exchanging(kept=lambda layer, view, frame: drawn.update({(layer, view): frame})):
        _render()
    return drawn


def _render(**options) -> None:
    """Render. Raises RuntimeError with Blender's message, without the prefix that Blender adds."""
    try:
        bpy.ops.render.render(**options)
    except RuntimeError as error:
        raise RuntimeError(str(error).removeprefix("Error: ").strip()) from error
