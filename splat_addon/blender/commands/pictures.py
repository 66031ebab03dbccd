# SPDX-License-Identifier: GPL-3.0-or-later
"""Shared by commands about frames: frame numbers, tiles, and the paths of their files."""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import bpy

from ..cameras import picture_size, rendered_part
from ..ids import ENGINE
from ..operators.file_paths import absolute
from .out_paths import path_at
from .written_files import is_whole_picture

#: A to B in steps of C, as Blender writes it (1..9), as farms do (1-9), or as Open Job Description does (1-9:2).
_RANGE = re.compile(r"(-?\d+)(?:(?:-|\.\.)(-?\d+)(?::(\d+))?)?")


def frame_list(text: str) -> list[int]:
    """ "1-3,7..9,20-30:5" -> the frames in that order, without duplicates."""
    frames: dict[int, None] = {}
    for part in text.split(","):
        match = _RANGE.fullmatch(part.strip())
        if not match:
            raise argparse.ArgumentTypeError(f"frames are like 1-10,15,20..30, not {text!r}")
        first, last, step = match.groups()
        if not int(step or 1):
            raise argparse.ArgumentTypeError(f"a step between frames is 1 or more, not 0 as in {part.strip()!r}")
        if int(last or first) < int(first):
            raise argparse.ArgumentTypeError(f"frames go up, not down as in {part.strip()!r}")
        frames |= dict.fromkeys(range(int(first), int(last or first) + 1, int(step or 1)))
    return list(frames)


def pair(text: str) -> tuple[int, int]:
    """ "4x3" or "4,3" -> (4, 3)."""
    match = re.fullmatch(r"([1-9]\d{0,3})[x,]([1-9]\d{0,3})", text)
    if not match:
        raise argparse.ArgumentTypeError(f"columns and rows are like 4x4, not {text!r}")
    return int(match[1]), int(match[2])


def add_picture_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--frames", type=frame_list, help="like 1-10,15,20..30; without it the scene's current frame")
    parser.add_argument("--first", type=int, help="the first frame of a chunk, with --chunk")
    parser.add_argument("--chunk", type=int, help="how many frames the chunk has")
    parser.add_argument("--last", type=int, help="no frame of the chunk lies after this one")
    parser.add_argument(
        "--out", help="path of the pictures, with # where the number goes, or their FOLDER/; without it the scene's own"
    )
    parser.add_argument("--tiles", type=pair, help="columns and rows of each frame's tiles, like 4x4")


def frames_of(options: argparse.Namespace) -> list[int]:
    """The frames to render. Raises ValueError if the arguments are ambiguous."""
    if options.first is None:
        return options.frames or [bpy.context.scene.frame_current]
    if options.frames or not (options.chunk and options.chunk > 0):
        raise ValueError("A chunk needs --first and --chunk above 0, and no --frames.")
    last = options.first + options.chunk - 1
    last = last if options.last is None else min(last, options.last)
    if last < options.first:
        raise ValueError(f"The chunk begins at {options.first}, after the last frame, {options.last}.")
    return list(range(options.first, last + 1))


def prepare_scene(out: str | None) -> bpy.types.Scene:
    """The file's scene, set up for this engine. Raises ValueError for a file without a path, or for video output."""
    scene = bpy.context.scene
    scene.render.engine = ENGINE
    scene.render.filepath = path_at(out, "") if out else absolute(scene.render.filepath)
    if scene.render.is_movie_format:
        raise ValueError("Several machines cannot write one video file; choose an image format.")
    return scene


def files_of(scene: bpy.types.Scene, frame: int) -> list[Path]:
    """The files of a picture: one, or one per view. The first may lack a view's name."""
    render = scene.render
    views = [view.name for view in render.views if view.use] if render.use_multiview else []
    if render.image_settings.views_format != "INDIVIDUAL":
        views = []
    return [Path(render.frame_path(frame=frame, view=view)) for view in views or [""]]


def picture_file(scene: bpy.types.Scene, frame: int) -> Path:
    """The path given to Blender, which adds the names of views to it."""
    return Path(scene.render.frame_path(frame=frame))


def is_there(scene: bpy.types.Scene, frame: int) -> bool:
    """Whether the pictures of a frame are there, and can be used: an empty one is none."""
    return all(map(is_whole_picture, files_of(scene, frame)))


def expected_size(render: bpy.types.RenderSettings) -> tuple[int, int] | None:
    """Width and height of a written picture; None where they depend on more than the size of the frame."""
    return None if render.use_border or render.use_multiview else picture_size(render)


def tile_file(picture: Path, tile: tuple[int, int], tiles: tuple[int, int]) -> Path:
    """The file of a tile. tile: column and row, from 1, from the bottom left."""
    (column, row), (columns, rows) = tile, tiles
    return picture.with_name(f"{picture.name}.tile-{column}-{row}-of-{columns}x{rows}.npz")


def tile_place(scene: bpy.types.Scene, tile: tuple[int, int], tiles: tuple[int, int]) -> tuple[int, int, int, int]:
    """x, y, width, height in pixels of a half-open part of the whole frame. Raises ValueError for a tile without
    pixels."""
    if scene.render.use_border:
        raise ValueError("The scene has a render border, which tiles take the place of; switch it off.")
    ends = []
    for size, number, count in zip(picture_size(scene.render), tile, tiles, strict=True):
        if not 1 <= number <= count:
            raise ValueError(f"There is no tile {tile[0]},{tile[1]} among {tiles[0]} x {tiles[1]}.")
        ends.append((size * (number - 1) // count, size * number // count))
    (left, right), (bottom, top) = ends
    if left == right or bottom == top:
        raise ValueError(f"{tiles[0]} x {tiles[1]} tiles are more than the picture has pixels; use fewer.")
    return left, bottom, right - left, top - bottom


@contextmanager
def look_through(scene: bpy.types.Scene, place: tuple[int, int, int, int]) -> Iterator[None]:
    """Make Blender render only this part of the picture, without compositor and sequencer."""
    render = scene.render
    (width, height), (x, y, across, up) = picture_size(render), place
    before = {name: getattr(render, name) for name in _OF_A_TILE}
    # in the middle of a pixel, so that Blender's float32 truncates to that pixel
    render.border_min_x = (x + 0.5) / width if x else 0.0
    render.border_min_y = (y + 0.5) / height if y else 0.0
    render.border_max_x = (x + across + 0.5) / width if x + across < width else 1.0
    render.border_max_y = (y + up + 0.5) / height if y + up < height else 1.0
    render.use_border = render.use_crop_to_border = True
    render.use_compositing = render.use_sequencer = False
    try:
        if rendered_part(render) != tuple(place):
            raise RuntimeError(f"Blender's border cannot be {place}, but {rendered_part(render)}.")
        yield
    finally:
        for name, value in before.items():
            setattr(render, name, value)


#: Settings that differ while a tile is rendered.
_OF_A_TILE = ("use_border", "use_crop_to_border", "use_compositing", "use_sequencer")
