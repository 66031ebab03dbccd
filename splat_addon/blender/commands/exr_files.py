# SPDX-License-Identifier: GPL-3.0-or-later
"""Tells whether an OpenEXR file is whole from its table of chunks, without unpacking a pixel.

Source: Academy Software Foundation, "OpenEXR File Layout".
"""

from __future__ import annotations

import os
import struct
from pathlib import Path
from typing import BinaryIO

_MAGIC = b"\x76\x2f\x31\x01"
#: Bits of the version: tiles, and several parts.
_TILED, _SEVERAL = 0x200, 0x1000
#: The longest name or type of an attribute, and the longest value that is looked at.
_LONGEST_NAME, _LONGEST_VALUE = 255, 1 << 24


def is_exr(head: bytes) -> bool:
    """Whether a file that begins with these bytes is OpenEXR."""
    return head.startswith(_MAGIC)


def size_of_exr(file: Path) -> tuple[int, int]:
    """Width and height of a picture in scan lines, as Blender writes them. Raises OSError, or ValueError if it is not
    whole or has tiles."""
    end = os.path.getsize(file)
    with open(file, "rb") as stream:
        _, version = _unpacked(stream, "<4sI")
        if version & _TILED:
            raise ValueError("It is an OpenEXR file in tiles, which are not read here.")
        has_parts = bool(version & _SEVERAL)
        windows = [_data_window(stream)]
        while has_parts and (window := _data_window(stream)):
            windows.append(window)
        if _last_chunk(stream, has_parts, end) != end:
            raise ValueError("A part of the OpenEXR file is missing.")
    left, bottom, right, top = windows[0] or (0, 0, -1, -1)
    return right - left + 1, top - bottom + 1


def _data_window(stream: BinaryIO) -> tuple[int, ...] | None:
    """Read the header of a part, and return its data window; None if there is no further header."""
    found = None
    while name := _word(stream):
        _word(stream)  # its type
        (size,) = _unpacked(stream, "<I")
        if size > _LONGEST_VALUE:
            raise ValueError("The header of the OpenEXR file is damaged.")
        value = _unpacked(stream, "<4i" if name == b"dataWindow" else f"<{size}s")
        found = value if name == b"dataWindow" else found
    return found


def _last_chunk(stream: BinaryIO, has_parts: bool, end: int) -> int:
    """The offset at which the last chunk ends, or 0 if a chunk is missing. The first one follows the table."""
    start = stream.tell()
    (first,) = _unpacked(stream, "<Q")
    count = (first - start) // 8
    if not 0 < count <= (end - start) // 8:
        return 0
    offsets = first, *_unpacked(stream, f"<{count - 1}Q")
    ends = []
    for offset in offsets:
        if not first <= offset < end:
            return 0
        stream.seek(offset)
        *about, size = _unpacked(stream, "<3I" if has_parts else "<2I")
        ends.append(offset + 4 * (len(about) + 1) + size)
    return max(ends)


def _word(stream: BinaryIO) -> bytes:
    word = b""
    while (letter := stream.read(1)) != b"\0":
        word += letter
        if not letter or len(word) > _LONGEST_NAME:
            raise ValueError("The header of the OpenEXR file is damaged.")
    return word


def _unpacked(stream: BinaryIO, form: str) -> tuple:
    data = stream.read(struct.calcsize(form))
    if len(data) < struct.calcsize(form):
        raise ValueError("A part of the OpenEXR file is missing.")
    return struct.unpack(form, data)
