# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs jobs in threads: numpy frees the interpreter in its long operations, so that several go on at once."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial

#: More threads would wait for the interpreter between operations, and hold more memory.
_MOST = 4


def in_order(jobs: Iterable[Callable]) -> Iterator:
    """The results of jobs that are independent of each other, in their order, whatever the number of threads.

    Few more jobs are begun than results are taken, so that these need not be kept. What a job raises is raised here.
    """
    count = min(os.cpu_count() or 1, _MOST)
    if count == 1:
        yield from (job() for job in jobs)
        return
    with ThreadPoolExecutor(count) as pool:
        begun = deque()
        try:
            for job in jobs:
                begun.append(pool.submit(job))
                if len(begun) > count:
                    yield begun.popleft().result()
            while begun:
                yield begun.popleft().result()
        finally:
            for job in begun:
                job.cancel()


def run_all(jobs: Iterable[Callable[[], None]]):
    """Run independent jobs that write their results where they belong."""
    deque(in_order(jobs), maxlen=0)


def in_portions(
    count: int, size: int, job: Callable[[slice], None], report: Callable[[float], None] = lambda share: None
):
    """Run a job for each `size` of `count` rows. report: called with the finished share."""
    portions = [slice(start, min(start + size, count)) for start in range(0, count, size)]
    for portion, _ in zip(portions, in_order(partial(job, portion) for portion in portions), strict=True):
        report(portion.stop / count)
