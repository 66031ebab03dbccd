# SPDX-License-Identifier: GPL-3.0-or-later
"""Unpacks LZF (Lehmann's LibLZF), with which PCD files are compressed."""

from __future__ import annotations

#: Three bytes stand for at most 264.
LEAST_SHARE = 1 / 88


def unpacked(packed: bytes, size: int) -> bytes:
    """The `size` bytes that were packed. Raises ValueError with a sentence if they are others.

    A byte below 32 is followed by one more than its number of bytes as they are; any other repeats bytes: its upper
    three bits, or with 7 the next byte too, say how many besides two, and the rest how far back they are.
    """
    out, at, end = bytearray(), 0, len(packed)
    while at < end and len(out) < size:
        control = packed[at]
        at += 1
        if control < 32:
            out += packed[at : at + control + 1]
            at += control + 1
            continue
        length = control >> 5
        if length == 7 and at < end:
            length += packed[at]
            at += 1
        if at >= end:
            break
        start = len(out) - ((control & 31) << 8 | packed[at]) - 1
        at += 1
        if start < 0:
            break
        piece = out[start : start + length + 2]
        # what it repeats may be what it makes
        out += (piece * ((length + 2) // len(piece) + 1))[: length + 2]
    if len(out) != size:
        raise ValueError(
            f"The compressed points have {len(out):,} of {size:,} bytes; the file is cut off or damaged; copy it again."
        )
    return bytes(out)
