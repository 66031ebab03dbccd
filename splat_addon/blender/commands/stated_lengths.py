# SPDX-License-Identifier: GPL-3.0-or-later
"""The length that a picture's own header states, of formats that Blender 4.5 opens although their end is missing.

Sources: Google, "WebP Container Specification"; Haeberli, "The SGI Image File Format Version 1.00" (Blender's Iris).
"""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np

#: The largest head of a file that is looked at: an Iris picture's header and tables, which have two numbers a row.
_HEADER, _LARGEST_TABLES = 512, 1 << 26


def stated_length(file: Path) -> int:
    """The least number of bytes that a whole file has; 0 if its header states none. Raises OSError."""
    with open(file, "rb") as stream:
        head = stream.read(_HEADER)
        if head[:4] == b"RIFF" and len(head) >= 8:
            return 8 + struct.unpack_from("<I", head, 4)[0]
        if head[:2] != b"\x01\xda" or len(head) < _HEADER:
            return 0
        is_packed, depth, _, width, height, channels = struct.unpack_from(">BBHHHH", head, 2)
        if not is_packed:
            return _HEADER + depth * width * height * channels
        rows = height * channels
        tables = stream.read(min(8 * rows, _LARGEST_TABLES))
    if len(tables) < 8 * rows:
        return _HEADER + 8 * rows
    starts, lengths = np.frombuffer(tables, ">u4").astype(np.int64).reshape(2, rows)
    return int((starts + lengths).max(initial=_HEADER))
