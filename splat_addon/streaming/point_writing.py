# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes a file of blocks of more points than memory holds: they are sorted into files of neighbours; each of these
becomes surfels together with the points around it, and then a part of the hierarchy, in a few threads."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor, wait

import numpy as np

from ..clip_lines import CLIP_FIELDS
from ..hierarchy import build_hierarchy, most_common, rounded_means
from ..surfels import LAYOUT, Surfels
from .layout import row_type
from .point_files import Arrays, PointFiles
from .writing import Merged, Progress, WritingCancelled, new_file

#: Points that are converted together, and how many times so many at once.
_PORTION, _THREADS = 1 << 19, 2

#: Share of the progress at which all are sorted; of that of a portion, at which its surfels are made.
_SORTED, _MADE = 0.1, 0.7

#: Column of scans -> what merged surfels have of it.
_MERGED = {"intensity": rounded_means, "classification": most_common}

#: Seconds between two reports while portions are converted.
_TICK = 0.2

#: (arrays, number of points of the portion itself, which come first; told) -> the surfels of these, and the (N,) rows
#: of the arrays that they were made from.
Convert = Callable[[Arrays, int, Callable[[float], bool]], tuple[Surfels, np.ndarray]]


def write_points(
    path: str | os.PathLike,
    parts: Iterable[Arrays],
    sample: np.ndarray,
    count: int,
    convert: Convert,
    *,
    origin: np.ndarray,
    neighbours: int,
    has_clip_lines: bool = False,
    scan: dict[str, tuple[float, float]] | None = None,
    progress: Progress | None = None,
    portion: int = _PORTION,
) -> tuple[int, int]:
    """Write the file; returns the number of surfels, and that of points without a place.

    parts, sample, count: as of `PointFiles`. convert: called in threads; all of its surfels have this (3,) origin, and
    no optional fields but clip lines. neighbours: those that it looks at, for each point. scan: of `SCAN_COLUMNS` that
    the parts have, in bytes -> the numbers that 0 and 255 stand for.
    Raises WritingCancelled, ValueError if there are no surfels, and the exceptions of `whole_files.unfinished`.
    """

    def told(share: float, step: str) -> None:
        if progress and progress(share, step) is False:
            raise WritingCancelled

    def sorting(done: int) -> None:
        told(_SORTED * min(done / max(count, 1), 1.0), "Sorting")

    with new_file(path) as file:
        files = PointFiles(parts, sample, count, portion, file.scratch, sorting)
        work = _Conversion(files, convert, neighbours, tuple(scan or ()))
        kind = row_type([*LAYOUT, *(CLIP_FIELDS if has_clip_lines else ()), *(scan or ())])
        merged = work.all(lambda share: told(_SORTED + (1 - _SORTED) * share, "Converting"))
        return file.write(merged, kind, origin, False, scan), files.skipped


class _Conversion:
    """The files of neighbours on their way to surfels."""

    def __init__(self, files: PointFiles, convert: Convert, neighbours: int, scan: tuple[str, ...]):
        self._files, self._convert, self._neighbours, self._scan = files, convert, neighbours, scan
        self._shares, self._is_cancelled = np.zeros(max(len(files), 1)), False

    def all(self, told: Callable[[float], None]) -> Iterator[Merged]:
        """The surfels of each file, in their order, and their hierarchies."""
        with ThreadPoolExecutor(_THREADS, "points") as executor:
            waiting: deque[Future] = deque()
            try:
                for number in range(len(self._files)):
                    waiting.append(executor.submit(self._job, number))
                    if len(waiting) > _THREADS:
                        yield from self._result(waiting.popleft(), told)
                while waiting:
                    yield from self._result(waiting.popleft(), told)
            except BaseException:
                self._is_cancelled = True
                executor.shutdown(cancel_futures=True)
                raise

    def _result(self, job: Future, told: Callable[[float], None]) -> Iterator[Merged]:
        while not wait([job], _TICK).done:
            told(float(self._shares.mean()))
        told(float(self._shares.mean()))
        made = job.result()
        if len(made.surfels):
            yield made

    def _job(self, number: int) -> Merged:
        def told(share: float) -> bool:
            self._shares[number] = share
            if self._is_cancelled:
                raise WritingCancelled
            return True

        arrays, own = self._files.with_surroundings(number, self._neighbours)
        surfels, rows = self._convert(arrays, own, lambda share: told(_MADE * share))
        hierarchy = build_hierarchy(surfels, lambda share: told(_MADE + (1 - _MADE) * share), is_portion=True)
        areas = surfels.scales.astype(np.float64).prod(axis=1)
        scan = {name: _MERGED[name](hierarchy, areas, arrays[name][rows]) for name in self._scan}
        return Merged(surfels, hierarchy, scan)
