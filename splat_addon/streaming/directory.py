# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the directory of a file of blocks (`layout`), and holds every number of it against the file's real size."""

from __future__ import annotations

import json
import zlib
from dataclasses import dataclass
from typing import BinaryIO

import numpy as np

from ..surfels import LAYOUT
from .layout import (
    COLUMNS,
    FIELDS,
    HEAD,
    MAGIC,
    PAGE,
    SCAN_COLUMNS,
    SCAN_VERSION,
    SUM,
    SUMS,
    UNCHECKED_VERSION,
    VERSION,
    row_type,
)

#: The longest directory that is read; a written one has some 1,500 bytes.
_LONGEST = 1 << 20
#: The longest id; a written one has 32 letters.
_LONGEST_ID = 64
_LARGEST = float(np.finfo(np.float64).max)


@dataclass(frozen=True, eq=False)
class Directory:
    """What a file says of itself, all of it possible.

    id: of what was written, or empty. surfels, rows, blocks, roots: their numbers. origin: (3,) float64. kind: type of
    a row. offsets: array -> where it begins; all arrays end before the directory. sums: "row_sums" and "block_sums" ->
    the CRC-32 of the array; empty for a file without checksums. scan: of `SCAN_COLUMNS` that it has -> the numbers that
    the bytes 0 and 255 stand for.
    """

    id: str
    surfels: int
    rows: int
    blocks: int
    roots: int
    origin: np.ndarray
    is_solid: bool
    is_transparent: bool
    kind: np.dtype
    offsets: dict[str, int]
    sums: dict[str, int]
    scan: dict[str, tuple[float, float]]


def read_directory(stream: BinaryIO, size: int, name: str) -> Directory:
    """The directory of an open file. size: of the file, bytes. name: for messages.

    Raises OSError if the file cannot be read, ValueError with a sentence if it has another format, another version, or
    is cut off or damaged.
    """
    head = stream.read(HEAD.size)
    if len(head) < HEAD.size or not head.startswith(MAGIC):
        raise ValueError(f"{name} is not a file of surfels in blocks; store surfels in one first.")
    _, version, checksum, offset, length = HEAD.unpack(head)
    if version not in (UNCHECKED_VERSION, VERSION, SCAN_VERSION):
        raise ValueError(
            f"{name} has version {version} of the format, and this extension reads versions up to {SCAN_VERSION}; "
            "store its surfels again."
        )
    if offset + length != size:
        raise ValueError(
            f"{name} has {size:,} bytes where its head says {offset + length:,}: it is cut off or damaged; copy or "
            "store it again."
        )
    if length > _LONGEST:
        raise ValueError(f"{name} is damaged: its directory has {length:,} bytes; copy or store it again.")
    stream.seek(offset)
    text = stream.read(length)
    if zlib.crc32(text) != checksum:
        raise ValueError(f"{name} is damaged: the checksum of its directory is wrong; copy or store it again.")
    try:
        return _directory(json.loads(text), offset, version)
    except _Wrong as error:
        raise ValueError(f"{name} is damaged: {error}; copy or store it again.") from None
    except (ValueError, RecursionError):
        raise ValueError(f"{name} is damaged: its directory cannot be read; copy or store it again.") from None


class _Wrong(Exception):
    """What is wrong with a directory, as the middle of a sentence."""


