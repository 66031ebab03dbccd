# SPDX-License-Identifier: GPL-3.0-or-later
"""A file of blocks taken apart, changed, and put together with right checksums, as somebody could who means harm."""

from __future__ import annotations

import json
import zlib

import numpy as np

from splat_addon.streaming.layout import COLUMNS, HEAD, MAGIC, PAGE, SUM, UNCHECKED_VERSION, row_type


class EditedBlocks:
    """directory: what is to be written as JSON. arrays: the rows and the columns of blocks, by name, which may be
    changed in place; the checksums follow them."""

    def __init__(self, data: bytes):
        self._data = bytearray(data)
        _, self._version, _, self._end, length = HEAD.unpack_from(data)
        self.directory = json.loads(data[self._end : self._end + length])
        arrays = self.directory["arrays"]
        rows = row_type([*self.directory["fields"], *self.directory.get("scan", ())])
        kinds = {"rows": rows, **{name: kind for name, (_, kind) in COLUMNS.items()}}
        shapes = {name: arrays[name].get("shape", [arrays[name].get("count")]) for name in kinds}
        self.arrays = {
            name: np.frombuffer(self._data, kind, int(np.prod(shapes[name])), arrays[name]["offset"]).reshape(
                shapes[name]
            )
            for name, kind in kinds.items()
        }

    def packed(self, version: int = 0, are_sums_right: bool = True, text: bytes | None = None) -> bytes:
        """The file's bytes. version: 0 for the one that it had. text: instead of the directory."""
        version = version or self._version
        if are_sums_right and version != UNCHECKED_VERSION:
            self._sum("row_sums", [self.arrays["rows"]])
            self._sum("block_sums", [self.arrays[name] for name in COLUMNS])
        text = json.dumps(self.directory).encode() if text is None else text
        head = HEAD.pack(MAGIC, version, zlib.crc32(text), self._end, len(text))
        return head + bytes(self._data[len(head) : self._end]) + text

    def _sum(self, name: str, arrays: list[np.ndarray]) -> None:
        sums = []
        for start in range(0, len(arrays[0]), PAGE):
            sums.append(0)
            for array in arrays:
                sums[-1] = zlib.crc32(array[start : start + PAGE].tobytes(), sums[-1])
        entry, packed = self._entry(name), np.array(sums, SUM).tobytes()
        if type(entry.get("offset")) is int and 0 <= entry["offset"] <= self._end - len(packed):
            self._data[entry["offset"] : entry["offset"] + len(packed)] = packed
            entry["checksum"] = zlib.crc32(packed)

    def _entry(self, name: str) -> dict:
        """What the directory says of an array; nothing, if it is damaged there."""
        found = self.directory
        for key in ("arrays", name):
            found = found.get(key) if isinstance(found, dict) else None
        return found if isinstance(found, dict) else {}
