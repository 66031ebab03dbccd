# SPDX-License-Identifier: GPL-3.0-or-later
"""Progress reports of a long job, which the receiver may cancel."""

from __future__ import annotations

from collections.abc import Callable

#: Called regularly with the finished share, 0 to 1; returning False cancels the job.
Progress = Callable[[float], bool | None]


class SamplingCancelled(Exception):
    """The progress callback cancelled the job."""


def stage(progress: Progress | None, start: float, stop: float) -> Callable[[float], None]:
    """Report a stage's share as a share of the whole; raises `SamplingCancelled` if the callback cancels."""

    def report(share: float):
        if progress is not None and progress(start + (stop - start) * share) is False:
            raise SamplingCancelled("The sampling was cancelled.")

    return report
