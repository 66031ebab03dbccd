# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes small files of the formats that scanners write, for the fuzzer and for tests of the readers."""

from __future__ import annotations

import io
import struct

import numpy as np

from splat_addon.interchange.las import POINT_FORMATS

#: The scale and the offset of the coordinates in files of LAS.
SCALE, OFFSET = (0.001, 0.01, 0.5), (500000.0, -3e6, 0.25)


def las_rows(number: int, count: int, extra: int = 0) -> np.ndarray:
    """Points of a format of LAS with random fields, none of them deleted. extra: bytes of unknown meaning."""
    random = np.random.default_rng(number)
    rows = np.zeros(count, [*POINT_FORMATS[number], ("extra", f"V{extra}")])
    for name in rows.dtype.names:
        kind = rows.dtype[name]
        if kind.kind in "iu":
            limits = np.iinfo(kind)
            rows[name] = random.integers(limits.min, limits.max, count, kind.newbyteorder("="), endpoint=True)
        elif kind.kind == "f":
            rows[name] = random.uniform(0, 1e9, count)
    if number < 6:
        rows["class"] &= 0x7F
    else:
        rows["flags"] &= 0xFB
    return rows


def las_file(
    rows: np.ndarray,
    number: int,
    minor: int,
    is_packed: bool = False,
    count: int | None = None,
    scale=SCALE,
    offset=OFFSET,
) -> bytes:
    """A file of LAS 1.`minor`, or LAZ. count: the number of points that it says it has."""
    size = 375 if minor == 4 else 235 if minor == 3 else 227
    record, vlr = b"", None
    if is_packed:
        import lazrs

        vlr = lazrs.LazVlr.new_for_compression(number, rows.dtype["extra"].itemsize, False)
        data = bytes(vlr.record_data())
        record = struct.pack("<H16sHH32s", 0, b"laszip encoded", 22204, len(data), b"") + data
    count, head = len(rows) if count is None else count, bytearray(size)
    struct.pack_into("<4s", head, 0, b"LASF")
    struct.pack_into("<BB", head, 24, 1, minor)
    struct.pack_into("<HII", head, 94, size, size + len(record), bool(record))
    struct.pack_into("<BHI", head, 104, number | 0x80 * is_packed, rows.dtype.itemsize, count if minor < 4 else 0)
    struct.pack_into("<6d", head, 131, *scale, *offset)
    if minor == 4:
        struct.pack_into("<Q", head, 247, count)
    stream = io.BytesIO()
    stream.write(bytes(head) + record)
    if vlr is None:
        stream.write(rows.tobytes())
    else:
        compressor = lazrs.LasZipCompressor(stream, vlr)
        compressor.compress_many(np.frombuffer(rows.tobytes(), np.uint8))
        compressor.done()
    return stream.getvalue()
