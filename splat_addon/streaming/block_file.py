# SPDX-License-Identifier: GPL-3.0-or-later
"""An open file of blocks: pages of its rows and of its table of blocks, read on demand, each checked before it is used.

The file is read and never mapped into memory: a map of a file that somebody truncates, or of a drive that fails, ends
the process.
"""

from __future__ import annotations

import os
import stat
import zlib
from collections.abc import Iterable
from pathlib import Path
from threading import Lock

import numpy as np

from .directory import read_directory
from .layout import COLUMNS, PAGE, SUM, SUMS


class BlockFile:
    """id: of what was written, or empty. count: number of surfels. rows: number of rows, merged ones included. kind:
    type of a row. size: number of blocks. roots: number of those without a parent. scan: of `SCAN_COLUMNS` that it has
    -> the numbers that the bytes 0 and 255 stand for.

    Raises OSError if the file cannot be read, ValueError with a sentence if it has another format or version, or is cut
    off or damaged.
    """

    def __init__(self, path: str | os.PathLike):
        self.path = Path(path)
        if not stat.S_ISREG(os.stat(self.path).st_mode):
            raise ValueError(f"{self.path.name} is not a file; choose a file of surfels in blocks.")
        self._stream, self._lock = open(self.path, "rb", buffering=0), Lock()
        try:
            self._state = self._now()
            directory = read_directory(self._stream, self._state[0], self.path.name)
            self.id, self.count, self.rows = directory.id, directory.surfels, directory.rows
            self.size, self.roots = directory.blocks, directory.roots
            self.origin, self.kind = directory.origin, directory.kind
            self.scan = directory.scan
            self.is_solid, self.is_transparent = directory.is_solid, directory.is_transparent
            self._offsets, self._failure = directory.offsets, ""
            self._sums = {name: self._read_sums(name, checksum) for name, checksum in directory.sums.items()}
        except BaseException:
            self._stream.close()
            raise

    def read_rows(self, pages: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(n, PAGE) rows of these pages, and (n,) bool: which of them could be read. From several threads, one after
        another."""
        rows, are_good = np.zeros((len(pages), PAGE), self.kind), np.zeros(len(pages), bool)
        order = np.argsort(pages)
        for run in np.split(order, np.flatnonzero(np.diff(pages[order]) != 1) + 1) if len(pages) else ():
            first = int(pages[run[0]]) * PAGE
            together = np.empty(min(len(run) * PAGE, self.rows - first), self.kind)
            read = self._read(self._offsets["rows"] + first * self.kind.itemsize, together)
            for number, place in enumerate(run):
                some = together[number * PAGE : (number + 1) * PAGE]
                is_read = (number * PAGE + len(some)) * self.kind.itemsize <= read
                if is_read and self._is_right("row_sums", int(pages[place]), [some]):
                    rows[place, : len(some)], are_good[place] = some, True
        return rows, are_good

    def read_blocks(self, page: int) -> dict[str, np.ndarray] | None:
        """A page of the columns of `Blocks`, with every number within its bounds; None if it cannot be read."""
        first = page * PAGE
        count, columns = min(PAGE, self.size - first), {}
        for name, (width, kind) in COLUMNS.items():
            column = columns[name] = np.empty((count, width) if width > 1 else count, kind)
            offset = self._offsets[name] + first * width * kind.itemsize
            if self._read(offset, column) < column.nbytes:
                return None
        if not self._is_right("block_sums", page, columns.values()) or not self._are_possible(columns, first):
            return None
        return columns

    def fault(self) -> str:
        """Why something that was asked for could not be read, as a sentence."""
        name = self.path.name
        if self._failure:
            return f"{name} cannot be read: {self._failure}."
        try:
            is_same = self._now() == self._state
        except OSError:
            is_same = False
        if not is_same:
            return f"{name} was changed while it was read; open it again, or store its surfels again."
        return f"{name} is damaged: some of its blocks have wrong checksums or numbers; copy or store it again."

    def close(self) -> None:
        self._stream.close()

    def _now(self) -> tuple[int, int]:
        """What changes when somebody writes to the file: its size, bytes, and the time."""
        status = os.fstat(self._stream.fileno())
        return status.st_size, status.st_mtime_ns

    def _read_sums(self, name: str, checksum: int) -> np.ndarray:
        pages = -(-(self.rows if name == SUMS[0] else self.size) // PAGE)
        sums = np.empty(pages, SUM)
        if self._read(self._offsets[name], sums) < sums.nbytes or zlib.crc32(sums.data) != checksum:
            raise ValueError(f"{self.path.name} is damaged: its array {name} is wrong; copy or store it again.")
        return sums

    def _read(self, offset: int, target: np.ndarray) -> int:
        """Fill an array from an offset on; returns the number of bytes that were there."""
        view, done = memoryview(target.view(np.uint8).reshape(-1)), 0
        with self._lock:
            try:
                self._stream.seek(offset)
                while done < len(view) and (read := self._stream.readinto(view[done:])):
                    done += read
            except OSError as error:
                self._failure = error.strerror or str(error)
        return done

    def _is_right(self, name: str, page: int, arrays: Iterable[np.ndarray]) -> bool:
        """Whether a page is the one that was written."""
        if not self._sums:
            # without checksums, a change is all that can be noticed
            return self._now() == self._state
        checksum = 0
        for array in arrays:
            checksum = zlib.crc32(array.data, checksum)
        return checksum == self._sums[name][page]

    def _are_possible(self, columns: dict[str, np.ndarray], before: int) -> bool:
        """Whether the numbers of some blocks may be used. Children that come after their parents end every descent."""
        first, last, first_child, last_child = (columns[n] for n in ("first", "last", "first_child", "last_child"))
        own = np.arange(before, before + len(first))
        rows_are_there = (first >= 0) & (first < last) & (last <= self.rows) & (last - first <= PAGE)
        after = (first_child > own) & (first_child >= self.roots) & (last_child > first_child)
        children_are_there = after & (last_child <= self.size) & (last_child - first_child <= PAGE)
        return bool(
            (rows_are_there & (children_are_there | (first_child == last_child))).all()
            and all(np.isfinite(columns[name]).all() for name in ("low", "high", "axes", "angles", "errors"))
            and (columns["low"] <= columns["high"]).all()
            and columns["errors"].min() >= 0
        )
