# SPDX-License-Identifier: GPL-3.0-or-later
"""Which settings keep an error or a time, by what was measured in the scene.

A series of choices differs in its number of samples alone. Its time is linear in that number, and its error a power of
it between two that were measured, so numbers in between need not be drawn.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..rendering.settings import MAX_SAMPLES, MAX_SUPERSAMPLING
from .choices import Choice, with_samples
from .measuring import Row


@dataclass(frozen=True)
class Target:
    """flip: the most mean FLIP that a picture may have; or seconds: the most that it may take. One of the two."""

    flip: float | None = None
    seconds: float | None = None

    def __post_init__(self):
        if (self.flip is None) == (self.seconds is None):
            raise ValueError("A target is either an error or a time.")
        value = self.flip if self.seconds is None else self.seconds
        if not value > 0:
            raise ValueError(f"A target must be above 0, not {value}.")


@dataclass(frozen=True)
class Promise:
    """choice: what to draw with. flip, seconds: what that is expected to have. is_kept: whether that is within the
    target. why: a sentence for the user."""

    choice: Choice
    flip: float
    seconds: float
    is_kept: bool
    why: str


@dataclass
class Pace:
    """What pictures took, in relation to what was expected of them: another load of the machine, another frame of an
    animation. The latest count most."""

    factor: float = 1.0
    _seen: list[float] = field(default_factory=list)

    def drawn(self, expected: float, took: float) -> None:
        """A picture that was expected to take that many seconds took so many. `expected` is without this factor."""
        self._seen = [*self._seen[-4:], took / expected]
        self.factor = float(np.median(self._seen))


def chosen(rows: Sequence[Row], target: Target, pace: float = 1.0) -> Promise:
    """The fastest choice that keeps an error, or the closest that keeps a time; the closest or the fastest of all where
    none does. pace: factor for all times. Raises ValueError without rows."""
    if not rows:
        raise ValueError("Nothing was measured in this scene yet: measure it first.")
    expected = [(choice, flip, seconds * pace) for choice, flip, seconds in _expected(rows)]
    if target.seconds is None:
        within = [each for each in expected if each[1] <= target.flip]
        best = min(within, key=_by_time) if within else min(expected, key=_by_error)
        failing = f"as close as this scene allows, FLIP {best[1]:.3f}"
    else:
        within = [each for each in expected if each[2] <= target.seconds]
        best = min(within, key=_by_error) if within else min(expected, key=_by_time)
        failing = f"as fast as this scene allows, {best[2]:.2g} s"
    choice, flip, seconds = best
    said = f"FLIP {flip:.3f} in {seconds:.2g} s" if within else failing
    return Promise(choice, flip, seconds, bool(within), f"{choice.name}: {said}")


def _by_time(each: tuple) -> tuple:
    return each[2], each[1]


def _by_error(each: tuple) -> tuple:
    return each[1], each[2]


def _expected(rows: Iterable[Row]) -> Iterator[tuple[Choice, float, float]]:
    """(choice, FLIP, seconds) of what was measured, and of what lies between."""
    series: dict[str, list[Row]] = {}
    for row in rows:
        if row.choice.series:
            series.setdefault(row.choice.series, []).append(row)
        else:
            yield row.choice, row.flip, row.seconds
    for name, members in series.items():
        yield from _between(name, sorted(members, key=_work))


def _work(row: Row) -> int:
    return samples_of(row.choice)


def samples_of(choice: Choice) -> int:
    """Samples a pixel."""
    return choice.changes.get("supersampling", 1) ** 2 * choice.changes.get("samples", 1)


#: The most that a number of samples may be beyond the largest that was drawn.
_BEYOND = 4


def _between(name: str, rows: list[Row]) -> Iterator[tuple[Choice, float, float]]:
    work = np.array([_work(row) for row in rows], float)
    flips = np.maximum([row.flip for row in rows], 1e-6)
    seconds = np.array([row.seconds for row in rows])
    fixed, each = _line(work, seconds)
    for choice, samples in _numbered(name, rows[-1].choice, work[-1] * (_BEYOND if len(rows) > 1 else 1)):
        flip = np.exp(np.interp(np.log(samples), np.log(work), np.log(flips)))
        if samples > work[-1]:
            # as it went on between the last two, but never faster than with the root of the number
            slope = np.log(flips[-1] / flips[-2]) / np.log(work[-1] / work[-2])
            flip = flips[-1] * (samples / work[-1]) ** np.clip(slope, -0.5, 0.0)
        if samples < work[0]:
            continue
        yield choice, float(flip), float(fixed + each * samples)


def _line(work: np.ndarray, seconds: np.ndarray) -> tuple[float, float]:
    """Seconds that a picture takes in any case, and for each sample: the line with the least relative errors; neither
    is below 0."""
    if len(work) == 1:
        return 0.0, float(seconds[0] / work[0])
    weights = 1 / seconds
    table = np.stack([np.ones_like(work), work], axis=1)
    fixed, each = np.linalg.lstsq(table * weights[:, None], seconds * weights, rcond=None)[0]
    if fixed < 0 or each < 0:
        fixed, each = (0.0, np.mean(seconds / work)) if fixed < 0 else (float(np.mean(seconds)), 0.0)
    return float(fixed), float(each)


def _numbered(name: str, like: Choice, most: float) -> Iterator[tuple[Choice, int]]:
    """The choices of a series with all numbers of samples up to `most`."""
    by_edge = like.changes["supersampling"] > 1
    for number in range(1, MAX_SUPERSAMPLING + 1) if by_edge else _steps(MAX_SAMPLES):
        samples = number**2 if by_edge else number
        if samples > most:
            return
        yield with_samples(name, like.changes, number), samples


def _steps(most: int) -> Iterator[int]:
    """1, 2, 3, 4, 5, 6, 7, 8, 10, 12 ...: steps of an eighth at most, which nobody sees."""
    number = 1
    while number <= most:
        yield number
        number += max(number // 8, 1)
