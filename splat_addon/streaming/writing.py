# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a file of blocks out of core: memory holds a few portions of surfels, however many there are."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import BinaryIO, NamedTuple

import numpy as np

from ..hierarchy import Hierarchy, build_hierarchy
from ..hierarchy.blocks import Blocks
from ..runs import ranges
from ..surfels import Surfels
from ..whole_files import unfinished
from .buckets import Survey, filled, portions_of, surveyed
from .checking import check
from .layout import COLUMNS, FIELDS, PageSums, align, as_surfels, begin, finish, joined_rows

#: Surfels of one hierarchy, and those that are best given at once.
PORTION = 1 << 20

#: Called with the finished share (0 to 1) and the step; returning False cancels.
Progress = Callable[[float, str], bool]


class WritingCancelled(Exception):
    """The progress callback returned False."""


def write_blocks(
    path: str | os.PathLike,
    parts: Iterable[Surfels],
    progress: Progress | None = None,
    portion: int = PORTION,
    expected: int = 0,
) -> int:
    """Write a file in the format of `layout`; returns the number of surfels.

    parts: sets of surfels, iterated twice; those with another origin than the first are moved to it. expected: about
        how many they have, so that counting them is a share of the progress; 0: not known.
    Until the file appears under its name, temporary files of the size of the surfels stand beside it. Raises ValueError
    as `surveyed` does, WritingCancelled, and the exceptions of `whole_files.unfinished`.
    """
    total = expected

    def told(first: float, last: float, step: str) -> Callable[[float], None]:
        def report(done: float) -> None:
            share = first + (last - first) * min(done / total, 1) if total else first
            if progress and progress(share, step) is False:
                raise WritingCancelled

        return report

    survey = surveyed(parts, portion, told(0.0, 0.1, "Counting"))
    total = survey.count
    with new_file(path) as file:
        files = filled(parts, survey, file.scratch, told(0.1, 0.3, "Sorting"))
        merged = _merged(portions_of(files, survey, portion), survey, told(0.3, 1.0, "Merging"))
        return file.write(merged, survey.kind, survey.origin, survey.is_solid)


class Merged(NamedTuple):
    """A portion on its way to a file. scan: (N + M,) uint8 of `SCAN_COLUMNS`, of N surfels, then of M merged ones."""

    surfels: Surfels
    hierarchy: Hierarchy
    scan: dict[str, np.ndarray]


def _merged(portions: Iterable[np.ndarray], survey: Survey, told) -> Iterator[Merged]:
    done = 0
    for rows in portions:
        surfels = as_surfels(rows, survey.origin, survey.is_solid)
        hierarchy = build_hierarchy(surfels, partial(_tell, told, done, len(surfels)), is_portion=True)
        yield Merged(surfels, hierarchy, {})
        done += len(surfels)
        told(done)


class NewFile:
    """A file that is being written. scratch: a folder on the same disk, which goes away."""

    def __init__(self, path: Path):
        self._path, self.scratch, self._count = path, path.parent / "scratch", 0
        self.scratch.mkdir()

    def write(
        self,
        portions: Iterable[Merged],
        kind: np.dtype,
        origin: np.ndarray,
        is_solid: bool,
        scan: dict[str, tuple[float, float]] | None = None,
    ) -> int:
        """Write portions of neighbours with their hierarchies; returns how many surfels there are. All have this (3,)
        origin; kind: the type of a row. scan: as of `BlockFile`. Raises ValueError if there are none."""
        with open(self._path, "wb") as stream:
            facts = {"origin": origin.tolist(), "is_solid": is_solid, **({"scan": scan} if scan else {})}
            self._count = _write(stream, portions, kind, facts, self.scratch)
        return self._count

    def check(self, file: Path) -> None:
        """Raise OSError or ValueError if what was written is damaged, or does not hold all surfels."""
        if (found := check(file)) != self._count:
            raise ValueError(f"It has {found:,} of {self._count:,} surfels.")


@contextmanager
def new_file(path: str | os.PathLike) -> Iterator[NewFile]:
    """A file that appears under its name when the context ends. Raises as `whole_files.unfinished`."""
    made: list[NewFile] = []
    with unfinished(path, lambda file: made[0].check(file)) as folder:
        made.append(NewFile(folder / Path(path).name))
        yield made[0]


