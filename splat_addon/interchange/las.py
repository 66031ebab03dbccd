# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads LAS 1.0 to 1.4 (ASPRS), and LAZ and COPC, which are LAS with compressed points.

Only the decompression needs a module, lazrs, whose wheels the extension brings. A COPC file is read as the LAZ file
that it is, so its order does not matter; only if few of its points are wanted, `copc` says which.
Sizes are checked against the file before anything is allocated.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import BinaryIO

import numpy as np

from . import copc
from .clouds import COLOR, EXTRA, PORTION, PORTION_BYTES, Cloud, Table, without
from .las_records import Extra, read_records
from .laz import chunk_size, decompressed_chunk, decompressor

SIGNATURE = b"LASF"

#: The first bytes of the header, which all versions have; sizes in bytes by version.
_HEADER = np.dtype(
    {
        "names": ["major", "minor", "size", "points", "vlrs", "format", "length", "count", "scale", "offset"],
        "formats": ["u1", "u1", "<u2", "<u4", "<u4", "u1", "<u2", "<u4", ("<f8", 3), ("<f8", 3)],
        "offsets": [24, 25, 94, 96, 100, 104, 105, 107, 131, 155],
        "itemsize": 227,
    }
)
#: Where version 1.4 has the number of points, in a header of at least this size.
_COUNT_14, _SIZE_14 = 247, 375

#: Points of a thinned file that are decompressed, so that those that are taken are even; of more, only the beginnings
#: of the chunks are.
_MOST_DECOMPRESSED = 100_000_000

#: Bits of the point format that say that points are compressed.
_COMPRESSED = 0xC0

_PLACE = [("X", "<i4"), ("Y", "<i4"), ("Z", "<i4"), ("intensity", "<u2")]
_OLD = [*_PLACE, ("returns", "u1"), ("class", "u1"), ("angle", "i1"), ("user", "u1"), ("source", "<u2")]
_NEW = [*_PLACE, ("returns", "u1"), ("flags", "u1"), ("class", "u1"), ("user", "u1"), ("angle", "<i2")]
_NEW += [("source", "<u2"), ("gps_time", "<f8")]
_TIME, _COLORS, _INFRARED = [("gps_time", "<f8")], [(name, "<u2") for name in COLOR], [("infrared", "<u2")]
_WAVE = [("wave", "V29")]

#: point format -> fields of a point; those from 6 on are of version 1.4
POINT_FORMATS = [_OLD, _OLD + _TIME, _OLD + _COLORS, _OLD + _TIME + _COLORS, _OLD + _TIME + _WAVE]
POINT_FORMATS += [_OLD + _TIME + _COLORS + _WAVE, _NEW, _NEW + _COLORS, _NEW + _COLORS + _INFRARED, _NEW + _WAVE]
POINT_FORMATS += [_NEW + _COLORS + _INFRARED + _WAVE]
_FIRST_NEW = 6

#: Degrees of a step of the scan angle in formats of version 1.4.
_DEGREES = 0.006

#: Bits: the class in old formats, and a point that its owner deleted, in both.
_OLD_CLASS, _OLD_WITHHELD, _NEW_WITHHELD = 0x1F, 0x80, 0x04


@dataclass(frozen=True)
class _Header:
    """points: where they begin. count: how many the file says. record: numpy's type of one. format: 0 to 10. scale,
    offset: (3,), to metres. laszip: the description of the compression, None where there is none. extras: fields of
    the extra bytes. said: sentences about units."""

    points: int
    count: int
    record: np.dtype
    format: int
    scale: np.ndarray
    offset: np.ndarray
    laszip: bytes | None
    extras: tuple[Extra, ...]
    said: tuple[str, ...]


def is_this(head: bytes) -> bool:
    return head.startswith(SIGNATURE)


