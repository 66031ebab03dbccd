# SPDX-License-Identifier: GPL-3.0-or-later
"""The fields of a compressed vector of E57: each is a stream of bits, which data packets hold pieces of.

Numbers are integers from a minimum on in as few bits as the range needs, such integers scaled, or floats.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from xml.etree.ElementTree import Element

import numpy as np

from .clouds import PORTION
from .e57_pages import Pages

_SECTION, _VECTOR, _DATA_PACKET = 32, 1, 1
#: The head of a packet, and its most bytes.
_HEAD, _MOST_PACKET = 6, 1 << 16

_LARGEST = 2**63


@dataclass(frozen=True)
class Field:
    """kind: "Integer", "ScaledInteger" or "Float". bits: of a number. least: the smallest integer. scale, offset: of
    scaled ones. most: the largest number, 0 for floats."""

    name: str
    kind: str
    bits: int
    least: int = 0
    scale: float = 1.0
    offset: float = 0.0
    most: float = 0.0

    def values(self, stream: bytearray, first_bit: int, count: int) -> np.ndarray:
        """(count,) numbers: float32, float64, or int64."""
        if self.kind == "Float":
            return np.frombuffer(stream, f"<f{self.bits // 8}", count, first_bit // 8).astype(f"f{self.bits // 8}")
        raw = unpacked_bits(stream, first_bit, self.bits, count)
        with np.errstate(over="ignore"):
            whole = raw.view(np.int64) + np.int64(self.least)
        return whole if self.kind == "Integer" else whole * self.scale + self.offset


def fields_of(prototype: Element) -> list[Field]:
    """The fields of the points. Raises ValueError with a sentence."""
    return [_field(each) for each in prototype]


def _field(node: Element) -> Field:
    name, kind = node.tag.rpartition("}")[2], node.get("type", "")
    if kind == "Float":
        return Field(name, kind, 32 if node.get("precision") == "single" else 64)
    if kind not in ("Integer", "ScaledInteger"):
        raise ValueError(f"The E57 field {name[:40]!r} has the type {kind[:40]!r}; only numbers can be read.")
    least = number_in(node.get("minimum"), name, -_LARGEST, int)
    most = number_in(node.get("maximum"), name, _LARGEST - 1, int)
    scale, offset = (number_in(node.get(word), name, value) for word, value in (("scale", 1.0), ("offset", 0.0)))
    if not -_LARGEST <= least <= most < _LARGEST:
        raise ValueError(f"The E57 field {name[:40]!r} goes from {least} to {most}; the file is damaged.")
    return Field(name, kind, (most - least).bit_length(), least, scale, offset, most * scale + offset)


def number_in(text: str | None, name: str, otherwise: float, kind: type = float):
    """A finite number of the description. Raises ValueError with a sentence."""
    text = (text or "").strip()
    if not text:
        return otherwise
    try:
        number = kind(text) if len(text) < 60 else math.nan
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise ValueError(f"The E57 file has {text[:40]!r} as a number of {name[:40]!r}; it is damaged.")
    return number


def unpacked_bits(stream: bytearray, first: int, bits: int, count: int) -> np.ndarray:
    """(count,) uint64 from consecutive groups of bits, the lowest first."""
    if not bits:
        return np.zeros(count, np.uint64)
    if bits % 8 == 0 and first % 8 == 0 and bits // 8 in (1, 2, 4, 8):
        return np.frombuffer(stream, f"<u{bits // 8}", count, first // 8).astype(np.uint64)
    padded = np.frombuffer(bytes(stream) + bytes(9), np.uint8)
    # the eight bytes that begin at each byte
    words = np.ndarray(len(padded) - 8, "<u8", padded, strides=(1,))
    places = first + bits * np.arange(count)
    shift, at = (places & 7).astype(np.uint64), places >> 3
    values = words[at] >> shift
    if bits > 57:  # up to nine bytes
        with np.errstate(over="ignore"):
            high = padded[at + 8].astype(np.uint64) << np.uint64(1) << (np.uint64(63) - shift)
        values |= high
    return values & np.uint64((1 << bits) - 1)


class Streams:
    """The bits of all fields that were read and not used yet."""

    def __init__(self, fields: list[Field]):
        self._fields = fields
        self._bytes = [bytearray() for _ in fields]
        self._used = [0] * len(fields)

    def add(self, packet: bytes) -> None:
        """The pieces of a data packet. Raises ValueError with a sentence."""
        count = int.from_bytes(packet[4:6], "little")
        start = _HEAD + 2 * count
        sizes = np.frombuffer(packet[_HEAD:start].ljust(2 * count, b"\0"), "<u2").tolist()
        if count != len(self._fields) or start + sum(sizes) > len(packet):
            raise ValueError(
                f"A packet of the E57 file has {count:,} fields in {len(packet):,} bytes, where points have "
                f"{len(self._fields)}; it is damaged."
            )
        for stream, size in zip(self._bytes, sizes, strict=True):
            stream += packet[start : start + size]
            start += size

    def complete(self, most: int) -> int:
        """The number of points, at most so many, all of whose numbers are there."""
        pairs = zip(self._fields, self._bytes, self._used, strict=True)
        return min([most, *((8 * len(stream) - used) // field.bits for field, stream, used in pairs if field.bits)])

    def take(self, count: int) -> dict[str, np.ndarray]:
        """The next points, (count,) by name."""
        table = {}
        for k, field in enumerate(self._fields):
            table[field.name] = field.values(self._bytes[k], self._used[k], count)
            used = self._used[k] + count * field.bits
            # `values` may have made a view of the old bytes, which cannot be resized
            self._bytes[k], self._used[k] = self._bytes[k][used // 8 :], used % 8
        return table


def points_of(pages: Pages, offset: int, count: int, fields: list[Field]) -> Iterator[dict[str, np.ndarray]]:
    """The points of a compressed vector at a physical offset, by the names of its fields, a portion at a time. Raises
    ValueError with a sentence."""
    start = pages.logical(offset)
    head = pages.read(start, _SECTION)
    length, data = int.from_bytes(head[8:16], "little"), pages.logical(int.from_bytes(head[16:24], "little"))
    end = min(start + length, pages.size)
    if head[0] != _VECTOR or not start <= data <= end or (count and not any(field.bits for field in fields)):
        raise ValueError("The E57 file has no points where it says that they begin; it is damaged.")
    streams, left = Streams(fields), count
    while left and data + _HEAD <= end:
        head = pages.read(data, _HEAD)
        size = int.from_bytes(head[2:4], "little") + 1
        if head[0] == _DATA_PACKET:
            streams.add(pages.read(data, size))
            whole = streams.complete(left)
            if whole >= min(PORTION, left):
                left -= whole
                yield streams.take(whole)
        data += size
    if left:
        raise ValueError(
            f"The E57 file says that a scan has {count:,} points, but only {count - left + streams.complete(left):,} "
            "follow; it is cut off or damaged; copy it again."
        )
