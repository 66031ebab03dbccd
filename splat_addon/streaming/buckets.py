# SPDX-License-Identifier: GPL-3.0-or-later
"""Sorts more surfels than memory holds into portions of neighbours, by way of files.

The parts are read twice. The first time tells the box, the fields and, from a sample, where to cut a Morton curve into
runs of about equal length; the second time appends every surfel to the file of its run.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..hierarchy.ordering import morton_codes
from ..surfels import Surfels
from .layout import as_rows, row_type

#: One surfel in this many is in the sample that decides where to cut.
_EVERY = 64
#: A run with more rows than this many portions is split: cuts cannot separate many surfels at one place.
_LARGEST = 2


@dataclass(frozen=True, eq=False)
class Survey:
    """count: number of surfels. kind: type of a row. low, high: (3,) float64 box of the positions. cuts: (k,) int64
    codes at which runs begin, after the first."""

    count: int
    kind: np.dtype
    origin: np.ndarray
    is_solid: bool
    low: np.ndarray
    high: np.ndarray
    cuts: np.ndarray


def surveyed(parts: Iterable[Surfels], portion: int, told: Callable[[int], None]) -> Survey:
    """Look at all surfels once. told: called with the number seen so far.

    Raises ValueError if there are none, or if the parts can be read only once.
    """
    if iter(parts) is parts:
        raise ValueError("The parts are read twice: pass a list of surfels, or an object that can be iterated again.")
    count, names, origin, is_solid, sample = 0, set(), None, True, []
    low, high = np.full(3, np.inf), np.full(3, -np.inf)
    for part in parts:
        if not len(part):
            continue
        origin = part.origin if origin is None else origin
        positions = moved(part, origin)
        low, high = np.minimum(low, positions.min(axis=0)), np.maximum(high, positions.max(axis=0))
        sample.append(positions[-count % _EVERY :: _EVERY].copy())
        names |= part.arrays().keys()
        is_solid &= part.is_solid
        count += len(part)
        told(count)
    if not count:
        raise ValueError("There are no surfels to store.")
    codes = np.sort(morton_codes(np.concatenate(sample), low, high))
    runs = -(-count // portion)
    cuts = np.unique(codes[len(codes) * np.arange(1, runs) // runs])
    return Survey(count, row_type(names), origin, is_solid, low, high, cuts)


def filled(parts: Iterable[Surfels], survey: Survey, folder: Path, told: Callable[[int], None]) -> list[Path]:
    """Write every surfel into the file of its run, in the folder; returns the files in the order of the curve."""
    files, done = [folder / f"{number}.rows" for number in range(len(survey.cuts) + 1)], 0
    for part in parts:
        if not len(part):
            continue
        rows = as_rows(part, survey.kind)
        rows["positions"] = moved(part, survey.origin)
        run = np.searchsorted(survey.cuts, morton_codes(rows["positions"], survey.low, survey.high), side="right")
        order = np.argsort(run, kind="stable")
        ends = np.cumsum(np.bincount(run, minlength=len(files)))
        for number, (first, last) in enumerate(zip(np.concatenate([[0], ends[:-1]]), ends, strict=True)):
            if first < last:
                with open(files[number], "ab") as stream:
                    stream.write(rows[order[first:last]].view(np.uint8).data)
        done += len(part)
        told(done)
    return [file for file in files if file.exists()]


def portions_of(files: list[Path], survey: Survey, portion: int) -> Iterator[np.ndarray]:
    """The rows of each run, whose file is then deleted; of a longer one, in several portions."""
    for file in files:
        rows = np.fromfile(file, survey.kind)
        file.unlink()
        yield from np.array_split(rows, -(-len(rows) // (_LARGEST * portion)))


def moved(part: Surfels, origin: np.ndarray) -> np.ndarray:
    """(n, 3) float32 positions relative to another origin."""
    if (part.origin == origin).all():
        return part.positions
    return (part.positions + (part.origin - origin)).astype(np.float32)