def opened(path: str | os.PathLike, most: int = 0) -> Cloud:
    """The points of the file; of more than `most`, if that is not 0, at most so many that lie everywhere, but of COPC
    its coarsest levels with at least so many. Raises ValueError with a sentence, OSError."""
    with open(path, "rb") as stream:
        header = _read_header(stream, os.path.getsize(path))
    cloud = Cloud(iter(()), said=[*header.said], count=header.count, is_thinned=0 < most < header.count)
    cloud.portions = _portions(path, header, cloud.said, most if cloud.is_thinned else 0)
    return cloud


def _portions(path: str | os.PathLike, header: _Header, said: list[str], most: int) -> Iterator[tuple[float, Table]]:
    withheld = 0
    with open(path, "rb") as stream:
        for share, rows in _rows(stream, os.path.getsize(path), header, most, said):
            table, deleted = _table(rows, header)
            withheld += int(deleted.sum())
            yield share, without(table, deleted)
    if withheld:
        said.append(f"Left out {withheld:,} points that the file marks as deleted (withheld)")
    unknown = header.record["extra"].itemsize - sum(each.kind.itemsize for each in header.extras)
    if unknown:
        said.append(f"Passed over {unknown} bytes of each point that the file adds to its point format (extra bytes)")


def _rows(
    stream: BinaryIO, size: int, header: _Header, most: int, said: list[str]
) -> Iterator[tuple[float, np.ndarray]]:
    """The share of the points so far, and rows of the file. most: as of `opened`. said: of the cloud."""
    length, done = header.record.itemsize, 0
    nodes = copc.coarsest(stream, size, header.points, header.laszip, most) if most else None
    read = _reader(stream, size, header)  # it checks the chunks
    if nodes is not None:
        for number, (place, count, packed) in enumerate(nodes):
            stream.seek(place)
            data = decompressed_chunk(stream.read(packed), count, header.laszip, length)
            yield (number + 1) / len(nodes), np.frombuffer(data, header.record)
        return
    runs = _runs(header, most)
    if len(runs) > 1:
        said.append(
            f"Took points from the beginnings of chunks only, because {header.count:,} would take long to decompress"
        )
    at_once = max(1, min(PORTION, PORTION_BYTES // length) // (1 if header.laszip is None else runs[0].step))
    total = max(sum(map(len, runs)), 1)
    for run in runs:
        for first in range(0, len(run), at_once):
            some = run[first : first + at_once]
            done += len(some)
            yield done / total, np.frombuffer(read(some), header.record)


def _runs(header: _Header, most: int) -> list[range]:
    """The numbers of the points to read: all if `most` is 0, or else at most so many."""
    ends, chunk = [(0, header.count)], None if header.laszip is None else chunk_size(header.laszip)
    if most and chunk and header.count > _MOST_DECOMPRESSED:
        each = max(1, chunk * _MOST_DECOMPRESSED // header.count)
        ends = [(first, min(first + each, header.count)) for first in range(0, header.count, chunk)]
    total = sum(last - first for first, last in ends)
    step = -(-total // max(most - len(ends), 1)) if most else 1
    return [range(first, last, max(step, 1)) for first, last in ends]


def _reader(stream: BinaryIO, size: int, header: _Header) -> Callable[[range], bytes]:
    """read(numbers) -> the bytes of the points of these numbers."""
    stream.seek(header.points)
    if header.laszip is not None:
        return decompressor(stream, size, header.laszip, header.record.itemsize, header.count)
    length = header.record.itemsize
    if header.count * length > size - header.points:
        raise ValueError(
            f"The LAS file says that it has {header.count:,} points of {length} bytes, but only "
            f"{max(size - header.points, 0):,} bytes are left for them; it is cut off or damaged; copy it again."
        )

    def run(first: int, count: int) -> bytes:
        stream.seek(header.points + first * length)
        return stream.read(count * length)

    def read(numbers: range) -> bytes:
        return run(numbers[0], len(numbers)) if numbers.step == 1 else b"".join(run(number, 1) for number in numbers)

    return read


def _table(rows: np.ndarray, header: _Header) -> tuple[Table, np.ndarray]:
    """The columns of rows of a file, and (N,) bool: which of them are deleted."""
    is_new = header.format >= _FIRST_NEW
    bits, mask = (4, 0x0F) if is_new else (3, 0x07)
    with np.errstate(over="ignore", invalid="ignore"):
        axes = zip("xyz", header.scale, header.offset, strict=True)
        table = {axis: rows[axis.upper()] * scale + offset for axis, scale, offset in axes}
    table["intensity"] = rows["intensity"].astype(np.uint16)
    table["return_number"] = rows["returns"] & mask
    table["number_of_returns"] = (rows["returns"] >> bits) & mask
    table["classification"] = rows["class"] if is_new else rows["class"] & _OLD_CLASS
    table["scan_angle"] = rows["angle"] * np.float32(_DEGREES if is_new else 1)
    names = {"gps_time": "gps_time", "user": "user_data", "source": "point_source_id", "infrared": "infrared"}
    for field, name in (names | {color: color for color in COLOR}).items():
        if field in rows.dtype.names:
            table[name] = rows[field].astype(rows[field].dtype.newbyteorder("="))
    if header.extras:
        extra = np.ascontiguousarray(rows["extra"]).view(np.uint8).reshape(len(rows), -1)
        table |= {EXTRA + each.name: each.of(extra) for each in header.extras}
    flags, withheld = (rows["flags"], _NEW_WITHHELD) if is_new else (rows["class"], _OLD_WITHHELD)
    return table, (flags & withheld) != 0


def _read_header(stream: BinaryIO, size: int) -> _Header:
    head = stream.read(_SIZE_14)
    if len(head) < _HEADER.itemsize:
        raise ValueError(f"The LAS file ends in its header, after {len(head)} bytes; it is cut off.")
    fields = np.frombuffer(head, _HEADER, 1)[0]
    version, number = f"{fields['major']}.{fields['minor']}", int(fields["format"]) & ~_COMPRESSED
    if fields["major"] != 1 or fields["minor"] > 4 or number >= len(POINT_FORMATS):
        raise ValueError(
            f"This LAS file has version {version} and point format {number}; versions 1.0 to 1.4 with formats 0 to "
            f"{len(POINT_FORMATS) - 1} can be read."
        )
    fields_of_point, length = np.dtype(POINT_FORMATS[number]), int(fields["length"])
    if length < fields_of_point.itemsize or not int(fields["size"]) <= fields["points"] <= size:
        raise ValueError(
            f"The LAS header says that points of format {number} have {length} bytes and begin at byte "
            f"{int(fields['points']):,} of {size:,}, which cannot be; the file is damaged."
        )
    scale, offset = (fields[name].astype(np.float64) for name in ("scale", "offset"))
    if not (np.isfinite(scale).all() and scale.all() and np.isfinite(offset).all()):
        raise ValueError(f"The LAS header has the scale {scale} and the offset {offset}; the file is damaged.")
    count = int(fields["count"])
    if fields["minor"] == 4 and fields["size"] >= _SIZE_14 and len(head) == _SIZE_14:
        count = int.from_bytes(head[_COUNT_14 : _COUNT_14 + 8], "little") or count
    record = np.dtype([*POINT_FORMATS[number], ("extra", f"V{length - fields_of_point.itemsize}")])
    start, end = int(fields["size"]), int(fields["points"])
    records = read_records(stream, start, end, int(fields["vlrs"]), record["extra"].itemsize)
    is_packed = bool(fields["format"] & _COMPRESSED)
    if is_packed and records.laszip is None:
        raise ValueError("The LAZ file does not say how its points are compressed; it is damaged.")
    metres = np.array([records.units[0], records.units[0], records.units[1]])
    laszip = records.laszip if is_packed else None
    return _Header(end, count, record, number, scale * metres, offset * metres, laszip, records.extras, records.said)
