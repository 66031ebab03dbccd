# SPDX-License-Identifier: GPL-3.0-or-later
"""A file of blocks as views see it: for each view, ordinary surfels."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from hashlib import blake2b
from itertools import count
from threading import Lock
from time import perf_counter
from typing import NamedTuple
from weakref import WeakValueDictionary

import numpy as np

from ..hierarchy import Sight
from ..hierarchy.ordering import spatial_order
from ..primaries import recolored
from ..surfels import Surfels, are_usable, portions, prepared
from .block_file import BlockFile
from .descent import descend
from .layout import PAGE, parted
from .pages import AT_ONCE, Pages, Readable
from .table import Table

#: Surfels that are packed and drawn at a time, neighbours in space: what that takes besides is of this size.
PART = 1 << 16


@dataclass(frozen=True, eq=False)
class Gathered:
    """The surfels of some blocks, and the same in parts of at most `PART`, which share their arrays.

    unmerged: number of parts without merged surfels, which are the first. Those that wait for larger cells are in the
        others.
    scan: of `SCAN_COLUMNS` that the file has, (N,) bytes of the surfels.
    """

    surfels: Surfels
    parts: tuple[Surfels, ...]
    unmerged: int
    scan: dict[str, np.ndarray]

    def scan_of_parts(self) -> Iterator[dict[str, np.ndarray]]:
        """The bytes of each part."""
        first = 0
        for part in self.parts:
            yield {name: column[first : first + len(part)] for name, column in self.scan.items()}
            first += len(part)


class Seen(NamedTuple):
    """gathered: what a view draws; None if it is not whole, and only the whole was asked for. is_whole: nothing that
    the view needs is still to be read. is_short: the memory did not suffice, so that some blocks are coarser than it
    needs.
    """

    gathered: Gathered | None
    is_whole: bool
    is_short: bool

    @property
    def surfels(self) -> Surfels | None:
        return self.gathered and self.gathered.surfels


class _Unusable(Exception):
    """Some rows have values that no surfel has."""


class Unreadable(OSError):
    """Part of what a view needs cannot be read from its file, for the reason that the sentence gives. seen: what it
    draws instead, with the coarsest surfels where there are no others; None: nothing."""

    def __init__(self, sentence: str, seen: Seen | None = None):
        super().__init__(sentence)
        self.seen = seen


class Stream:
    """One reader of a file. most_bytes: the memory that rows of the file may take, besides those that views hold.
    roots: the surfels of the roots, which are always there. primaries: (3, 3), applied to the colours that views get.

    Raises OSError or ValueError as `BlockFile`.
    """

    def __init__(self, path: str | os.PathLike, most_bytes: int, primaries: np.ndarray | None = None):
        self.file = BlockFile(path)
        self._primaries = np.eye(3) if primaries is None else primaries
        self.rows_read = 0
        self._kept: dict[tuple, tuple[int, Seen]] = {}
        self._same: WeakValueDictionary[bytes, Gathered] = WeakValueDictionary()
        self._frame = 0
        # a thread of its own: what others compute in the background may take a minute, and a view waits for this one
        self._reader, self._lock = ThreadPoolExecutor(1, "surfel blocks"), Lock()
        try:
            self.table = Table(self.file, most_bytes)
            self.pages = Pages(self.file, self.table, most_bytes)
            self.roots = self._gathered(np.arange(self.file.roots))
        except BaseException as error:
            why = self.file.fault()
            self.close()
            if isinstance(error, _Unusable):
                raise ValueError(why) from None
            raise

    def __len__(self) -> int:
        """The number of surfels, without merged ones."""
        return self.file.count

    @property
    def coarsest(self) -> Surfels:
        """The surfels of the roots."""
        return self.roots.surfels

    def at_most(self, most: int) -> Surfels:
        """The finest cut with the same error everywhere that has at most this many surfels; if even the roots have
        more, these. It is read from the file, whatever the memory. Raises OSError with a sentence if that fails."""
        blocks, drawn = self.table.blocks, np.arange(self.file.roots)
        everything = np.array([[0, 0, 0, 1.0]])
        while len(coarse := drawn[blocks.first_child[drawn] < blocks.last_child[drawn]]):
            error = float(blocks.errors[coarse].max()) / 2
            sight = Sight(everything, np.zeros(4), 1.0, 0.0, np.array([0, 0, 1.0, 0]), False, error)
            cut = descend(self.table, Readable(self.pages), sight, None)
            if cut.is_torn:
                raise Unreadable(self.file.fault())
            if int((blocks.last[cut.drawn] - blocks.first[cut.drawn]).sum()) > most:
                break
            drawn = cut.drawn
            if error == 0:
                break
        return self._read(blocks.first[drawn], blocks.last[drawn])

    def _read(self, first: np.ndarray, last: np.ndarray) -> Surfels:
        """The surfels of some runs, which the memory of views does not keep."""
        count = len(np.unique(np.concatenate([first // PAGE, (last - 1) // PAGE])))
        pages = Pages(self.file, self.table, self.pages.nbytes + count * PAGE * self.file.kind.itemsize)
        missing = pages.missing(first, last)
        for start in range(0, len(missing), AT_ONCE):
            pages.fetch(missing[start : start + AT_ONCE])
        fields = parted(pages.gathered(first, last))[0] if not pages.are_lost(first, last).any() else {}
        if not fields or not are_usable(fields).all():
            raise Unreadable(self.file.fault())
        return Surfels(origin=self.file.origin, is_solid=self.file.is_solid, **fields)

    def begin_frame(self) -> None:
        """Forget the views that the previous frame did not draw, and try again what it could not read."""
        with self._lock:
            self.pages.try_again()
            self.table.try_again()
        self._kept = {key: kept for key, kept in self._kept.items() if kept[0] == self._frame}
        self._frame += 1

    def seen(self, sight: Sight, beside: float | None = None, told: Callable[[], None] | None = None) -> Seen:
        """What a view draws, with everything that it needs; the same object as long as frames ask for it.

        beside: as in `descend`. told: called between reads; it may raise. Raises `Unreadable` if some of it cannot be
        read.
        """
        key = sight.key, beside
        found = self._kept[key][1] if key in self._kept else self._seen(sight, beside, None, None, told, False)
        self._kept[key] = self._frame, found
        return found

    def ahead(
        self,
        sight: Sight,
        beside: float | None,
        seconds: float,
        most: int | None = None,
        needs_whole: bool = False,
    ) -> Future[Seen]:
        """What a view draws after some time of reading, prepared by another thread; what is missing then is drawn from
        its parents. most: as in `descend`. needs_whole: no surfels are gathered before all that it needs is read.
        The future raises as `seen`."""
        return self._reader.submit(self._seen, sight, beside, most, seconds, None, needs_whole)

    def _seen(
        self, sight: Sight, beside: float | None, most: int | None, seconds: float | None, told, needs_whole: bool
    ) -> Seen:
        until = np.inf if seconds is None else perf_counter() + seconds
        with self._lock:
            self.table.begin()
            self.pages.begin()
            for turn in count():
                cut = descend(self.table, self.pages, sight, beside, most)
                wanted = cut.wanted[: self.pages.room()]
                # at least one read, so that every call makes progress
                if not len(wanted) or (turn and perf_counter() >= until):
                    is_whole = not len(wanted)
                    if needs_whole and not is_whole:
                        return Seen(None, False, False)
                    try:
                        seen = Seen(self._gathered(cut.drawn), is_whole, is_whole and bool(len(cut.wanted)))
                    except _Unusable:
                        continue
                    if cut.is_torn:
                        raise Unreadable(self.file.fault(), seen)
                    return seen
                for start in range(0, len(wanted), AT_ONCE):
                    some = wanted[start : start + AT_ONCE]
                    self.pages.fetch(some)
                    self.rows_read += len(some) * PAGE
                    if told:
                        told()
                    if perf_counter() >= until:
                        break

    def _gathered(self, drawn: np.ndarray) -> Gathered:
        """The surfels of these blocks, which are here; the same object for the same blocks. Raises `_Unusable` after
        dropping blocks whose values no surfel has."""
        key = blake2b(np.ascontiguousarray(drawn, np.int64).data, digest_size=16).digest()
        gathered = self._same.get(key)
        if gathered is None:
            blocks = self.table.blocks
            # any run of either kind is then close together
            drawn = drawn[spatial_order(blocks.low[drawn] / 2 + blocks.high[drawn] / 2)]
            is_merged = blocks.first_child[drawn] < blocks.last_child[drawn]
            drawn = drawn[np.argsort(is_merged, kind="stable")]
            first, last = blocks.first[drawn], blocks.last[drawn]
            own = int((last - first)[: np.count_nonzero(~is_merged)].sum())
            fields, scan = parted(self.pages.gathered(first, last))
            try:
                surfels = Surfels(origin=self.file.origin, is_solid=self.file.is_solid, **fields)
            except ValueError:
                is_bad = np.logical_or.reduceat(~are_usable(fields), np.cumsum(last - first) - (last - first))
                self.pages.lose(first[is_bad], last[is_bad])
                raise _Unusable from None
            surfels = recolored(surfels, self._primaries)
            finest, others = (portions(surfels, PART, run) for run in (range(own), range(own, len(surfels))))
            parts = prepared(finest + others)
            if self.file.is_transparent:
                # all of them, because splats blend with those of the same layer only
                surfels, *parts = (some.as_transparent() for some in (surfels, *parts))
            gathered = self._same[key] = Gathered(surfels, tuple(parts), len(finest), scan)
        return gathered

    def close(self) -> None:
        """Stop reading; what was given stays valid."""
        self._reader.shutdown(cancel_futures=True)
        self.file.close()
