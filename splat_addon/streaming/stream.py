# SPDX-License-Identifier: GPL-3.0-or-later
"""A file of blocks as views see it: for each view, ordinary surfels."""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from functools import cached_property
from hashlib import blake2b
from itertools import count
from threading import Lock
from time import perf_counter
from typing import NamedTuple
from weakref import WeakValueDictionary

import numpy as np

from ..hierarchy import Sight
from ..hierarchy.cuts import cut_blocks
from ..hierarchy.ordering import spatial_order
from ..surfels import Surfels, portions, prepared
from .block_file import BlockFile
from .descent import descend
from .layout import as_surfels
from .pages import PAGE, Pages

#: Pages read between two looks at the clock: some 4 MB.
_AT_ONCE = 64


#: Surfels that are packed and drawn at a time, neighbours in space: what that takes besides is of this size.
PART = 1 << 16


@dataclass(frozen=True, eq=False)
class Gathered:
    """The surfels of some blocks, and the same in parts of at most `PART`, which share their arrays.

    unmerged: number of parts without merged surfels, which are the first. Those that wait for larger cells are in the
        others.
    """

    surfels: Surfels
    parts: tuple[Surfels, ...]
    unmerged: int


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


class Stream:
    """One reader of a file. most_bytes: the memory that rows of the file may take, besides those that views hold.

    Raises OSError or ValueError as `layout.read_directory`.
    """

    def __init__(self, path: str | os.PathLike, most_bytes: int):
        self.file = BlockFile(path)
        self.pages = Pages(self.file, most_bytes)
        self.rows_read = 0
        self._kept: dict[tuple, tuple[int, Seen]] = {}
        self._same: WeakValueDictionary[bytes, Gathered] = WeakValueDictionary()
        self._frame = 0
        # a thread of its own: what others compute in the background may take a minute, and a view waits for this one
        self._reader, self._lock = ThreadPoolExecutor(1, "surfel blocks"), Lock()

    def __len__(self) -> int:
        """The number of surfels, without merged ones."""
        return self.file.count

    @cached_property
    def roots(self) -> Gathered:
        """The surfels of the roots, which are always there."""
        return self._gathered(np.arange(int(self.file.blocks.roots)))

    @property
    def coarsest(self) -> Surfels:
        """The surfels of the roots."""
        return self.roots.surfels

    def at_most(self, most: int) -> Surfels:
        """The finest cut with the same error everywhere that has at most this many surfels; if even the roots have
        more, these. It is read from the file, whatever the memory."""
        blocks, drawn = self.file.blocks, np.arange(int(self.file.blocks.roots))
        error = float(blocks.errors[drawn].max(initial=0.0))
        everything = np.array([[0, 0, 0, 1.0]])
        while error > 0:
            sight = Sight(everything, np.zeros(4), 1.0, 0.0, np.array([0, 0, 1.0, 0]), False, error)
            finer = cut_blocks(blocks, sight)
            if int((blocks.last[finer] - blocks.first[finer]).sum()) > most:
                break
            drawn, error = finer, error / 2
            if (blocks.first_child[drawn] == blocks.last_child[drawn]).all():
                break
        rows = np.concatenate([self._read_run(blocks.first[k], blocks.last[k]) for k in drawn])
        return as_surfels(rows, self.file.origin, self.file.is_solid)

    def _read_run(self, first: int, last: int) -> np.ndarray:
        rows = np.empty(int(last - first), self.file.kind)
        self.file.read_into(rows, int(first))
        return rows

    def begin_frame(self) -> None:
        """Forget the views that the previous frame did not draw."""
        self._kept = {key: kept for key, kept in self._kept.items() if kept[0] == self._frame}
        self._frame += 1

    def seen(self, sight: Sight, beside: float | None = None, told: Callable[[], None] | None = None) -> Seen:
        """What a view draws, with everything that it needs; the same object as long as frames ask for it.

        beside: as in `descend`. told: called between reads; it may raise. Raises OSError if the file cannot be read.
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
        Raises later as `seen`."""
        return self._reader.submit(self._seen, sight, beside, most, seconds, None, needs_whole)

    def _seen(
        self, sight: Sight, beside: float | None, most: int | None, seconds: float | None, told, needs_whole: bool
    ) -> Seen:
        until = np.inf if seconds is None else perf_counter() + seconds
        with self._lock:
            self.pages.begin()
            for turn in count():
                cut = descend(self.file.blocks, self.pages, sight, beside, most)
                wanted = cut.wanted[: self.pages.room()]
                # at least one read, so that every call makes progress
                if not len(wanted) or (turn and perf_counter() >= until):
                    is_whole = not len(wanted)
                    if needs_whole and not is_whole:
                        return Seen(None, False, False)
                    return Seen(self._gathered(cut.drawn), is_whole, is_whole and bool(len(cut.wanted)))
                for start in range(0, len(wanted), _AT_ONCE):
                    some = wanted[start : start + _AT_ONCE]
                    self.pages.install(some, self.pages.read(some))
                    self.rows_read += len(some) * PAGE
                    if told:
                        told()
                    if perf_counter() >= until:
                        break

    def _gathered(self, drawn: np.ndarray) -> Gathered:
        """The surfels of these blocks, which are here; the same object for the same blocks."""
        key = blake2b(np.ascontiguousarray(drawn, np.int64).data, digest_size=16).digest()
        gathered = self._same.get(key)
        if gathered is None:
            blocks = self.file.blocks
            # any run of either kind is then close together
            drawn = drawn[spatial_order((blocks.low[drawn] + blocks.high[drawn]) / 2)]
            is_merged = blocks.first_child[drawn] < blocks.last_child[drawn]
            drawn = drawn[np.argsort(is_merged, kind="stable")]
            counts = blocks.last[drawn] - blocks.first[drawn]
            own = int(counts[: np.count_nonzero(~is_merged)].sum())
            fields = self.pages.gathered(blocks.first[drawn], blocks.last[drawn])
            surfels = Surfels(origin=self.file.origin, is_solid=self.file.is_solid, **fields)
            finest, others = (portions(surfels, PART, run) for run in (range(own), range(own, len(surfels))))
            parts = prepared(finest + others)
            if self.file.is_transparent:
                # all of them, because splats blend with those of the same layer only
                surfels, *parts = (some.as_transparent() for some in (surfels, *parts))
            gathered = self._same[key] = Gathered(surfels, tuple(parts), len(finest))
        return gathered

    def close(self) -> None:
        """Stop reading; what was given stays valid."""
        self._reader.shutdown(cancel_futures=True)
        self.file.close()
