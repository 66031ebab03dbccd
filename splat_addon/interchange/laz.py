# SPDX-License-Identifier: GPL-3.0-or-later
"""Decompresses the points of LAZ and COPC files by lazrs, the one module besides numpy that a reader needs.

It is a wheel of the extension; where it is missing, a sentence says so. What lazrs would trust is checked first.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from io import BytesIO
from typing import BinaryIO

import numpy as np

from .clouds import PORTION

try:
    import lazrs
except ImportError:
    lazrs = None

#: The head of a chunk table: its version, and the number of chunks.
_TABLE_HEAD = 8

#: Where the description of the compression has its items, each a type, a size and a version.
_ITEMS = 34
#: Ways to compress: one run without chunks; and in layers, each of whose sizes is at the beginning of a chunk.
_ONE_RUN, _LAYERED = 1, 3
#: type of an item -> its layers; of extra bytes, each is one.
_LAYERS, _EXTRA_BYTES = {10: 9, 11: 1, 12: 2, 13: 1}, 14


def decompressor(stream: BinaryIO, size: int, laszip: bytes, length: int, total: int) -> Callable[[range], bytes]:
    """read(numbers) -> the bytes of the points of these numbers; those between them are decompressed too.

    stream: at the first point. size: of the file. laszip: its description of the compression. length: bytes of a
    point. Raises ValueError with a sentence.
    """
    if lazrs is None:
        raise ValueError(
            "To read LAZ and COPC takes the module lazrs, which this installation lacks; install the extension from "
            "the zip that scripts/build.py makes, or save the file as LAS."
        )
    start = stream.tell()
    if int.from_bytes(laszip[:2], "little") != _ONE_RUN:
        _check_chunks(stream, start, _chunk_table(stream, start, size), laszip, length, total)
    stream.seek(start)
    # several threads need chunks that can be counted
    kind = lazrs.LasZipDecompressor if chunk_size(laszip) is None else lazrs.ParLasZipDecompressor
    source = _trusted(lambda: kind(stream, laszip))
    if _trusted(lambda: lazrs.LazVlr(laszip).item_size()) != length:
        raise ValueError(f"The LAZ file does not compress the points of {length} bytes that it has; it is damaged.")

    place = 0

    def read(numbers: range) -> bytes:
        nonlocal place
        first, where = numbers[0], f"after {numbers[0]:,} of {total:,} points"
        if not 0 <= first - place <= PORTION:
            _trusted(lambda: source.seek(first), where)
            place = first
        skipped, before = first - place, place
        place = numbers[-1] + 1
        points = np.empty((place - before, length), np.uint8)
        _trusted(lambda: source.decompress_many(points.reshape(-1)), where)
        return points[skipped :: numbers.step].tobytes()

    return read


def chunk_size(laszip: bytes) -> int | None:
    """Points of a chunk, by the description of the compression; None if chunks differ or there are none."""
    if lazrs is None or int.from_bytes(laszip[:2], "little") == _ONE_RUN:
        return None
    vlr = _trusted(lambda: lazrs.LazVlr(laszip))
    return None if vlr.uses_variable_size_chunks() else max(int(vlr.chunk_size()), 1)


def chunks_at(stream: BinaryIO, size: int, start: int, laszip: bytes) -> dict[int, tuple[int, int]]:
    """Where in the file each chunk begins -> its number of points and of bytes. start: of the points. Raises ValueError
    with a sentence."""
    stream.seek(start)
    _chunk_table(stream, start, size)
    stream.seek(start)
    vlr = _trusted(lambda: lazrs.LazVlr(laszip))
    place, found = start + 8, {}
    for count, length in _trusted(lambda: lazrs.read_chunk_table(stream, vlr)):
        found[place] = count, length
        place += length
    return found


def decompressed_chunk(data: bytes, count: int, laszip: bytes, length: int) -> bytearray:
    """The bytes of the `count` points of a chunk, each of `length`: read as those of a file that has no other one,
    because lazrs finds chunks of one size only. Raises ValueError with a sentence."""
    file = BytesIO((8 + len(data)).to_bytes(8, "little") + data)
    file.seek(0, os.SEEK_END)
    _trusted(lambda: lazrs.write_chunk_table(file, [(count, len(data))], lazrs.LazVlr(laszip)))
    file.seek(0)
    points = bytearray(count * length)
    _trusted(lambda: lazrs.LasZipDecompressor(file, laszip).decompress_many(points), "in one of its chunks")
    return points


def _chunk_table(stream: BinaryIO, start: int, size: int) -> int:
    """Where the table of chunks is. Raises ValueError with a sentence for one that is outside the file or claims more
    chunks than the file has bytes."""
    table = int.from_bytes(stream.read(8), "little", signed=True)
    if table == -1:  # a writer that cannot go back leaves it at the end
        stream.seek(max(size - 8, 0))
        table = int.from_bytes(stream.read(8), "little", signed=True)
    if start <= table <= size - _TABLE_HEAD:
        stream.seek(table)
        if int.from_bytes(stream.read(_TABLE_HEAD)[4:], "little") <= table - start:
            return table
    raise ValueError(
        "The LAZ file's table of chunks is outside the file or larger than it; it is cut off or damaged; copy it again."
    )


def _check_chunks(stream: BinaryIO, start: int, table: int, laszip: bytes, length: int, total: int) -> None:
    """Raise ValueError with a sentence if the chunks do not end where the table says, or have fewer points than the
    header says. lazrs allocates what the layers' sizes say."""
    vlr = _trusted(lambda: lazrs.LazVlr(laszip))
    stream.seek(start)
    chunks = _trusted(lambda: lazrs.read_chunk_table(stream, vlr))
    points = sum(points for points, _ in chunks) if vlr.uses_variable_size_chunks() else len(chunks) * vlr.chunk_size()
    if points < total:
        raise ValueError(
            f"The LAZ file says that it has {total:,} points, but its chunks have at most {points:,}; it is cut off or "
            "damaged."
        )
    layers, place = _number_of_layers(laszip), start + 8
    for number, (_, size) in enumerate(chunks):
        head = length + 4 + 4 * layers if layers else 0
        stream.seek(place + length + 4)
        sizes = np.frombuffer(stream.read(4 * layers).ljust(4 * layers, b"\0"), "<u4")
        if place + size > table or (layers and head + int(sizes.sum(dtype=np.int64)) != size):
            raise ValueError(
                f"Chunk {number + 1:,} of the LAZ file does not have the size that its table says; it is damaged."
            )
        place += size


def _number_of_layers(laszip: bytes) -> int:
    """The layers of a chunk; 0 if there are none."""
    if int.from_bytes(laszip[:2], "little") != _LAYERED:
        return 0
    items = np.frombuffer(laszip[_ITEMS : _ITEMS + (len(laszip) - _ITEMS) // 6 * 6], "<u2").reshape(-1, 3)
    return sum(int(size) if kind == _EXTRA_BYTES else _LAYERS.get(int(kind), 0) for kind, size, _ in items)


def _trusted(call: Callable, where: str = "at its first point"):
    """What a call of lazrs returns. A panic of its Rust code is no Exception, but the file's fault all the same."""
    try:
        return call()
    except BaseException as error:
        if isinstance(error, (KeyboardInterrupt, SystemExit, MemoryError)):
            raise
        why = " ".join(str(error).split())[:80]
    raise ValueError(f"The LAZ file cannot be decompressed {where}; it is cut off or damaged ({why}); copy it again.")
