# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes E57."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field

import numpy as np

from splat_addon.interchange.e57_pages import checksums

_PAGE, _CONTENT, _HEADER = 1024, 1020, 48


@dataclass
class Column:
    """A field of points. values: whole numbers as they are stored, or floats. about: the attributes of its element."""

    name: str
    values: np.ndarray
    about: str

    @property
    def stream(self) -> bytes:
        if self.values.dtype.kind == "f":
            return self.values.tobytes()
        low, high = (int(self.about.split(f'{end}="')[1].split('"')[0]) for end in ("minimum", "maximum"))
        width = (high - low).bit_length()
        raw = (self.values.astype(object) - low).astype(np.uint64)
        bits = (raw[:, None] >> np.arange(width, dtype=np.uint64)) & np.uint64(1)
        return np.packbits(bits.astype(np.uint8).ravel(), bitorder="little").tobytes()


@dataclass
class Scan:
    """columns: of the points. pose: XML of it, or nothing. count: the number of points that the file says."""

    columns: list
    pose: str = ""
    count: int | None = None
    extra: str = ""
    offset: int = field(default=0, init=False)


def whole(name: str, values: np.ndarray, low: int, high: int, scale: float | None = None) -> Column:
    kind = "Integer" if scale is None else "ScaledInteger"
    scaled = "" if scale is None else f' scale="{scale!r}" offset="0.5"'
    return Column(name, values, f'type="{kind}" minimum="{low}" maximum="{high}"{scaled}')


def floats(name: str, values: np.ndarray) -> Column:
    return Column(name, values, f'type="Float" precision="{"single" if values.dtype.itemsize == 4 else "double"}"')


def e57_file(scans: list[Scan], packet: int = 300) -> bytes:
    """The bytes of a file. packet: bytes of a field in each data packet."""
    content = bytearray(_HEADER)
    for scan in scans:
        scan.offset = _physical(len(content))
        content += _section([column.stream for column in scan.columns], len(content), packet)
    xml = "".join(_described(scan) for scan in scans)
    data = f'<data3D type="Vector">{xml}</data3D>'
    text = f'<?xml version="1.0" encoding="UTF-8"?><e57Root>{data}</e57Root>'.encode()
    start = len(content)
    content += text
    content += bytes(-len(content) % _CONTENT)
    pages = len(content) // _CONTENT
    content[:_HEADER] = struct.pack("<8sIIQQQQ", b"ASTM-E57", 1, 0, pages * _PAGE, _physical(start), len(text), _PAGE)
    return with_checksums(bytes(content))


def with_checksums(content: bytes) -> bytes:
    """The pages of bytes whose number is a multiple of 1020."""
    pages = np.frombuffer(content, np.uint8).reshape(-1, _CONTENT)
    sums = checksums(pages).astype(">u4")[:, None].view(np.uint8)
    return np.hstack([pages, sums]).tobytes()


def content_of(file: bytes) -> bytes:
    """The bytes of a file without checksums."""
    return np.frombuffer(file, np.uint8).reshape(-1, _PAGE)[:, :_CONTENT].tobytes()


def _physical(logical: int) -> int:
    return logical // _CONTENT * _PAGE + logical % _CONTENT


def _section(streams: list[bytes], start: int, packet: int) -> bytes:
    """A compressed vector that begins at a logical offset; an index packet, which readers pass over, is its first."""
    packets = struct.pack("<BBH12x", 0, 0, 15)
    for first in range(0, max(map(len, streams)), packet):
        pieces = [stream[first : first + packet] for stream in streams]
        body = struct.pack(f"<{len(pieces)}H", *map(len, pieces)) + b"".join(pieces)
        body += bytes(-(len(body) + 6) % 4)
        packets += struct.pack("<BBHH", 1, 0, len(body) + 5, len(pieces)) + body
    return struct.pack("<B7xQQQ", 1, 32 + len(packets), _physical(start + 32), 0) + packets


def _described(scan: Scan) -> str:
    count = len(scan.columns[0].values) if scan.count is None else scan.count
    fields = "".join(f"<{column.name} {column.about}/>" for column in scan.columns)
    points = f'<points type="CompressedVector" fileOffset="{scan.offset}" recordCount="{count}">'
    inside = f'{points}<prototype type="Structure">{fields}</prototype></points>'
    return f'<vectorChild type="Structure">{scan.pose}{scan.extra}{inside}</vectorChild>'


def pose(quaternion: tuple, translation: tuple) -> str:
    """XML of a pose."""
    turn, move = (
        "".join(f'<{name} type="Float">{value!r}</{name}>' for name, value in zip(names, values, strict=True))
        for names, values in (("wxyz", quaternion), ("xyz", translation))
    )
    return f'<pose type="Structure"><rotation>{turn}</rotation><translation>{move}</translation></pose>'
