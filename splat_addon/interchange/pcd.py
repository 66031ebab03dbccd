# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads PCD (Point Cloud Library) 0.5 to 0.7: text, binary, and binary compressed by LZF.

rgb, and rgba, are a colour packed into four bytes, blue first, also where the header says that they are a float.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from dataclasses import dataclass
from typing import BinaryIO

import numpy as np

from .clouds import COLOR, PORTION, PORTION_BYTES, Cloud, Table
from .columns import NORMAL, POSITION
from .lzf import LEAST_SHARE, unpacked
from .text_rows import Lines, is_text, table_of

_MOST_HEADER = 1 << 16
_WORDS = ("VERSION", "FIELDS", "SIZE", "TYPE", "COUNT", "WIDTH", "HEIGHT", "VIEWPOINT", "POINTS", "DATA")
_KINDS = {"F": "f", "I": "i", "U": "u"}
#: Kinds and sizes that numbers have.
_TYPES = {f"{kind}{size}" for kind in "iu" for size in (1, 2, 4, 8)} | {"f4", "f8"}
_PACKED, _PADDING = ("rgb", "rgba"), "_"
_NAMES = {"normal_x": NORMAL[0], "normal_y": NORMAL[1], "normal_z": NORMAL[2]}


@dataclass(frozen=True)
class _Header:
    """start: bytes of the header. lines: its lines. record: numpy's type of a point. count: of points. data: "ascii",
    "binary" or "binary_compressed". viewpoint: where the scanner stood."""

    start: int
    lines: int
    record: np.dtype
    count: int
    data: str
    viewpoint: np.ndarray


def is_this(head: bytes) -> bool:
    lines = (line.strip() for line in head[:4096].splitlines())
    first = next((line for line in lines if line and not line.startswith(b"#")), b"")
    return first.split()[:1] == [b"VERSION"] or (first.split()[:1] == [b"FIELDS"] and is_text(head[:64]))


def opened(path: str | os.PathLike) -> Cloud:
    """The points of the file. Raises ValueError with a sentence, OSError."""
    with open(path, "rb") as stream:
        header = _read_header(stream.read(_MOST_HEADER))
    cloud = Cloud(_portions(path, header))
    if header.viewpoint.any():
        cloud.places[0] = header.viewpoint
    return cloud


def _portions(path: str | os.PathLike, header: _Header) -> Iterator[tuple[float, Table]]:
    size, done = os.path.getsize(path), 0
    with open(path, "rb") as stream:
        for rows in _READERS[header.data](stream, size, header):
            done += len(rows)
            yield done / max(header.count, 1), _table(rows)
    if done < header.count:
        raise ValueError(
            f"The PCD file says that it has {header.count:,} points, but only {done:,} follow; it is cut off or "
            "damaged."
        )


def _text(stream: BinaryIO, size: int, header: _Header) -> Iterator[np.ndarray]:
    lines = Lines(stream, size)
    lines.take(header.lines)
    width = sum(_counts(header.record))
    while chunk := lines.take(PORTION):
        separator = "," if "," in chunk[0] else None
        yield _as_records(table_of(chunk, width, separator, lines.number - len(chunk) + 1), header.record)


def _as_records(table: np.ndarray, record: np.dtype) -> np.ndarray:
    rows, column = np.zeros(len(table), record), 0
    for name, count in zip(record.names, _counts(record), strict=True):
        part = table[:, column : column + count]
        with np.errstate(over="ignore", invalid="ignore"):
            rows[name] = (part if count > 1 else part[:, 0]).astype(record[name].base)
        column += count
    return rows


