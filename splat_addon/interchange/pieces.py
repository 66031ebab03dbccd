# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads the points of a file a portion at a time, understood as if they were read together."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from .clouds import COLOR, Cloud, EvenSample, Progress, ReadingCancelled, joined
from .columns import FLOAT_COLORS, Columns, with_white_1
from .ply_contents import coarse_steps
from .points import Points, points

#: Points that are kept to tell what the others are like: between half of this number and it.
_SAMPLE = 1 << 20


class PointPieces:
    """The points of a file in portions of `Points`; can be iterated again.

    count: how many there are. sample: some of them, evenly. said: sentences about how they were read.
    """

    def __init__(
        self, opened: Callable[[], Cloud], float_colors: str = FLOAT_COLORS[0], progress: Progress | None = None
    ):
        """Goes through the file once. opened: opens it, each time it is called. Raises `ReadingCancelled`, ValueError
        with a sentence, OSError."""
        self._opened, self._float_colors = opened, float_colors
        sample, largest, cloud = EvenSample(_SAMPLE), {}, opened()
        for share, table in cloud.portions:
            for name in table.keys() & set(COLOR):
                largest[name] = max(largest.get(name, 0), table[name].max(initial=0))
            sample.add({name: column.copy() for name, column in table.items()})
            if progress is not None and not progress(sample.count, share):
                raise ReadingCancelled
        self.count, self._columns = sample.count, Columns(joined(sample.tables))
        if largest and not any(largest.values()):
            # formats with a place for colours have black where there are none
            for name in COLOR:
                del self._columns[name]
        self._tell_white(largest)
        self.sample = replace(points(self._columns, float_colors), places=cloud.places)
        said = (*self.sample.said, *cloud.said, *coarse_steps(self._columns), *self._columns.passed_over())
        # what is said of the sample is so of all
        kept = f"{len(self.sample.positions):,} points"
        self.said = tuple(each.replace(kept, f"{self.count:,} points") for each in said)

    def _tell_white(self, largest: dict[str, float]) -> None:
        """Let the sample have the largest number of each colour."""
        for name in largest.keys() & self._columns.keys():
            column = self._columns[name]
            if len(column) and column.dtype.kind != "f":
                column[np.argmax(column)] = largest[name]

    def __iter__(self) -> Iterator[Points]:
        for _, table in self._opened().portions:
            count = len(next(iter(table.values()), ()))
            whole = {name: table.get(name) for name in self._columns}
            missing = {name: np.full(count, np.nan if name in COLOR else 0.0) for name, c in whole.items() if c is None}
            columns = with_white_1(whole | missing, self._columns, self._float_colors)
            yield points(columns, self._float_colors)
