# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads back what Blender writes itself: it reports no error if a full disk holds only a part of a .blend or of a
picture."""

from __future__ import annotations

import os
from pathlib import Path

import bpy

from ...whole_files import NotWholeError, unfinished
from .exr_files import is_exr, size_of_exr
from .stated_lengths import stated_length

#: A .blend ends with a block of this name, which has 32 bytes, or 24 in files of Blender 4.5, or if it is compressed
#: with a table of its parts (Zstandard's seekable format).
_LAST_BLOCK, _LAST_BLOCK_SIZES, _TABLE_OF_PARTS = b"ENDB", (32, 24), b"\xb1\xea\x92\x8f"

#: First bytes of the formats that Blender opens without their end -> their last bytes.
_ENDS = {b"\x89PNG": b"IEND\xaeB`\x82", b"\xff\xd8\xff": b"\xff\xd9"}
#: The same for a format that has no first bytes of its own, by the end of its files' names.
_ENDS_BY_NAME = {".tga": b"TRUEVISION-XFILE.\x00"}


def save_blend(out: Path) -> None:
    """Save the open file under another name. Raises as `unfinished`."""
    with unfinished(out, check_blend) as folder:
        # Blender makes paths relative to the folder in which it saves, so that cannot be the hidden one
        beside = folder.with_name(f"{folder.name}.blend")
        try:
            bpy.ops.wm.save_as_mainfile(filepath=str(beside), copy=True, check_existing=False)
            beside.replace(folder / out.name)
        except RuntimeError as error:
            why = str(error).removeprefix("Error: ").strip()
            raise NotWholeError(f"{out} could not be saved, so nothing was changed. {why}") from error
        finally:
            for left in (beside, beside.with_name(f"{beside.name}@")):
                left.unlink(missing_ok=True)


def check_blend(file: Path) -> None:
    """Raise OSError or ValueError if a .blend is not whole."""
    check_end_of_blend(file)
    with bpy.data.libraries.load(str(file)):  # reads the head of every block
        pass


def check_end_of_blend(file: Path) -> None:
    """Raise OSError or ValueError if a .blend does not reach its end. It may be the one that is open."""
    tail = _bytes_of(file, -max(_LAST_BLOCK_SIZES))
    if not tail.endswith(_TABLE_OF_PARTS) and _LAST_BLOCK not in (tail[-n:][:4] for n in _LAST_BLOCK_SIZES):
        raise ValueError("The end of the .blend is missing.")


def check_picture(file: Path, size: tuple[int, int] | None = None) -> None:
    """Raise OSError or ValueError if a picture is not whole. size: the width and height that it should have."""
    head = _bytes_of(file, 4)
    # Blender opens no picture of several layers without using it
    found = size_of_exr(file) if is_exr(head) else _opened_size(file)
    end = next((end for begin, end in _ENDS.items() if head.startswith(begin)), _ENDS_BY_NAME.get(file.suffix, b""))
    # other programs may add a few bytes
    if end not in _bytes_of(file, -256) or os.path.getsize(file) < stated_length(file):
        raise ValueError("The end of the picture is missing.")
    if size not in (None, found):
        raise ValueError("The picture has {} x {} pixels, not {} x {}.".format(*found, *size))


def is_whole_picture(file: Path) -> bool:
    """Whether there is a picture that can be used."""
    try:
        check_picture(file)
    except (OSError, ValueError):
        return False
    return True


def _opened_size(file: Path) -> tuple[int, int]:
    """Width and height of a picture. Raises ValueError if Blender cannot read it."""
    try:
        picture = bpy.data.images.load(str(file))
    except RuntimeError as error:
        raise ValueError(str(error).removeprefix("Error: ").strip()) from error
    try:
        width, height = picture.size  # this reads all pixels
    finally:
        bpy.data.images.remove(picture)
    if not width * height:
        raise ValueError("It is no picture, or a part of one is missing.")
    return width, height


def _bytes_of(file: Path, count: int) -> bytes:
    """The first bytes of a file, or with a negative count the last ones."""
    with open(file, "rb") as stream:
        if count < 0:
            stream.seek(max(os.path.getsize(file) + count, 0))
        return stream.read(abs(count))
