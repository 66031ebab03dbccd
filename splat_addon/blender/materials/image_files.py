# SPDX-License-Identifier: GPL-3.0-or-later
"""The files of an image that has several: UDIM tiles, and the frames of a sequence. Blender gives scripts the pixels of
the first tile only, and of a frame none, so each is read as an image of its own."""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager

import bpy

from ..geometry.node_groups import nodes_in
from .node_trees import uses_nodes

#: Sources of images that have one picture, and of those that have several.
SINGLE, TILED, SEQUENCE = ("FILE", "GENERATED"), "TILED", "SEQUENCE"

#: The number of the first tile, and how many tiles are in a row.
_FIRST, _ROW = 1001, 10


def frame_of(image: bpy.types.Image | None, user: bpy.types.ImageUser) -> int | None:
    """The number in the name of the file that a sequence shows now; None for an image of another kind.

    As in Cycles, whatever *Auto Refresh* says.
    """
    if image is None or image.source != SEQUENCE:
        return None
    count = max(user.frame_duration, 0)
    frame = bpy.context.scene.frame_current - user.frame_start + 1
    if user.use_cyclic and count:
        frame = frame % count or count
    return min(max(frame, 0), count) + user.frame_offset


def shows_frames(material: bpy.types.Material | None) -> bool:
    """Whether a material has a sequence, which may be another image in each frame, of which Blender tells nothing."""
    nodes = nodes_in(material.node_tree) if material is not None and uses_nodes(material) else ()
    return any(node.image.source == SEQUENCE for node in nodes if getattr(node, "image", None))


def frame_path(image: bpy.types.Image, frame: int) -> str:
    """The file of a frame of a sequence: the last number in the name, with as many digits."""
    folder, name = os.path.split(bpy.path.abspath(image.filepath_raw, library=image.library))
    stem, ending = os.path.splitext(name)
    head, digits, tail = re.fullmatch(r"(.*?)(\d*)(\D*)", stem).groups()
    return os.path.join(folder, f"{head}{frame:0{len(digits)}d}{tail}{ending}" if digits else name)


def place_of(tile: int) -> tuple[int, int]:
    """Column and row of a tile."""
    return (tile - _FIRST) % _ROW, (tile - _FIRST) // _ROW


def grid_of(image: bpy.types.Image) -> tuple[int, int, int, int]:
    """The first column and row of the tiles of an image, and how many columns and rows there are from there."""
    columns, rows = zip(*(place_of(tile.number) for tile in image.tiles), strict=True)
    return min(columns), min(rows), max(columns) - min(columns) + 1, max(rows) - min(rows) + 1


@contextmanager
def frame_image(image: bpy.types.Image, frame: int) -> Iterator[bpy.types.Image | None]:
    """A frame of a sequence as an image of its own; None if its file is not there."""
    path = frame_path(image, frame)
    if not os.path.isfile(path):
        yield None
        return
    with _twin(image, path=path) as twin:
        yield twin


def tile_images(image: bpy.types.Image) -> Iterator[tuple[int, bpy.types.Image | None]]:
    """The number of each tile, and the tile as an image of its own, which exists until the next is asked for; None if
    its file is not there. Of tiles with unsaved changes, a copy is saved in a temporary folder."""
    with tempfile.TemporaryDirectory(dir=bpy.app.tempdir or None) as folder:
        pattern = bpy.path.abspath(image.filepath_raw, library=image.library)
        packed = {each.tile_number: each.packed_file for each in image.packed_files}
        if image.is_dirty:
            pattern, packed = os.path.join(folder, f"tile.<UDIM>{os.path.splitext(pattern)[1]}"), {}
            image.save(filepath=pattern, save_copy=True)
        for tile in image.tiles:
            path = tile_path(pattern, tile.number)
            data = packed[tile.number].data if tile.number in packed else None
            if data is None and not os.path.isfile(path):
                yield tile.number, None
                continue
            with _twin(image, data, path) as twin:
                yield tile.number, twin


def tile_path(pattern: str, tile: int) -> str:
    """The file of a tile. pattern: a path with <UDIM> or <UVTILE>."""
    column, row = place_of(tile)
    return pattern.replace("<UDIM>", str(tile)).replace("<UVTILE>", f"u{column + 1}_v{row + 1}")


@contextmanager
def _twin(image: bpy.types.Image, data: bytes | None = None, path: str = "") -> Iterator[bpy.types.Image]:
    """A temporary image of the bytes of a file, or of a file, with another's settings."""
    twin = bpy.data.images.new(image.name, 1, 1)
    try:
        if data is not None:
            twin.pack(data=data, data_len=len(data))
        else:
            twin.filepath = path
        twin.source = "FILE"
        twin.colorspace_settings.name, twin.alpha_mode = image.colorspace_settings.name, image.alpha_mode
        yield twin
    finally:
        bpy.data.images.remove(twin)
