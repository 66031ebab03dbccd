# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the coarsest points of a COPC file, which is LAZ whose chunks are the nodes of an octree.

A node's points are few and even over its cube; those of its children are between them. Pages of 32-byte entries say
where the chunk of each node is.
"""

from __future__ import annotations

from typing import BinaryIO

import numpy as np

from .laz import chunks_at, lazrs

#: The first record of such a file is this one's: its user, at its place, and its number; where the root page is said.
_USER, _AT, _ROOT = b"copc", 375 + 2, 375 + 54 + 40

_ENTRY = np.dtype(
    [("level", "<i4"), ("x", "<i4"), ("y", "<i4"), ("z", "<i4"), ("offset", "<u8"), ("bytes", "<i4"), ("count", "<i4")]
)


def coarsest(
    stream: BinaryIO, size: int, start: int, laszip: bytes | None, most: int
) -> list[tuple[int, int, int]] | None:
    """Place in the file, number of points and of bytes of the chunks of the coarsest levels that have at least `most`
    points together; None if the file is not COPC. start: of the points. Raises ValueError with a sentence."""
    stream.seek(_AT)
    if laszip is None or lazrs is None or not stream.read(16).startswith(_USER):
        return None
    stream.seek(_ROOT)
    entries = _entries(stream, size, *np.frombuffer(stream.read(16).ljust(16, b"\0"), "<u8").tolist())
    chunks = chunks_at(stream, size, start, laszip)
    taken, total = [], 0
    for level in np.unique(entries["level"]):
        nodes = entries[(entries["level"] == level) & (entries["count"] > 0)]
        for offset in nodes["offset"].tolist():
            if offset not in chunks:
                raise ValueError("A node of the COPC file's octree is where no chunk of points is; it is damaged.")
            taken.append((offset, *chunks[offset]))
        total += int(nodes["count"].sum(dtype=np.int64))
        if total >= most:
            break
    return sorted(taken)


def _entries(stream: BinaryIO, size: int, offset: int, length: int) -> np.ndarray:
    """The entries of nodes in all pages."""
    waiting, seen, found = [(offset, length)], set(), [np.empty(0, _ENTRY)]
    while waiting:
        offset, length = waiting.pop()
        if offset in seen or length < 0 or offset + length > size or length % _ENTRY.itemsize:
            raise ValueError("A page of the COPC file's octree is outside the file or there twice; it is damaged.")
        seen.add(offset)
        stream.seek(offset)
        page = np.frombuffer(stream.read(length), _ENTRY)
        is_page = page["count"] == -1
        waiting += [(int(each["offset"]), int(each["bytes"])) for each in page[is_page]]
        found.append(page[~is_page])
    return np.concatenate(found)
