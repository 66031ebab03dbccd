# SPDX-License-Identifier: GPL-3.0-or-later
"""The format of a file of surfels in blocks (`.surfelblocks`): plain arrays, little endian, each at a multiple of 64
bytes.

The first 32 bytes are the *head*: the word SURFELBL, the version (uint32), the CRC-32 of the directory (uint32), and
the directory's offset and length (uint64 each). The *directory* is at the end of the file and is JSON:

    {"surfels": N, "origin": [x, y, z], "is_solid": false, "is_transparent": false, "roots": R,
     "fields": {"positions": 3, ...},
     "arrays": {"rows": {"offset": o, "count": E}, "first": {"offset": o, "type": "<i8", "shape": [B]}, ...}}

*rows* are E surfels and merged surfels; a row has the fields of `Surfels` one after another, with as many numbers as
`fields` says, in the types of `Surfels`, all of them relative to the origin. The other arrays are the columns of
`hierarchy.blocks.Blocks` for B blocks: first and last are a block's run of rows, first_child and last_child its run of
blocks (int64), low, high, axes, angles, errors are float32. The first R blocks are the roots. Blocks without children
hold the surfels themselves, and all of these together every surfel once, bit by bit as it was written.
"""

from __future__ import annotations

import json
import struct
import zlib
from pathlib import Path
from typing import BinaryIO

import numpy as np

from ..surfels import LAYOUT, OPTIONAL_LAYOUT, Surfels, concatenate, field_values

SUFFIX = ".surfelblocks"
VERSION = 1
ALIGNMENT = 64
_MAGIC = b"SURFELBL"
_HEAD = struct.Struct("<8sIIQQ")
#: The longest directory that is read; a written one has some 1,500 bytes.
_LONGEST_DIRECTORY = 1 << 20

_FIELDS = {**LAYOUT, **OPTIONAL_LAYOUT}


def row_type(names) -> np.dtype:
    """The type of a row that has these fields of `Surfels`, in their order there."""
    columns = ((name, np.dtype(_FIELDS[name][1]).newbyteorder("<"), _FIELDS[name][0]) for name in _FIELDS)
    return np.dtype([(name, kind, (count,) if count > 1 else ()) for name, kind, count in columns if name in names])


def as_rows(surfels: Surfels, kind: np.dtype) -> np.ndarray:
    """(N,) rows; fields that the surfels lack have their defaults."""
    rows = np.empty(len(surfels), kind)
    for name in kind.names:
        rows[name] = field_values(surfels, name)
    return rows


def as_surfels(rows: np.ndarray, origin, is_solid: bool) -> Surfels:
    """The surfels of rows. Raises ValueError if any row is none."""
    return Surfels(origin=origin, is_solid=is_solid, **{name: rows[name] for name in rows.dtype.names})


def begin(stream: BinaryIO) -> None:
    """Leave room for the head, which says what is in the file once everything is."""
    stream.write(bytes(ALIGNMENT))


def align(stream: BinaryIO) -> int:
    """Fill up to the offset at which the next array begins, and return it."""
    offset = stream.tell()
    stream.write(bytes(-offset % ALIGNMENT))
    return stream.tell()


def finish(stream: BinaryIO, directory: dict) -> None:
    """Write the directory, and the head in front of everything."""
    text = json.dumps(directory).encode("ascii")
    offset = align(stream)
    stream.write(text)
    stream.seek(0)
    stream.write(_HEAD.pack(_MAGIC, VERSION, zlib.crc32(text), offset, len(text)))


def read_directory(path: Path) -> dict:
    """The directory of a file. Raises OSError if the file cannot be read, ValueError with a sentence if it has another
    format, another version, or is cut off or damaged."""
    size = path.stat().st_size
    with open(path, "rb") as stream:
        head = stream.read(_HEAD.size)
        if len(head) < _HEAD.size or not head.startswith(_MAGIC):
            raise ValueError(f"{path.name} is not a file of surfels in blocks; store surfels in one first.")
        _, version, checksum, offset, length = _HEAD.unpack(head)
        if version != VERSION:
            raise ValueError(
                f"{path.name} has version {version} of the format, and this extension reads version {VERSION}; store "
                "its surfels again."
            )
        if offset + length != size or length > _LONGEST_DIRECTORY:
            raise ValueError(
                f"{path.name} has {size:,} bytes where its head says {offset + length:,}: it is cut off or damaged; "
                "copy or store it again."
            )
        stream.seek(offset)
        text = stream.read(length)
    if zlib.crc32(text) != checksum:
        raise ValueError(f"{path.name} is damaged: the checksum of its directory is wrong; copy or store it again.")
    directory = json.loads(text)
    _check(path, directory, offset)
    return directory


def _check(path: Path, directory: dict, end: int) -> None:
    """Raise ValueError if an array does not fit into the file, or a field is unknown."""
    unknown = directory["fields"].keys() - _FIELDS.keys()
    wrong = [n for n, columns in directory["fields"].items() if n in _FIELDS and columns != _FIELDS[n][0]]
    if unknown or wrong:
        raise ValueError(f"{path.name} has a field that surfels lack: {sorted([*unknown, *wrong])[0]}; store it again.")
    for name, array in directory["arrays"].items():
        if name == "rows":
            size = array["count"] * row_type(directory["fields"]).itemsize
        else:
            size = int(np.prod(array["shape"])) * np.dtype(array["type"]).itemsize
        if array["offset"] + size > end:
            raise ValueError(f"{path.name} is damaged: its array {name} ends behind the file; store it again.")


def joined_rows(surfels: Surfels, nodes: Surfels, kind: np.dtype) -> np.ndarray:
    """(N + M,) rows of surfels, then of merged ones."""
    return as_rows(concatenate([surfels, nodes]), kind)