def _binary(stream: BinaryIO, size: int, header: _Header) -> Iterator[np.ndarray]:
    length = header.record.itemsize
    if header.count * length > size - header.start:
        raise ValueError(
            f"The PCD file says that it has {header.count:,} points of {length} bytes, but only "
            f"{max(size - header.start, 0):,} bytes are left for them; it is cut off or damaged; copy it again."
        )
    stream.seek(header.start)
    most = max(1, min(PORTION, PORTION_BYTES // length))
    for first in range(0, header.count, most):
        yield np.frombuffer(stream.read(min(most, header.count - first) * length), header.record)


def _compressed(stream: BinaryIO, size: int, header: _Header) -> Iterator[np.ndarray]:
    """Such a file has all values of a field one after another."""
    stream.seek(header.start)
    packed, whole = (int.from_bytes(stream.read(4), "little") for _ in range(2))
    left = max(size - header.start - 8, 0)
    if packed > left or whole != header.count * header.record.itemsize or whole > packed / LEAST_SHARE:
        raise ValueError(
            f"The PCD file says that {packed:,} bytes hold {header.count:,} points of {header.record.itemsize} bytes, "
            f"packed to {whole:,}, but {left:,} bytes are left; it is cut off or damaged; copy it again."
        )
    data, start = unpacked(stream.read(packed), whole), 0
    rows = np.zeros(header.count, header.record)
    for name in header.record.names:
        kind = header.record[name]
        rows[name] = np.frombuffer(data, kind, header.count, start)
        start += header.count * kind.itemsize
    yield rows


_READERS = {"ascii": _text, "binary": _binary, "binary_compressed": _compressed}


def _counts(record: np.dtype) -> list[int]:
    return [int(np.prod(record[name].shape, dtype=int)) for name in record.names]


def _table(rows: np.ndarray) -> Table:
    """The columns of rows, by their usual names."""
    table = {}
    for name in rows.dtype.names:
        values = np.ascontiguousarray(rows[name])
        if name.lower() in _PACKED and values.dtype.itemsize == 4:
            packed = values.view(np.uint32)
            for color, shift in zip(COLOR, (16, 8, 0), strict=True):
                table[color] = (packed >> np.uint32(shift) & np.uint32(255)).astype(np.uint8)
        elif values.ndim == 1 and not name.startswith(_PADDING):
            name = name.lower()
            table[_NAMES.get(name, name)] = values.astype(np.float64) if name in POSITION else values
    return table


def _read_header(head: bytes) -> _Header:
    given, start, count = {}, 0, 0
    while "DATA" not in given and start < len(head):
        end = head.find(b"\n", start)
        end = len(head) if end < 0 else end + 1
        word, *words = head[start:end].decode("latin-1").split() or [""]
        start, count = end, count + 1
        if word in _WORDS:
            given[word] = words
        elif word and not word.startswith("#"):
            raise ValueError(f"The PCD header has a line that no PCD file has, {word[:40]!r}; the file is damaged.")
    if missing := [word for word in ("FIELDS", "SIZE", "TYPE", "DATA") if not given.get(word)]:
        raise ValueError(f"The PCD header has no line {missing[0]!r}; the file is cut off or damaged; copy it again.")
    if given["DATA"][0] not in _READERS:
        raise ValueError(f"PCD data are one of {', '.join(_READERS)}, not {given['DATA'][0][:40]!r}.")
    sizes = _whole(given.get("WIDTH", [])) + _whole(given.get("HEIGHT", []))
    points = _whole(given.get("POINTS", [])) or [math.prod(sizes)]
    place = np.array([float(w) for w in given.get("VIEWPOINT", [])[:3] if _is_number(w)])
    place = place if place.shape == (3,) and np.isfinite(place).all() else np.zeros(3)
    return _Header(start, count, _record(given, given["DATA"][0] == "ascii"), points[0], given["DATA"][0], place)


def _record(given: dict[str, list[str]], is_text: bool) -> np.dtype:
    """numpy's type of a point. In text, coordinates have all the digits that are written."""
    names, sizes, kinds = given["FIELDS"], given["SIZE"], given["TYPE"]
    counts = _whole(given.get("COUNT", ["1"] * len(names)))
    if not len(names) == len(sizes) == len(kinds) == len(counts):
        raise ValueError(
            "The PCD header's lines FIELDS, SIZE, TYPE and COUNT do not have equally many words; correct them."
        )
    fields, used = [], set()
    for name, size, kind, count in zip(names, sizes, kinds, counts, strict=True):
        code = f"{_KINDS.get(kind, kind)[:1]}{size}"
        if code not in _TYPES or not 0 < count < 65536:
            raise ValueError(
                f"The PCD field {name[:40]!r} has {count} numbers of type {kind[:8]} and size {size[:8]}; correct them."
            )
        if is_text and name.lower() in POSITION:
            code = "f8"
        name = name if name not in used else f"{_PADDING}{len(used)}"
        used.add(name)
        fields.append((name, f"<{code}") if count == 1 else (name, f"<{code}", (count,)))
    return np.dtype(fields)


def _whole(words: list[str]) -> list[int]:
    """Words as whole numbers. Raises ValueError with a sentence."""
    if bad := [word for word in words if not (word.isascii() and word.isdigit() and len(word) < 19)]:
        raise ValueError(f"The PCD header has {bad[0][:40]!r} where a whole number must be; the file is damaged.")
    return [int(word) for word in words]


def _is_number(word: str) -> bool:
    try:
        return bool(np.isfinite(float(word)))
    except ValueError:
        return False
