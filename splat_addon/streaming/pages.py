# SPDX-License-Identifier: GPL-3.0-or-later
"""The rows of a file that are in memory: pages of equal size, of which those used least recently make room for new
ones."""

from __future__ import annotations

import numpy as np

from ..runs import ranges
from .block_file import BlockFile
from .layout import PAGE
from .table import Table

#: Pages besides the roots' that any budget has, so that something can be read.
_FEWEST = 16
#: Pages that are read at a time: some 4 MB.
AT_ONCE = 64
#: Rows that are gathered at a time, few enough for them to stay in the processor's cache.
_PORTION = 1 << 14
_FOR_EVER = np.iinfo(np.int64).max


class Pages:
    """most_bytes: the memory that rows may take. The roots' pages are read at once and stay.

    Raises ValueError with a sentence if these cannot be read.
    """

    def __init__(self, file: BlockFile, table: Table, most_bytes: int):
        self._file = file
        count, roots = -(-file.rows // PAGE), slice(file.roots)
        pinned = np.unique(self._of_rows(table.blocks.first[roots], table.blocks.last[roots]))
        slots = min(max(most_bytes // (PAGE * file.kind.itemsize), len(pinned) + _FEWEST), count)
        # memory is taken from the system only as pages are filled
        self._rows = np.empty((slots, PAGE), file.kind)
        self._slots, self._pages = np.full(count, -1, np.int32), np.full(slots, -1)
        self._used, self._now = np.zeros(slots, np.int64), 1
        self._are_lost = np.zeros(count, bool)
        for start in range(0, len(pinned), AT_ONCE):
            self.fetch(pinned[start : start + AT_ONCE])
        if self._are_lost.any():
            raise ValueError(file.fault())
        self._used[self._slots[pinned]] = _FOR_EVER

    @property
    def nbytes(self) -> int:
        """The memory of the pages that are filled."""
        return int(np.count_nonzero(self._pages >= 0)) * self._rows[:1].nbytes

    def have(self, first: np.ndarray, last: np.ndarray) -> np.ndarray:
        """(n,) bool: whether all rows of each run from first to last, at most a page long, are here."""
        are_here = (self._slots[first // PAGE] >= 0) & (self._slots[(last - 1) // PAGE] >= 0)
        return are_here & ~self.are_lost(first, last)

    def are_lost(self, first: np.ndarray, last: np.ndarray) -> np.ndarray:
        """(n,) bool: whether some row of each run could not be read."""
        return self._are_lost[first // PAGE] | self._are_lost[(last - 1) // PAGE]

    def try_again(self) -> None:
        """Forget what could not be read."""
        self._are_lost[:] = False

    def lose(self, first: np.ndarray, last: np.ndarray) -> None:
        """Count the pages of these runs, which are here, as those that cannot be read. Roots in them stay."""
        self._are_lost[self._of_rows(first, last)] = True

    def begin(self) -> None:
        """Begin a view: pages used from now on stay until the next begins."""
        self._now += 1

    def use(self, first: np.ndarray, last: np.ndarray) -> None:
        """Note that these runs, which are here, are used."""
        for ends in (first, last - 1):
            slots = self._slots[ends // PAGE]
            self._used[slots] = np.maximum(self._used[slots], self._now)

    def missing(self, first: np.ndarray, last: np.ndarray) -> np.ndarray:
        """The pages that these runs lack, each once, in the order of the runs, without those that cannot be read."""
        pages = np.stack([first // PAGE, (last - 1) // PAGE], axis=1).ravel()
        pages = pages[(self._slots[pages] < 0) & ~self._are_lost[pages]]
        return pages[np.sort(np.unique(pages, return_index=True)[1])]

    def room(self) -> int:
        """The number of pages that can be read without dropping one that this view uses."""
        return int(np.count_nonzero(self._used < self._now))

    def fetch(self, pages: np.ndarray) -> None:
        """Read pages, as many as there is room for; the least recently used ones are dropped."""
        rows, are_good = self._file.read_rows(pages)
        self._are_lost[pages[~are_good]] = True
        self._install(pages[are_good], rows[are_good])

    def _install(self, pages: np.ndarray, rows: np.ndarray) -> None:
        is_new = self._slots[pages] < 0
        pages, rows = pages[is_new], rows[is_new]
        free = np.flatnonzero(self._used < self._now)
        free = free[np.argsort(self._used[free], kind="stable")][: len(pages)]
        pages, rows = pages[: len(free)], rows[: len(free)]
        dropped = self._pages[free]
        self._slots[dropped[dropped >= 0]] = -1
        self._rows[free], self._pages[free], self._slots[pages] = rows, pages, free
        self._used[free] = self._now

    def gathered(self, first: np.ndarray, last: np.ndarray) -> dict[str, np.ndarray]:
        """The fields of the rows of these runs, which are here: (n,) or (n, columns) arrays."""
        numbers = ranges(first, last - first)
        kind, rows = self._file.kind, self._rows.reshape(-1)
        fields = {name: np.empty((len(numbers), *kind[name].shape), kind[name].base) for name in kind.names}
        for start in range(0, len(numbers), _PORTION):
            some = numbers[start : start + _PORTION]
            taken = np.take(rows, self._slots[some // PAGE].astype(np.int64) * PAGE + some % PAGE)
            for name, values in fields.items():
                values[start : start + len(some)] = taken[name]
        return fields

    @staticmethod
    def _of_rows(first: np.ndarray, last: np.ndarray) -> np.ndarray:
        return np.concatenate([first // PAGE, (last - 1) // PAGE])


class Readable:
    """Stands for pages as if all were here that can be read."""

    def __init__(self, pages: Pages):
        self.are_lost = pages.are_lost

    def have(self, first: np.ndarray, last: np.ndarray) -> np.ndarray:
        return ~self.are_lost(first, last)

    def use(self, first: np.ndarray, last: np.ndarray) -> None:
        pass

    def missing(self, first: np.ndarray, last: np.ndarray) -> np.ndarray:
        return np.zeros(0, int)
