# SPDX-License-Identifier: GPL-3.0-or-later
"""The pages of an E57 file (ASTM E2807), each of which ends with a checksum, as one run of bytes.

Offsets in the file are *physical*: they count the checksums, which the bytes that are handed out lack.
"""

from __future__ import annotations

import struct
from typing import BinaryIO, NamedTuple

import numpy as np

SIGNATURE = b"ASTM-E57"
_HEADER = struct.Struct("<8sIIQQQQ")
_CHECKSUM = 4
_MOST_PAGE = 1 << 20
#: Bytes that are read and checked at a time.
_AHEAD = 1 << 22

#: CRC-32C (Castagnoli), reflected.
_POLYNOMIAL = 0x82F63B78


class Xml(NamedTuple):
    """Where the description is. offset: physical. length: in bytes without checksums."""

    offset: int
    length: int


class Pages:
    """The pages of an opened file. Raises ValueError with a sentence for what is no E57 file."""

    def __init__(self, stream: BinaryIO, size: int):
        head = stream.read(_HEADER.size)
        if len(head) < _HEADER.size:
            raise ValueError(f"The E57 file ends in its header, after {len(head)} bytes; it is cut off.")
        _, major, minor, length, xml, xml_length, page = _HEADER.unpack(head)
        if major != 1:
            raise ValueError(f"The E57 file has version {major}.{minor}; version 1 can be read.")
        if not _CHECKSUM < page <= _MOST_PAGE or page % 4 or length > size:
            raise ValueError(
                f"The E57 header says that {length:,} bytes are in pages of {page:,}, but the file has {size:,}; it is "
                "cut off or damaged; copy it again."
            )
        self._stream, self._page, self._content = stream, page, page - _CHECKSUM
        #: Bytes without checksums.
        self.size = length // page * self._content
        self.xml = Xml(xml, xml_length)
        self._known = 0, b""

    def logical(self, offset: int) -> int:
        """A physical offset without the checksums before it."""
        return offset // self._page * self._content + min(offset % self._page, self._content)

    def read(self, start: int, length: int) -> bytes:
        """Bytes from a logical offset on. Raises ValueError with a sentence if they are not there, or damaged."""
        if start < 0 or length < 0 or start + length > self.size:
            raise ValueError(
                f"The E57 file says that {length:,} bytes begin at {start:,}, but it has {self.size:,}; it is cut off "
                "or damaged."
            )
        begin, known = self._known
        if not begin <= start <= start + length <= begin + len(known):
            first = start // self._content
            begin, known = self._known = first * self._content, self._checked(first, max(length, _AHEAD))
        return known[start - begin :][:length]

    def _checked(self, first: int, length: int) -> bytes:
        """At least `length` bytes from a page on, fewer at the end of the file."""
        self._stream.seek(first * self._page)
        data = self._stream.read(min(length // self._content + 2, self.size // self._content - first) * self._page)
        pages = np.frombuffer(data, np.uint8)[: len(data) // self._page * self._page].reshape(-1, self._page)
        stored = pages[:, self._content :].copy().view(">u4")[:, 0]
        wrong = np.flatnonzero(stored != checksums(pages[:, : self._content]))
        if len(wrong):
            raise ValueError(f"The checksum of page {first + int(wrong[0]):,} of the E57 file is wrong; it is damaged.")
        return pages[:, : self._content].tobytes()


def _tables() -> np.ndarray:
    """(4, 256) uint32: what a byte contributes to a checksum after 0 to 3 further bytes."""
    tables = np.arange(256, dtype=np.uint32)[None].repeat(4, axis=0)
    for _ in range(8):
        half = tables[0] >> np.uint32(1)
        tables[0] = np.where(tables[0] & 1, half ^ np.uint32(_POLYNOMIAL), half)
    for after in range(1, 4):
        tables[after] = tables[0][tables[after - 1] & np.uint32(255)] ^ tables[after - 1] >> np.uint32(8)
    return tables


_TABLES = _tables()


def checksums(pages: np.ndarray) -> np.ndarray:
    """(n,) uint32 CRC-32C of (n, bytes) pages, whose length is a multiple of 4; four bytes of all pages at a time."""
    words = np.ascontiguousarray(np.ascontiguousarray(pages).view("<u4").T)
    sums = np.full(len(pages), 0xFFFFFFFF, np.uint32)
    for word in words:
        sums ^= word
        sums = (
            _TABLES[3][sums & np.uint32(255)]
            ^ _TABLES[2][sums >> np.uint32(8) & np.uint32(255)]
            ^ _TABLES[1][sums >> np.uint32(16) & np.uint32(255)]
            ^ _TABLES[0][sums >> np.uint32(24)]
        )
    return ~sums
