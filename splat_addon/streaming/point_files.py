# SPDX-License-Identifier: GPL-3.0-or-later
"""Sorts more points than memory holds into files of neighbours, and reads each with the points around it, from whom
its own normals and sizes are estimated as if all were in memory."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..hierarchy.ordering import morton_codes

#: Named columns of equal length; one of them is this, (N, 3) float64.
Arrays = dict[str, np.ndarray]
POSITIONS = "positions"

#: Share of the points on each side that do not decide where to cut: a few may be anywhere.
_ASIDE = 0.001

#: Points whose neighbours are looked for, to find how far away neighbours are, and how much farther to look.
_PROBES, _FARTHER = 24, 1.5

#: They are looked for among one in this many of the points.
_SHARE = 8

#: Cells along the longest side of the grid that tells what is near the points of a file.
_CELLS = 128

#: Rows of another file that are looked at together.
_ROWS = 1 << 18


@dataclass(eq=False)
class _File:
    """One file of neighbours: the number of its points, and their (3,) box."""

    path: Path
    count: int
    low: np.ndarray
    high: np.ndarray


class PointFiles:
    """Points in files of neighbours, in a folder of their own.

    skipped: number of points without a place, which are in none.
    """

    def __init__(
        self,
        parts: Iterable[Arrays],
        sample: np.ndarray,
        count: int,
        portion: int,
        folder: Path,
        told: Callable[[int], None],
    ):
        """parts: all points, gone through once. sample: (n, 3) some of their positions. count: about how many there
        are. portion: about how many a file shall have. told: called with the number of points so far."""
        self.skipped, self._files, self._folder, self._kind = 0, {}, folder, None
        sample = sample[np.isfinite(sample).all(axis=1)]
        low, high = np.quantile(sample, (_ASIDE, 1 - _ASIDE), axis=0) if len(sample) else np.zeros((2, 3))
        self._low, self._high = low, np.maximum(high, low)
        codes, runs = np.sort(self._codes(sample)), -(-count // portion)
        self._cuts = np.unique(codes[len(codes) * np.arange(1, runs) // runs]) if len(codes) else codes
        done = 0
        for part in parts:
            self._add(part)
            done += len(part[POSITIONS])
            told(done)

    def _codes(self, positions: np.ndarray) -> np.ndarray:
        return morton_codes(np.clip(positions, self._low, self._high), self._low, self._high)

    def _add(self, part: Arrays) -> None:
        if self._kind is None:
            self._kind = np.dtype([(name, column.dtype, column.shape[1:]) for name, column in part.items()])
        rows = np.empty(len(part[POSITIONS]), self._kind)
        for name, column in part.items():
            rows[name] = column
        is_placed = np.isfinite(rows[POSITIONS]).all(axis=1)
        self.skipped += int(np.count_nonzero(~is_placed))
        rows = rows[is_placed]
        run = np.searchsorted(self._cuts, self._codes(rows[POSITIONS]), side="right")
        rows = rows[np.argsort(run, kind="stable")]
        first = 0
        for number, count in enumerate(np.bincount(run)):
            if count:
                self._append(number, rows[first : first + count])
                first += count

    def _append(self, number: int, rows: np.ndarray) -> None:
        low, high = rows[POSITIONS].min(axis=0), rows[POSITIONS].max(axis=0)
        file = self._files.setdefault(number, _File(self._folder / f"{number}.points", 0, low, high))
        with open(file.path, "ab") as stream:
            stream.write(rows.view(np.uint8).data)
        file.count += len(rows)
        file.low, file.high = np.minimum(file.low, low), np.maximum(file.high, high)

    def __len__(self) -> int:
        return len(self._files)

    def with_surroundings(self, number: int, neighbours: int) -> tuple[Arrays, int]:
        """The points of the file of this number, in the order along the curve, then those of others that may be among
        the neighbours of one; and how many the former are."""
        file = self._files[sorted(self._files)[number]]
        own = np.fromfile(file.path, self._kind)
        reach = _reach(own[POSITIONS], neighbours)
        near = _Near(own[POSITIONS], file, reach)
        others = [near.of(rows) for other in self._files.values() if other is not file and near.meets(other)
                  for rows in self._pieces_of(other)]  # fmt: skip
        rows = np.concatenate([own, *others])
        return {name: rows[name] for name in self._kind.names}, len(own)

    def _pieces_of(self, file: _File) -> Iterable[np.ndarray]:
        for first in range(0, file.count, _ROWS):
            yield np.fromfile(file.path, self._kind, _ROWS, offset=first * self._kind.itemsize)


def _reach(positions: np.ndarray, neighbours: int) -> float:
    """How far from (N, 3) points their neighbours may be, by some of them; 0 for points all at one place."""
    share = _SHARE if len(positions) > _SHARE * _SHARE * neighbours else 1
    probes = positions[:: max(len(positions) // _PROBES, 1)][:_PROBES]
    columns = np.ascontiguousarray(positions[::share].T)
    rank, found = min(-(-neighbours // share), columns.shape[1] - 1), []
    for probe in probes:
        away = columns - probe[:, None]
        found.append(np.partition(np.einsum("in,in->n", away, away), rank)[rank])
    return _FARTHER * float(np.sqrt(np.median(found) * 4))


class _Near:
    """Tells which points are near those of a file: in the cells of a grid around theirs."""

    def __init__(self, own: np.ndarray, file: _File, reach: float):
        # strays, which have no neighbours, must not make the cells large
        low, high = np.quantile(own, (_ASIDE, 1 - _ASIDE), axis=0)
        low, high = np.maximum(file.low, low - (high - low) / 2), np.minimum(file.high, high + (high - low) / 2)
        self._cell = max(reach, float((high - low).max()) / _CELLS, 1e-300)
        self._low, self._high = low - self._cell, high + self._cell
        shape = np.floor((self._high - self._low) / self._cell).astype(int) + 1
        self._taken = np.zeros(shape, bool)
        self._taken[tuple(self._cells(own[self._is_inside(own)]).T)] = True
        for axis in range(3):
            ahead = np.moveaxis(self._taken, axis, 0)
            before = ahead.copy()
            ahead[1:] |= before[:-1]
            ahead[:-1] |= before[1:]

    def _cells(self, positions: np.ndarray) -> np.ndarray:
        return np.floor((positions - self._low) / self._cell).astype(int)

    def _is_inside(self, positions: np.ndarray) -> np.ndarray:
        return ((positions >= self._low) & (positions <= self._high)).all(axis=1)

    def meets(self, other: _File) -> bool:
        """Whether a file's box may have points that are near."""
        return bool(((other.low <= self._high) & (other.high >= self._low)).all())

    def of(self, rows: np.ndarray) -> np.ndarray:
        """Which of some rows are near."""
        positions = rows[POSITIONS]
        inside = np.flatnonzero(self._is_inside(positions))
        return rows[inside[self._taken[tuple(self._cells(positions[inside]).T)]]]
