# SPDX-License-Identifier: GPL-3.0-or-later
"""Decompresses the points of LAZ and COPC files by lazrs, the one module besides numpy that a reader needs.

It is a wheel of the extension; where it is missing, a sentence says so. What lazrs would trust is checked first.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import BinaryIO

try:
    import lazrs
except ImportError:
    lazrs = None

#: A chunk table has a head of this size, and lazrs keeps this many bytes of each chunk.
_TABLE_HEAD, _LEAST_CHUNK = 8, 1


def decompressor(
    stream: BinaryIO, size: int, laszip: bytes, length: int, total: int
) -> Callable[[int, int], bytearray]:
    """read(count, first) -> the bytes of the next points, of which `first` were read already.

    stream: at the first point. size: of the file. laszip: its description of the compression. length: bytes of a
    point. Raises ValueError with a sentence.
    """
    if lazrs is None:
        raise ValueError(
            "To read LAZ and COPC takes the module lazrs, which this installation lacks; install the extension from "
            "the zip that scripts/build.py makes, or save the file as LAS."
        )
    start = stream.tell()
    _check_chunk_table(stream, start, size)
    stream.seek(start)
    source = _trusted(lambda: lazrs.LasZipDecompressor(stream, laszip))
    if _trusted(lambda: lazrs.LazVlr(laszip).item_size()) != length:
        raise ValueError(f"The LAZ file does not compress the points of {length} bytes that it has; it is damaged.")

    def read(count: int, first: int) -> bytearray:
        points = bytearray(count * length)
        _trusted(lambda: source.decompress_many(points), f"after {first:,} of {total:,} points")
        return points

    return read


def _check_chunk_table(stream: BinaryIO, start: int, size: int) -> None:
    """Raise ValueError for a chunk table that is outside the file or claims more chunks than the file has bytes."""
    table = int.from_bytes(stream.read(8), "little", signed=True)
    if table == -1:  # a writer that cannot go back leaves it at the end
        stream.seek(max(size - 8, 0))
        table = int.from_bytes(stream.read(8), "little", signed=True)
    if start <= table <= size - _TABLE_HEAD:
        stream.seek(table)
        chunks = int.from_bytes(stream.read(_TABLE_HEAD)[4:], "little")
        if chunks * _LEAST_CHUNK <= table - start:
            return
    raise ValueError("The LAZ file's table of chunks is outside the file or larger than it; it is cut off or damaged.")


def _trusted(call: Callable, where: str = "at its first point"):
    """What a call of lazrs returns. A panic of its Rust code is no Exception, but the file's fault all the same."""
    try:
        return call()
    except BaseException as error:
        if isinstance(error, (KeyboardInterrupt, SystemExit, MemoryError)):
            raise
        why = " ".join(str(error).split())[:80]
    raise ValueError(f"The LAZ file cannot be decompressed {where}; it is cut off or damaged ({why}).")