def _directory(values, end: int, version: int) -> Directory:
    """A checked directory. end: where the arrays end, bytes. Raises `_Wrong`."""
    values = _of_type(values, dict, "the directory")
    arrays = _of_type(values.get("arrays"), dict, "arrays")
    scan = _scan(values.get("scan")) if version == SCAN_VERSION else {}
    kind = _row_type(values.get("fields"), scan)
    rows = _count(_entry(arrays, "rows").get("count"), 1, end, "the number of rows")
    shape = _of_type(_entry(arrays, "first").get("shape"), list, "the shape of first")
    blocks = _count(shape[0] if shape else None, 1, end, "the number of blocks")
    sizes = {"rows": rows * kind.itemsize}
    for name, (columns, type_) in COLUMNS.items():
        _check_type(arrays, name, type_, [blocks, columns] if columns > 1 else [blocks])
        sizes[name] = blocks * columns * type_.itemsize
    sums = {}
    if version != UNCHECKED_VERSION:
        for name, count in zip(SUMS, (rows, blocks), strict=True):
            pages = -(-count // PAGE)
            _check_type(arrays, name, SUM, [pages])
            sizes[name] = pages * SUM.itemsize
            sums[name] = _count(_entry(arrays, name).get("checksum"), 0, 0xFFFFFFFF, f"the checksum of {name}")
    return Directory(
        _id(values.get("id", "")),
        _count(values.get("surfels"), 1, rows, "the number of surfels"),
        rows,
        blocks,
        _count(values.get("roots"), 1, blocks, "the number of roots"),
        _numbers(values.get("origin"), 3, "the origin"),
        _of_type(values.get("is_solid"), bool, "is_solid"),
        # the first files had opaque surfels only, and did not say so
        _of_type(values.get("is_transparent", False), bool, "is_transparent"),
        kind,
        {name: _offset(arrays, name, size, end) for name, size in sizes.items()},
        sums,
        scan,
    )


def _of_type(value, kind: type, what: str):
    if type(value) is not kind:
        raise _Wrong(f"{what} is {_short(value)} in its directory")
    return value


def _id(value) -> str:
    if len(_of_type(value, str, "the id")) > _LONGEST_ID:
        raise _Wrong(f"the id is {_short(value)} in its directory")
    return value


def _count(value, least: int, most: int, what: str) -> int:
    if type(value) is not int or not least <= value <= most:
        raise _Wrong(f"{what} is {_short(value)} in its directory")
    return value


def _short(value) -> str:
    text = repr(value)
    return text if len(text) <= 40 else f"{text[:40]}..."


def _entry(arrays: dict, name: str) -> dict:
    return _of_type(arrays.get(name), dict, f"the array {name}")


def _check_type(arrays: dict, name: str, kind: np.dtype, shape: list[int]) -> None:
    """Hold what the file says of an array against what it must be; nothing else of it is used."""
    array = _entry(arrays, name)
    for what, expected in (("type", kind.str), ("shape", shape)):
        if array.get(what) != expected:
            raise _Wrong(f"the {what} of {name} is {_short(array.get(what))} in its directory, not {expected!r}")


def _offset(arrays: dict, name: str, size: int, end: int) -> int:
    offset = _count(_entry(arrays, name).get("offset"), HEAD.size, end, f"the offset of {name}")
    if offset + size > end:
        raise _Wrong(f"its array {name} ends behind the file")
    return offset


def _row_type(fields, scan: dict) -> np.dtype:
    fields = _of_type(fields, dict, "fields")
    for name, columns in fields.items():
        if name not in FIELDS or type(columns) is not int or columns != FIELDS[name][0]:
            raise _Wrong(f"it has a field {_short(name)} with {_short(columns)} columns, which surfels lack")
    if missing := LAYOUT.keys() - fields.keys():
        raise _Wrong(f"it lacks the field {min(missing)}")
    return row_type([*fields, *scan])


def _scan(scan) -> dict[str, tuple[float, float]]:
    scan = _of_type(scan, dict, "scan")
    if unknown := scan.keys() - set(SCAN_COLUMNS):
        raise _Wrong(f"it has a column {_short(min(unknown))}, which scans lack")
    ranges = {name: tuple(_numbers(ends, 2, f"the range of {name}").tolist()) for name, ends in scan.items()}
    if wrong := [name for name, (low, high) in ranges.items() if low > high]:
        raise _Wrong(f"the range of {wrong[0]} is {_short(scan[wrong[0]])} in its directory")
    return ranges


def _numbers(values, count: int, what: str) -> np.ndarray:
    numbers = _of_type(values, list, what)
    # a whole number may be too large for a float, which is as bad as infinite
    if len(numbers) != count or not all(type(n) in (int, float) and -_LARGEST <= n <= _LARGEST for n in numbers):
        raise _Wrong(f"{what} is {_short(numbers)} in its directory")
    return np.array(numbers, np.float64)