def _write(stream: BinaryIO, portions: Iterable[Merged], kind: np.dtype, facts: dict, folder: Path) -> int:
    begin(stream)
    tables, sums, done, written, is_transparent = _Tables(folder), PageSums(), 0, 0, False
    start = align(stream)
    sums.begin(kind.itemsize)
    for surfels, hierarchy, scan in portions:
        rows = joined_rows(surfels, hierarchy.nodes, kind, scan)[hierarchy.entries]
        _add(stream, sums, rows)
        tables.add(hierarchy.blocks, rows, written)
        written += len(rows)
        done += len(surfels)
        is_transparent |= surfels.is_transparent
    if not done:
        raise ValueError("There are no surfels to store.")
    # the roots' rows once more, side by side, so that whoever opens the file reads them at once
    roots = np.concatenate(tables.root_rows)
    _add(stream, sums, roots)
    arrays = {"rows": {"offset": start, "count": written + len(roots)}, **tables.write(stream, written)}
    arrays["row_sums"], arrays["block_sums"] = sums.write(stream), tables.sums.write(stream)
    finish(
        stream,
        {
            "id": os.urandom(16).hex(),
            "surfels": done,
            **facts,
            "is_transparent": is_transparent,
            "roots": tables.roots,
            "fields": {name: FIELDS[name][0] for name in kind.names if name in FIELDS},
            "arrays": arrays,
        },
    )
    return done


def _add(stream: BinaryIO, sums: PageSums, rows: np.ndarray) -> None:
    """Write some rows of the array that `sums` goes over."""
    data = rows.view(np.uint8).reshape(-1).data
    stream.write(data)
    sums.add(data)


def _tell(told: Callable[[float], None], before: int, count: int, share: float) -> None:
    """Tell how many surfels are done when a share of `count` is, after those before."""
    told(before + share * count)


class _Tables:
    """Collects the blocks of all portions: roots in memory, the others in files. Joined, all roots come first.

    roots: their number. root_rows: rows of each portion's roots. sums: of the pages, once all is written.
    """

    def __init__(self, folder: Path):
        self._folder = folder
        self._roots: dict[str, list[np.ndarray]] = {name: [] for name in COLUMNS}
        self.root_rows: list[np.ndarray] = []
        self.roots = self._others = 0
        self.sums = PageSums()

    def add(self, blocks: Blocks, rows: np.ndarray, before: int) -> None:
        """Add a portion's blocks. rows: the portion's. before: number of rows before it."""
        own = int(blocks.roots)
        self.root_rows.append(rows[ranges(blocks.first[:own], blocks.last[:own] - blocks.first[:own])])
        for name, (_, kind) in COLUMNS.items():
            column = getattr(blocks, name).astype(kind)
            if name in ("first", "last"):
                column += before
            elif name in ("first_child", "last_child"):
                column += self._others - own  # roots of all portions are counted in `write`
            self._roots[name].append(column[:own])
            with open(self._folder / name, "ab") as stream:
                stream.write(column[own:].data)
        self.roots += own
        self._others += len(blocks) - own

    def write(self, stream: BinaryIO, written: int) -> dict[str, dict]:
        """Write the columns; returns their entries in the directory. written: rows before those of the roots."""
        roots = {name: np.concatenate(parts) for name, parts in self._roots.items()}
        sizes = roots["last"] - roots["first"]
        roots["last"] = written + np.cumsum(sizes)
        roots["first"] = roots["last"] - sizes
        entries = {}
        for name, (columns, kind) in COLUMNS.items():
            offset, shape = align(stream), [self.roots + self._others, *([columns] if columns > 1 else [])]
            more = kind.type(self.roots if name in ("first_child", "last_child") else 0)
            self.sums.begin(columns * kind.itemsize)
            _add(stream, self.sums, roots[name].astype(kind) + more)
            with open(self._folder / name, "rb") as others:
                while len(some := np.fromfile(others, kind, 1 << 20)):
                    _add(stream, self.sums, some + more)
            entries[name] = {"offset": offset, "type": kind.str, "shape": shape}
        return entries
