# SPDX-License-Identifier: GPL-3.0-or-later
"""Which settings keep an error or a time, by what was measured in the scene.

A series of choices differs in its number of samples alone. Its time is linear in that number, and its error a power of
it between two that were measured, so numbers in between need not be drawn. What other settings do is expected from
their `effects`, and a choice that has them is drawn before it is promised.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from ..rendering.settings import MAX_SAMPLES, MAX_SUPERSAMPLING
from .choices import Choice, with_samples
from .effects import Effects
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


#: A choice with its expected FLIP and seconds.
_Expected = tuple[Choice, float, float]

#: The share of the error, or of the time, that other settings must gain.
_LEAST_GAIN = 0.1


def chosen(
    rows: Sequence[Row], target: Target, pace: float = 1.0, effects: Effects | None = None, is_drawn: bool = True
) -> Promise:
    """The fastest choice that keeps an error, or the closest that keeps a time; the closest or the fastest of all where
    none does. pace: factor for all times. effects: of other settings than samples, which are changed if that gains a
    tenth. is_drawn: change those only that were measured together. Raises ValueError without rows."""
    measured = [row for row in rows if not row.choice.numbers]
    if not measured:
        raise ValueError("Nothing was measured in this scene yet: measure it first.")
    plain = list(_expected(measured))
    best, is_kept = _best(plain, target, pace)
    if effects is not None:
        changed = _changed(plain, [row for row in rows if row.choice.numbers], effects, is_drawn)
        other, is_other_kept = _best([best, *changed], target, pace)
        # of what is to be small: the time if an error is kept or a time is not, else the error
        place = 2 if (target.seconds is None) == is_kept else 1
        if is_other_kept > is_kept or other[place] < (1 - _LEAST_GAIN) * best[place]:
            best, is_kept = other, is_other_kept
    choice, flip, seconds = best[0], best[1], best[2] * pace
    if is_kept:
        said = f"FLIP {flip:.3f} in {seconds:.2g} s"
    elif target.seconds is None:
        said = f"as close as this scene allows, FLIP {flip:.3f}"
    else:
        said = f"as fast as this scene allows, {seconds:.2g} s"
    return Promise(choice, flip, seconds, is_kept, f"{choice.name}: {said}")


#: How often a choice is drawn whose effects were only expected. Each takes two pictures.
_TRIES = 2


def settled(
    rows: list[Row], target: Target, effects: Effects, drawn: Callable[[Choice], Row], pace: float = 1.0
) -> Promise:
    """`chosen` with other settings than samples, once they were measured together. drawn: measures a choice; its row is
    added to `rows`."""
    for _ in range(_TRIES):
        promise = chosen(rows, target, pace, effects, is_drawn=False)
        if not promise.choice.numbers or any(_tells(row.choice, promise.choice) for row in rows):
            return promise
        rows.append(drawn(promise.choice))
    return chosen(rows, target, pace, effects)


def _best(expected: Iterable[_Expected], target: Target, pace: float) -> tuple[_Expected, bool]:
    """The best choice for a target, and whether that is kept."""
    expected = list(expected)
    by_time, by_error = (lambda each: (each[2], each[1])), (lambda each: each[1:])
    if target.seconds is None:
        within = [each for each in expected if each[1] <= target.flip]
        return (min(within, key=by_time), True) if within else (min(expected, key=by_error), False)
    within = [each for each in expected if each[2] * pace <= target.seconds]
    return (min(within, key=by_error), True) if within else (min(expected, key=by_time), False)


def _changed(plain: Sequence[_Expected], drawn: Sequence[Row], effects: Effects, is_drawn: bool) -> Iterator[_Expected]:
    """The choices with other settings. Those that were measured together correct what is expected of them with another
    number of samples. is_drawn: leave out the others."""
    of = {choice: (flip, seconds) for choice, flip, seconds in plain}
    for choice, flip, seconds in plain:
        for kind in effects.kinds(choice):
            made = choice.with_numbers(kind.numbers)
            alike = [row for row in drawn if row.choice.series == made.series and row.choice.numbers == made.numbers]
            if is_drawn and not any(_tells(row.choice, made) for row in alike):
                continue
            flip_factor = time_factor = 1.0
            if alike:
                nearest = min(alike, key=lambda row: abs(np.log(_work(row) / samples_of(made))))
                own_flip, own_seconds = of[nearest.choice.plain]
                flip_factor = nearest.flip / kind.flip(own_flip)
                time_factor = nearest.seconds / (own_seconds * kind.time)
            yield made, kind.flip(flip) * flip_factor, seconds * kind.time * time_factor


def _tells(drawn: Choice, other: Choice) -> bool:
    """Whether a choice that was drawn tells what another will be: it differs in its samples alone, by half at most."""
    is_alike = (drawn.series, drawn.numbers) == (other.series, other.numbers)
    return is_alike and 1 / 1.5 <= samples_of(drawn) / samples_of(other) <= 1.5


def _expected(rows: Iterable[Row]) -> Iterator[_Expected]:
    """What was measured, and what lies between."""
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


def _between(name: str, rows: list[Row]) -> Iterator[_Expected]:
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
