# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of blocks of a file, as far as views have looked at it."""

from __future__ import annotations

import numpy as np

from ..hierarchy.blocks import Blocks
from .block_file import BlockFile
from .layout import COLUMNS, PAGE

#: Pages of the table that any budget has: some 20 MB.
_FEWEST = 256


class Table:
    """rows: the number of rows that there are. blocks: all blocks of the file, of which those that `load` answered for
    are there; the roots always are.

    most_bytes: the memory that the table may take before it is forgotten and read again. Raises ValueError with a
    sentence if the roots cannot be read.
    """

    def __init__(self, file: BlockFile, most_bytes: int):
        self.rows = file.rows
        self._file = file
        page_bytes = PAGE * sum(columns * kind.itemsize for columns, kind in COLUMNS.values())
        self._most, self._taken = max(most_bytes // page_bytes, _FEWEST), 0
        self._are_here, self._are_lost = np.zeros((2, -(-file.size // PAGE)), bool)
        self.blocks = self._empty()
        roots = np.arange(-(-file.roots // PAGE))
        self._read(roots)
        own = slice(file.roots)
        # in a tree, each row is in one block
        if self._are_lost.any() or int((self.blocks.last[own] - self.blocks.first[own]).sum()) > file.rows:
            raise ValueError(file.fault())
        #: pages of the roots, which stay when the others are forgotten
        self._stay = len(roots)

    def _empty(self) -> Blocks:
        """Blocks whose memory is taken from the system only as pages are filled."""
        size = self._file.size
        columns = {n: np.empty((size, width) if width > 1 else size, kind) for n, (width, kind) in COLUMNS.items()}
        return Blocks(**columns, roots=np.array(self._file.roots))

    def begin(self) -> None:
        """Begin a view: what earlier ones looked at is forgotten if it is too much."""
        if self._taken > self._most:
            before, self.blocks = self.blocks, self._empty()
            for name in COLUMNS:
                getattr(self.blocks, name)[: self._stay * PAGE] = getattr(before, name)[: self._stay * PAGE]
            self._are_here[self._stay :], self._taken = False, self._stay

    def try_again(self) -> None:
        """Forget what could not be read."""
        self._are_lost[:] = False

    def load(self, first: np.ndarray, last: np.ndarray) -> np.ndarray:
        """(n,) bool: whether all blocks of each run from first to last, at most a page long, are here; they are read
        if possible."""
        ends = np.stack([first // PAGE, (last - 1) // PAGE])
        self._read(np.unique(ends[~(self._are_here | self._are_lost)[ends]]))
        return self._are_here[ends].all(axis=0)

    def _read(self, pages: np.ndarray) -> None:
        for page in pages.tolist():
            columns = self._file.read_blocks(page)
            if columns is None:
                self._are_lost[page] = True
                continue
            for name, column in columns.items():
                getattr(self.blocks, name)[page * PAGE : page * PAGE + len(column)] = column
            self._are_here[page] = True
            self._taken += 1
