# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs jobs in turn: other load on the machine affects all of them alike, so ratios within a turn are reliable.

The first turn warms up (shaders, caches, memory) and is not counted. Quote medians of the turns' ratios.
"""

from __future__ import annotations

import statistics
import time
import tracemalloc
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

Job = Callable[[], object]


class Spread(NamedTuple):
    """Median, minimum and maximum of some numbers."""

    median: float
    least: float
    most: float

    @classmethod
    def of(cls, values: Iterable[float]) -> Spread:
        values = list(values)
        return cls(statistics.median(values), min(values), max(values))

    def __format__(self, form: str) -> str:
        return f"{self.median:{form}} ({self.least:{form}} to {self.most:{form}})"


def _timed(clock: Callable[[], float], job: Job) -> tuple[float, object]:
    started = clock()
    result = job()
    return clock() - started, result


#: Ways to measure a job; each returns (number, result of the job). The number is seconds on the clock, processor
#: seconds (which other load does not lengthen), or the milliseconds that a frame reports.
wall = partial(_timed, time.perf_counter)
processor = partial(_timed, time.process_time)


def both(job: Job) -> tuple[tuple[float, float], object]:
    """(seconds on the clock, processor seconds)."""
    on_clock, (work, result) = wall(lambda: processor(job))
    return (on_clock, work), result


def peak_bytes(job: Job) -> tuple[int, object]:
    """The peak of allocated bytes above what was allocated before, including the result."""
    tracemalloc.start()
    result = job()
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    return peak, result


def frame(job: Job) -> tuple[float, object]:
    result = job()
    return result.stats["milliseconds"], result


@dataclass(frozen=True)
class Turns:
    """values: name -> measurements of a job in every counted turn. results: its last results."""

    values: dict
    results: dict

    def spread(self, name) -> Spread:
        return Spread.of(self.values[name])

    def ratios(self, name, unit) -> list[float]:
        """Measurements of a job divided by those of another in the same turn."""
        return [own / other for own, other in zip(self.values[name], self.values[unit])]

    def ratio(self, name, unit) -> Spread:
        return Spread.of(self.ratios(name, unit))

    def part(self, pick: Callable) -> Turns:
        """The same turns with `pick` of each value."""
        return Turns({name: [pick(value) for value in own] for name, own in self.values.items()}, self.results)


def in_turn(
    jobs: Mapping, turns: int, measure: Callable = wall, limits: Mapping | None = None, steps: Callable = iter, warm=1
) -> Turns:
    """Run every job once per turn. limits: name -> number of turns for jobs too slow for all of them. steps: shows
    progress.

    A job's attribute `after` is called after it, untimed.
    """
    made = Turns({name: [] for name in jobs}, {})
    for turn in steps(range(turns + warm)):
        for name, job in jobs.items():
            if turn < (limits or {}).get(name, turns) + warm:
                value, made.results[name] = measure(job)
                getattr(job, "after", bool)()
                if turn >= warm:
                    made.values[name].append(value)
    return made


@dataclass(frozen=True)
class Pairs:
    """values: measurements of a job, each with that of the unit just before it. result: the job's last."""

    values: list[tuple]
    result: object

    def own(self, pick: Callable = float) -> Spread:
        return Spread.of(pick(value) for value, _ in self.values)

    def ratios(self, pick: Callable = float) -> list[float]:
        return [pick(value) / pick(unit) for value, unit in self.values]


#: Turns that pairs have at least, however long they take.
LEAST_TURNS = 3


def in_pairs(
    jobs: Mapping, unit: Job, turns: int, seconds: float, measure: Callable = processor, steps: Callable = iter
) -> Iterator[tuple[object, Pairs]]:
    """Yield (name, pairs) of each job once it has run in its turns, each time right after the unit.

    Both run once more before each measurement, not counted: the first of several equal runs prepares what the others
    find. turns: at most, so many that they take `seconds` together, but three at least if so many are allowed.
    """
    for name, job in steps(jobs.items()):
        values, begun = [], time.perf_counter()
        while len(values) < turns and (len(values) < LEAST_TURNS or time.perf_counter() - begun < seconds):
            unit()
            beside, _ = measure(unit)
            job()
            value, result = measure(job)
            values.append((value, beside))
        yield name, Pairs(values, result)


def noise(values: Iterable[float]) -> float:
    """The median distance from the median: half of the values are as near."""
    values = list(values)
    middle = statistics.median(values)
    return statistics.median(abs(value - middle) for value in values)
