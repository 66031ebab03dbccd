# SPDX-License-Identifier: GPL-3.0-or-later
"""How far a long job is, told to whoever asked, who may stop it."""

from __future__ import annotations

from collections.abc import Callable

#: Called now and then with the finished share, 0 to 1; False stops the job.
Progress = Callable[[float], bool | None]


class SamplingCancelled(Exception):
    """The progress callback asked to stop."""


def stage(progress: Progress | None, start: float, stop: float) -> Callable[[float], None]:
    """Reports the share of one stage as a share of the whole; raises `SamplingCancelled` where that is wanted."""

    def report(share: float):
        if progress is not None and progress(start + (stop - start) * share) is False:
            raise SamplingCancelled("The sampling was cancelled.")

    return report
