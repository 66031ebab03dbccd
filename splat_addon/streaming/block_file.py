# SPDX-License-Identifier: GPL-3.0-or-later
"""An open file of blocks: its table of blocks, mapped into memory, and its rows, read on demand."""

from __future__ import annotations

import os
from pathlib import Path
from threading import Lock

import numpy as np

from ..hierarchy.blocks import Blocks
from .layout import read_directory, row_type
from .writing import COLUMNS


def described(path: str | os.PathLike) -> dict:
    """What a file holds, in plain values. Raises OSError or ValueError as `layout.read_directory`."""
    file = BlockFile(path)
    file.close()
    blocks = file.blocks
    corners = blocks.low[: int(blocks.roots)].min(axis=0), blocks.high[: int(blocks.roots)].max(axis=0)
    low, high = ((file.origin + corner).tolist() for corner in corners)
    return {
        "file": str(file.path),
        "bytes": file.path.stat().st_size,
        "surfels": file.count,
        "rows": file.rows,
        "blocks": len(blocks),
        "fields": list(file.kind.names),
        "solid": file.is_solid,
        "low": low,
        "high": high,
    }


class BlockFile:
    """count: number of surfels. rows: number of rows, merged ones included. kind: type of a row. blocks: the table,
    whose arrays are read from the file as they are looked at.

    Raises OSError or ValueError as `layout.read_directory`.
    """

    def __init__(self, path: str | os.PathLike):
        self.path = Path(path)
        directory = read_directory(self.path)
        arrays = directory["arrays"]
        missing = {"rows", *COLUMNS} - arrays.keys()
        if missing:
            raise ValueError(f"{self.path.name} lacks the array {sorted(missing)[0]}; store its surfels again.")
        self.count, self.rows = directory["surfels"], arrays["rows"]["count"]
        self.origin, self.is_solid = np.array(directory["origin"], np.float64), directory["is_solid"]
        # the first files of this version had opaque surfels only, and did not say so
        self.is_transparent = directory.get("is_transparent", False)
        self.kind = row_type(directory["fields"])
        self.blocks = Blocks(
            **{name: self._mapped(arrays[name]) for name in COLUMNS}, roots=np.array(directory["roots"])
        )
        self._offset = arrays["rows"]["offset"]
        self._stream, self._lock = open(self.path, "rb", buffering=0), Lock()

    def _mapped(self, array: dict) -> np.ndarray:
        return np.memmap(self.path, array["type"], "r", array["offset"], tuple(array["shape"]))

    def read_into(self, target: np.ndarray, first: int) -> None:
        """Read len(target) rows from row `first` on; from several threads, one after another. Raises OSError."""
        view, done = memoryview(target.view(np.uint8)), 0
        with self._lock:
            self._stream.seek(self._offset + first * self.kind.itemsize)
            while done < len(view):
                read = self._stream.readinto(view[done:])
                if not read:
                    raise OSError(f"{self.path.name} ended while it was read; was it replaced?")
                done += read

    def close(self) -> None:
        """Close the file; its table stays valid while somebody refers to it."""
        self._stream.close()
