# SPDX-License-Identifier: GPL-3.0-or-later
"""The format of a file of surfels in blocks (`.surfelblocks`): plain arrays, little endian, each at a multiple of 64
bytes.

The first 32 bytes are the *head*: the word SURFELBL, the version (uint32), the CRC-32 of the directory (uint32), and
the directory's offset and length (uint64 each). The *directory* is at the end of the file and is JSON:

    {"id": "4f0c...", "surfels": N, "origin": [x, y, z], "is_solid": false, "is_transparent": false, "roots": R,
     "fields": {"positions": 3, ...},
     "arrays": {"rows": {"offset": o, "count": E}, "first": {"offset": o, "type": "<i8", "shape": [B]}, ...}}

*id* is random, 32 letters: no two files that were written have the same; the first ones have none.
*rows* are E surfels and merged surfels; a row has the fields of `Surfels` one after another, with as many numbers as
`fields` says, in the types of `Surfels`, all of them relative to the origin. Nine other arrays are the columns of
`hierarchy.blocks.Blocks` for B blocks, in the types of `COLUMNS`: first and last are a block's run of rows, first_child
and last_child its run of blocks, both with at most 1,024 entries; children come after their parents. The first R blocks
are the roots. Blocks without children hold the surfels themselves, and all of these together every surfel once, bit by
bit as it was written.

Version 3 is written for scans only, and has "scan": {"intensity": [low, high], ...} in its directory: numbers of
`SCAN_COLUMNS`, in one byte each, which follow the fields in each row. Bytes from 0 to 255 stand for low to high; what
lies beyond has the byte of the nearer end.

Rows and blocks are read in *pages* of 1,024. The arrays row_sums and block_sums (uint32) have the CRC-32 of each page;
that of a page of blocks goes over its part of the nine columns, one after another. Each of the two has its own CRC-32
in the directory, as "checksum".

A file is never trusted: types come from the code and not from the file, which only has to name the same ones, and
every number is held against the file's real size, or against the number of rows or blocks, before it is used.

Version 1, which was written until the end of 2026, is the same without the two arrays of sums. It is read with the
same bounds; what damage leaves within them cannot be noticed.
"""

from __future__ import annotations

import json
import struct
import zlib
from typing import BinaryIO

import numpy as np

from ..surfels import LAYOUT, OPTIONAL_LAYOUT, Surfels, concatenate, field_values

SUFFIX = ".surfelblocks"
VERSION = 2
#: The version without checksums, which is read too, and that of files with numbers of scans.
UNCHECKED_VERSION, SCAN_VERSION = 1, 3
ALIGNMENT = 64
#: Rows or blocks of a page, the least that is read: some 70 kB of rows. A block spans at most two pages of rows, and
#: its children at most two pages of blocks.
PAGE = 1024
MAGIC = b"SURFELBL"
HEAD = struct.Struct("<8sIIQQ")

#: Fields that a row may have -> their number of columns and their type.
FIELDS = {
    name: (columns, np.dtype(kind).newbyteorder("<"))
    for name, (columns, kind, *_) in {**LAYOUT, **OPTIONAL_LAYOUT}.items()
}

#: Numbers of scans that a row may have beside the fields, a byte each.
SCAN_COLUMNS = ("intensity", "classification")
_BYTE = np.dtype("u1")

#: Columns of `Blocks` in the file -> their number of columns and their type.
COLUMNS = {
    **dict.fromkeys(("first", "last", "first_child", "last_child"), (1, np.dtype("<i8"))),
    **dict.fromkeys(("low", "high", "axes"), (3, np.dtype("<f4"))),
    "angles": (1, np.dtype("<f4")),
    "errors": (3, np.dtype("<f4")),
}
#: Names and type of the arrays of checksums.
SUMS, SUM = ("row_sums", "block_sums"), np.dtype("<u4")


def row_type(names) -> np.dtype:
    """The type of a row that has these fields of `Surfels`, in their order there, then these of `SCAN_COLUMNS`."""
    columns = ((name, kind, (count,) if count > 1 else ()) for name, (count, kind) in FIELDS.items() if name in names)
    return np.dtype([*columns, *((name, _BYTE) for name in SCAN_COLUMNS if name in names)])


def as_rows(surfels: Surfels, kind: np.dtype, scan: dict[str, np.ndarray] | None = None) -> np.ndarray:
    """(N,) rows; fields that the surfels lack have their defaults. scan: (N,) uint8 of `SCAN_COLUMNS`."""
    rows = np.empty(len(surfels), kind)
    for name in kind.names:
        rows[name] = scan[name] if name in SCAN_COLUMNS else field_values(surfels, name)
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
    version = SCAN_VERSION if "scan" in directory else VERSION
    text = json.dumps(directory).encode("ascii")
    offset = align(stream)
    stream.write(text)
    stream.seek(0)
    stream.write(HEAD.pack(MAGIC, version, zlib.crc32(text), offset, len(text)))


class PageSums:
    """The CRC-32 of each page of some arrays that have a row for the same things, and follow one another."""

    def __init__(self):
        self._sums: list[int] = []
        self._size = self._place = 0

    def begin(self, row: int) -> None:
        """Begin the next array. row: bytes of a row."""
        self._size, self._place = PAGE * row, 0

    def add(self, data: memoryview) -> None:
        """Go on with some bytes of the array."""
        while len(data):
            number, done = divmod(self._place, self._size)
            some = data[: self._size - done]
            if number == len(self._sums):
                self._sums.append(0)
            self._sums[number] = zlib.crc32(some, self._sums[number])
            self._place += len(some)
            data = data[len(some) :]

    def write(self, stream: BinaryIO) -> dict:
        """Write the sums; returns their entry in the directory."""
        offset, sums = align(stream), np.array(self._sums, SUM)
        stream.write(sums.data)
        return {"offset": offset, "type": SUM.str, "shape": [len(sums)], "checksum": zlib.crc32(sums.data)}


def joined_rows(surfels: Surfels, nodes: Surfels, kind: np.dtype, scan: dict[str, np.ndarray]) -> np.ndarray:
    """(N + M,) rows of surfels, then of merged ones. scan: (N + M,) uint8 of `SCAN_COLUMNS`."""
    return as_rows(concatenate([surfels, nodes]), kind, scan)


def parted(fields: dict[str, np.ndarray]) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Columns of rows: the fields of `Surfels`, and those of `SCAN_COLUMNS`."""
    scan = {name: fields[name] for name in SCAN_COLUMNS if name in fields}
    return {name: column for name, column in fields.items() if name not in scan}, scan


def measured(scan: np.ndarray, low: float, high: float) -> np.ndarray:
    """(N,) float64 numbers that (N,) bytes stand for."""
    return low + scan * ((high - low) / 255)


def as_bytes(values: np.ndarray, low: float, high: float) -> np.ndarray:
    """(N,) uint8 that stand for finite numbers, those beyond low and high for these."""
    share = (np.clip(values, low, high) - low) / (high - low if high > low else 1.0)
    return np.rint(255 * share).astype(np.uint8)
