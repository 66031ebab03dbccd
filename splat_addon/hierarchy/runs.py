# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs of children, and computations on whole runs."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, eq=False)
class Runs:
    """Children of m parents, one parent's after the other's. starts, counts: (m,) of each."""

    starts: np.ndarray
    counts: np.ndarray

    def spread(self, columns: np.ndarray) -> np.ndarray:
        """(..., n) of (..., m): each parent's value for each of its children."""
        return np.repeat(columns, self.counts, axis=-1)

    def portions(self, size: int) -> Iterator[tuple[slice, Runs]]:
        """Portions of whole runs with about `size` children each, and their positions."""
        first, ends = 0, self.starts + self.counts
        while first < len(self.starts):
            start = self.starts[first]
            last = max(int(np.searchsorted(ends, start + size)), first + 1)
            some = slice(first, last)
            yield slice(start, ends[last - 1]), Runs(self.starts[some] - start, self.counts[some])
            first = last

    def sum(self, columns: np.ndarray) -> np.ndarray:
        return np.add.reduceat(columns, self.starts, axis=-1)

    def largest(self, values: np.ndarray) -> np.ndarray:
        return np.maximum.reduceat(values, self.starts, axis=-1)

    def least(self, values: np.ndarray) -> np.ndarray:
        return np.minimum.reduceat(values, self.starts, axis=-1)
