# SPDX-License-Identifier: GPL-3.0-or-later
"""What the readers of scans have in common: they hand out the points of a file in portions of named columns, as if it
were a PLY file, so that `points` understands all formats alike.

| column | meaning |
|---|---|
| x y z | float64, in the coordinates of the file |
| red green blue | display colours, integers of 8 or 16 bits |
| nx ny nz | normals |
| intensity, classification, return_number, number_of_returns, gps_time | as scanners give them |
| point_source_id, user_data, infrared | the same; the first is often the number of a flight line |
| scan_angle | degrees |
| extra:NAME | whatever else a file gives by a name |
| scan | number of the scan in the file, from 0; `Cloud.places` says where its scanner stood |
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np

from .columns import NORMAL, POSITION, Columns

#: Named columns of equal length.
Table = dict[str, np.ndarray]

#: progress(points so far, share of the file so far) -> whether to go on.
Progress = Callable[[int, float], bool]

#: Points, and bytes of the file, that a portion has at most.
PORTION, PORTION_BYTES = 1 << 18, 1 << 25

COLOR = ("red", "green", "blue")

#: Before the name of a column that only its file knows, and that becomes an attribute.
EXTRA = "extra:"


class ReadingCancelled(Exception):
    """`progress` returned False."""


@dataclass(eq=False)
class Cloud:
    """The points of an opened file.

    portions: the share of the file that was read so far, and the next points; raises ValueError with a sentence.
    places: scan number -> (3,) float64 where its scanner stood. said: sentences about what was assumed or left out.
    Both are complete when all portions were read. count: of points in the file, if it says so. is_thinned: whether the
    portions leave some out.
    """

    portions: Iterator[tuple[float, Table]]
    places: dict[int, np.ndarray] = field(default_factory=dict)
    said: list[str] = field(default_factory=list)
    count: int | None = None
    is_thinned: bool = False


def read_all(cloud: Cloud, progress: Progress | None = None, most: int = 0) -> Columns:
    """All points of a cloud, or an even sample of half of `most` to `most` of more. Raises `ReadingCancelled`, and
    ValueError with a sentence."""
    sample = EvenSample(most)
    for share, table in cloud.portions:
        sample.add(table)
        if progress is not None and not progress(sample.count, share):
            raise ReadingCancelled
    if sample.every > 1 or cloud.is_thinned:
        kept, of = sum(map(_length, sample.tables)), max(sample.count, cloud.count or 0)
        cloud.said.append(f"Took {kept:,} of {of:,} points, evenly")
    return Columns(joined(sample.tables))


class EvenSample:
    """Keeps each `every`-th of the rows that are added, so that there are at most `most`, or all if that is 0.

    tables: what is kept. count: rows that were added.
    """

    def __init__(self, most: int):
        self._most, self.tables, self.every, self.count = most, [], 1, 0

    def add(self, table: Table) -> None:
        """Add rows, of which those that are kept are copied if not all are."""
        if self.every > 1:
            first = -self.count % self.every
            kept = {name: column[first :: self.every].copy() for name, column in table.items()}
        else:
            kept = table
        self.tables.append(kept)
        self.count += _length(table)
        while self._most and sum(map(_length, self.tables)) > self._most:
            self.tables = [{name: column[::2].copy() for name, column in joined(self.tables).items()}]
            self.every *= 2


def _length(table: Table) -> int:
    return len(next(iter(table.values()), ()))


def joined(tables: list[Table]) -> Table:
    """The tables one after another, from which their columns are taken. Those that lack a column have no colour, or 0,
    there."""
    counts = [*map(_length, tables)]
    names = dict.fromkeys(name for table in tables for name in table)
    return {name: _column(tables, counts, name) for name in names or POSITION}


def _column(tables: list[Table], counts: list[int], name: str) -> np.ndarray:
    """A column of all tables, which is taken from them; those that lack it have no number there."""
    missing = np.nan if name in COLOR else 0
    parts = [table.pop(name, None) for table in tables]
    parts = [np.full(n, missing) if part is None else part for n, part in zip(counts, parts, strict=True)]
    return np.concatenate(parts) if parts else np.empty(0)


def without(table: Table, left_out: np.ndarray) -> Table:
    """The rows that are not left out; left_out: (N,) bool."""
    return {name: column[~left_out] for name, column in table.items()} if left_out.any() else table


def placed(points: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """(N, 3) float64 points under a (4, 4) map that is multiplied from the left."""
    return points @ matrix[:3, :3].T + matrix[:3, 3]


def as_table(positions: np.ndarray, normals: np.ndarray | None = None) -> Table:
    """Columns of (N, 3) positions and normals."""
    table = dict(zip(POSITION, np.ascontiguousarray(positions.T), strict=True))
    return table if normals is None else table | dict(zip(NORMAL, np.ascontiguousarray(normals.T), strict=True))
